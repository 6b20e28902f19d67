#include "experiments/benchmarks/qp_set.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/input/input_error.hpp"
#include "core/log/build_info.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

constexpr const char* format = "hagfish-qp";
constexpr int format_version = 1;
/// Rounding of entries that were computed as matrix products, over the largest: more is no
/// symmetric matrix.
constexpr double asymmetry = 1e-12;
/// An eigenvalue of A may be this much below zero, over the largest: rounding of dependent rows.
constexpr double indefinite = 1e-10;

/// One problem's group, and how its errors are told.
class Group {
 public:
  Group(const Hdf5Reader& h5, std::string path) : h5_(h5), path_(std::move(path)) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(h5_.file() + ": " + path_ + ": " + what);
  }

  bool has(const char* name) const { return h5_.has(path_ + "/" + name); }

  /// A vector of `size` entries, of any size where that is negative.
  Eigen::VectorXd vector(const char* name, Eigen::Index size = -1) const {
    const std::vector<hsize_t> shape = shape_of(name);
    if (shape.size() != 1 || (size >= 0 && static_cast<Eigen::Index>(shape[0]) != size)) {
      refuse(fmt::format("{} is {}, not {}", name, text_of(shape),
                         size < 0 ? "a vector" : fmt::format("a vector of {}", size)));
    }
    const std::vector<double> values = h5_.doubles(path_ + "/" + name);
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  }

  Eigen::MatrixXd matrix(const char* name, Eigen::Index rows, Eigen::Index columns) const {
    const std::vector<hsize_t> shape = shape_of(name);
    if (shape.size() != 2 || static_cast<Eigen::Index>(shape[0]) != rows ||
        static_cast<Eigen::Index>(shape[1]) != columns) {
      refuse(fmt::format("{} is {}, not {} x {}", name, text_of(shape), rows, columns));
    }
    const std::vector<double> values = h5_.doubles(path_ + "/" + name);
    return Eigen::Map<const Hdf5Reader::Rows>(values.data(), rows, columns);
  }

  /// The two triangles' mean.
  Eigen::MatrixXd symmetric(const char* name, Eigen::Index size) const {
    const Eigen::MatrixXd A = matrix(name, size, size);
    require_finite(name, A);
    if (size > 0 &&
        (A - A.transpose()).cwiseAbs().maxCoeff() > asymmetry * A.cwiseAbs().maxCoeff()) {
      refuse(fmt::format("{} is not symmetric", name));
    }
    return 0.5 * (A + A.transpose());
  }

  void require_finite(const char* name, const Eigen::MatrixXd& values) const {
    if (!values.allFinite()) {
      refuse(fmt::format("{} has entries that are not finite", name));
    }
  }

 private:
  static std::string text_of(const std::vector<hsize_t>& shape) {
    return shape.empty() ? "a single value" : fmt::format("{}", fmt::join(shape, " x "));
  }

  std::vector<hsize_t> shape_of(const char* name) const {
    if (!has(name)) {
      refuse(fmt::format("has no {}", name));
    }
    return h5_.shape(path_ + "/" + name);
  }

  const Hdf5Reader& h5_;
  std::string path_;
};

BoxQp read_box(const Group& group) {
  BoxQp qp;
  qp.b = group.vector("b");
  const Eigen::Index m = qp.b.size();
  qp.A = group.symmetric("A", m);
  qp.lower = group.vector("l", m);
  qp.upper = group.vector("u", m);
  group.require_finite("b", qp.b);
  if (!((qp.lower.array() <= 0).all() && (qp.upper.array() >= 0).all())) {
    group.refuse("l <= 0 <= u does not hold");
  }
  if (m > 0) {
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(qp.A, Eigen::EigenvaluesOnly).eigenvalues();
    if (eigenvalues.minCoeff() < -indefinite * eigenvalues.cwiseAbs().maxCoeff()) {
      group.refuse("A is not positive semidefinite");
    }
  }
  return qp;
}

PrimalQp read_primal(const Group& group) {
  PrimalQp qp;
  qp.g = group.vector("g");
  const Eigen::Index n = qp.g.size();
  if (n == 0) {
    group.refuse("g is empty");
  }
  qp.H = group.symmetric("H", n);
  if (group.has("G") || group.has("e")) {
    qp.e = group.vector("e");
    qp.G = group.matrix("G", qp.e.size(), n);
  } else {
    qp.G.resize(0, n);
  }
  qp.d = group.vector("d");
  qp.C = group.matrix("C", qp.d.size(), n);
  qp.cap = Eigen::VectorXd::Constant(qp.d.size(), std::numeric_limits<double>::infinity());
  group.require_finite("g", qp.g);
  group.require_finite("G", qp.G);
  group.require_finite("e", qp.e);
  group.require_finite("C", qp.C);
  group.require_finite("d", qp.d);
  return qp;
}

}  // namespace

QpSetReader::QpSetReader(const fs::path& file) : h5_(file) {
  for (const std::string& name : h5_.names("/qp")) {
    names_.push_back("/qp/" + name);
  }
  if (names_.empty()) {
    throw InputError(h5_.file() + ": /qp is empty");
  }
  std::stable_sort(names_.begin(), names_.end(), [](const std::string& a, const std::string& b) {
    return a.size() < b.size();  // 9 before 10; names of one length come in order
  });
}

StoredQp QpSetReader::read(std::size_t index) const {
  const std::string& path = names_.at(index);
  const Group group(h5_, path);
  StoredQp qp;
  qp.group = path;
  qp.sequence = h5_.attribute_int(path, "sequence");
  if (group.has("A") == group.has("H")) {
    group.refuse("must have either H (with g, C, d) or A (with b, l, u)");
  }
  if (group.has("A")) {
    qp.box = read_box(group);
  } else {
    qp.primal = read_primal(group);
    try {
      qp.box = dual_of(*qp.primal);
    } catch (const std::invalid_argument&) {  // all else has been looked at
      group.refuse("H is not positive definite");
    }
    if (!qp.box.A.allFinite() || !qp.box.b.allFinite()) {
      group.refuse("C H⁻¹ C' or C H⁻¹ g overflows");
    }
  }
  if (group.has("start")) {
    qp.start = group.vector("start", qp.box.b.size());
    group.require_finite("start", qp.start);
  }
  return qp;
}

QpSetWriter::QpSetWriter(const fs::path& file, bool replace, const std::string& command,
                         const std::string& scene)
    : file_(file, replaced_if(replace)) {
  h5_.root_attribute("format", format);
  h5_.root_attribute("format_version", format_version);
  h5_.root_attribute("description",
                     "QPs in /qp: min ½ v'Hv - g'v, Gv = e, Cv >= d, or min ½ x'Ax - b'x, "
                     "l <= x <= u, A = C H⁻¹ C'; units cm, g, s, rad; start: guess at x");
  h5_.root_attribute("creator_version", build_version());
  h5_.root_attribute("git_revision", build_revision());
  h5_.root_attribute("command", command);
  h5_.root_attribute("scene", scene);
  h5_.group("/qp");
}

void QpSetWriter::append(const StoredQp& qp, std::int64_t step) {
  const std::string path = fmt::format("/qp/{:06}", size_++);
  h5_.group(path);
  if (qp.sequence) {
    h5_.attribute(path, "sequence", *qp.sequence);
  }
  h5_.attribute(path, "step", step);
  const auto put = [&](const char* name, const auto& values) {
    h5_.plain(path + "/" + name, values);
  };
  if (qp.primal) {
    put("H", qp.primal->H);
    put("g", qp.primal->g);
    put("G", qp.primal->G);
    put("e", qp.primal->e);
    put("C", qp.primal->C);
    put("d", qp.primal->d);
  } else {
    put("A", qp.box.A);
    put("b", qp.box.b);
    put("l", qp.box.lower);
    put("u", qp.box.upper);
  }
  if (qp.start.size() > 0) {
    put("start", qp.start);
  }
}

void QpSetWriter::finish() {
  h5_.save(file_.partial());
  file_.publish();
}

}  // namespace hagfish
