#include "experiments/film/film.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/input/number_csv.hpp"
#include "core/input/regular_file.hpp"
#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

/// Excel writes it before UTF-8.
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::size_t least_points = 5;
constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
/// Of the way along a midline's points over what s says. Points that are far apart cut corners, and
/// noise of points that are near makes detours.
constexpr double least_way = 0.2, most_way = 5;
/// Of a film, s or cm, and the least length of its animal, cm: what is fitted squares their ratio.
constexpr double largest_number = 1e9, least_length = 1e-9;

/// A column of lengths: its name with its unit, and cm in one of it.
struct LengthColumn {
  std::string name;
  double cm = 1;
};

class Heading {
 public:
  Heading(const std::string& text, std::string file, double pixels_per_cm)
      : file_(std::move(file)), pixels_per_cm_(pixels_per_cm) {
    std::istringstream lines(text);
    std::string line;
    do {
      if (!std::getline(lines, line)) line.clear();
    } while (lines && (line.starts_with('#') || line.empty() || line == "\r"));
    heading_ = line;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      field.erase(std::remove_if(field.begin(), field.end(),
                                 [](char c) { return c == '"' || c == '\r' || c == ' '; }),
                  field.end());
      names_.push_back(field);
    }
  }
  bool has(const std::string& name) const {
    return std::ranges::find(names_, name) != names_.end();
  }
  [[noreturn]] void fail(const std::string& why) const { throw_input_error(file_ + ": " + why); }

  /// `name` in one of the units of length; nothing where it is in none.
  std::optional<LengthColumn> length(const std::string& name) const {
    for (const auto& [unit, cm] : {std::pair{"cm", 1.0}, {"mm", 0.1}, {"m", 100.0}}) {
      if (has(name + "_" + unit)) return LengthColumn{name + "_" + unit, cm};
    }
    if (has(name + "_px")) {
      if (pixels_per_cm_ <= 0) fail(name + "_px: pixels need --scale, px/cm");
      return LengthColumn{name + "_px", 1 / pixels_per_cm_};
    }
    if (has(name)) fail("column " + name + ": has no unit: " + name + "_cm, _mm, _m or _px");
    return std::nullopt;
  }
  LengthColumn needed(const std::string& name) const {
    const auto column = length(name);
    if (!column) lacks(name + "_cm (or _mm, _m, _px)");
    return *column;
  }
  [[noreturn]] void lacks(const std::string& column) const {
    fail(fmt::format("no column {} among the {} that commas separate in \"{}\"", column,
                     names_.size(), shortened(heading_)));
  }

 private:
  std::string file_, heading_;
  double pixels_per_cm_;
  std::vector<std::string> names_;
};

std::string whole_text(const std::string& file) {
  if (const std::string why = unreadable(file); !why.empty()) throw FileError(file + ": " + why);
  std::error_code error;
  if (std::filesystem::file_size(file, error) > most_bytes || error) {
    throw FileError(file + ": larger than 1 GiB");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw FileError(file + ": cannot be read");
  std::string whole = text.str();
  if (whole.starts_with(byte_order_mark)) whole.erase(0, byte_order_mark.size());
  return whole;
}

/// Shares of the length: by s where there is one, else by the way along the points.
/// Returns the length of the polygon, cm.
double place_points(const Heading& heading, bool by_arc, FilmFrame& frame) {
  const auto n = static_cast<std::size_t>(frame.point.cols());
  const auto fail = [&](const std::string& why) {
    heading.fail(fmt::format("time {:g} s: {}", frame.time, why));
  };
  if (n < least_points) fail(fmt::format("{} points; a midline needs {}", n, least_points));
  for (std::size_t k = 1; k < n; ++k) {
    if (!(frame.place[k] > frame.place[k - 1])) fail("points must rise from head to tail");
  }
  double way = 0;
  std::vector<double> ways{0};
  for (Eigen::Index k = 1; k < frame.point.cols(); ++k) {
    ways.push_back(way += (frame.point.col(k) - frame.point.col(k - 1)).norm());
  }
  if (!(way > 0)) fail("all points are in one place");
  if (!by_arc) {
    for (std::size_t k = 0; k < n; ++k) frame.place[k] = ways[k] / way;
  }
  return way;
}

}  // namespace

Film read_film(const std::string& file, double pixels_per_cm) {
  const std::string text = whole_text(file);
  const Heading heading(text, file, pixels_per_cm);
  if (!heading.has("time_s")) heading.lacks("time_s");
  const auto arc = heading.length("s");
  if (!arc && !heading.has("point")) heading.lacks("s_cm or point");
  const LengthColumn x = heading.needed("x"), y = heading.needed("y");
  const auto z = heading.length("z");
  const std::string order = arc ? arc->name : "point";
  Film film;
  film.planar = !z;
  const double unit = arc ? arc->cm : 1;
  double longest = 0;
  std::vector<std::vector<Eigen::Vector3d>> points;
  const auto take = [&](double time, double place, const Eigen::Vector3d& point) -> std::string {
    const double largest =
        std::max({std::abs(time), std::abs(place), point.lpNorm<Eigen::Infinity>()});
    if (largest > largest_number) {
      return fmt::format("{:g}: must be of at most {:g} s or cm", largest, largest_number);
    }
    if (film.frames.empty() || time != film.frames.back().time) {
      if (!film.frames.empty() && time < film.frames.back().time) return "times must rise";
      film.frames.push_back({time, {}, {}});
      points.emplace_back();
    }
    film.frames.back().place.push_back(place);
    points.back().push_back(point);
    longest = std::max(longest, place);
    return {};
  };
  if (z) {
    read_number_csv<5>(
        text, file, {"time_s", order, x.name, y.name, z->name}, [&](const auto& row) {
          return take(row[0], unit * row[1], {x.cm * row[2], y.cm * row[3], z->cm * row[4]});
        });
  } else {
    read_number_csv<4>(text, file, {"time_s", order, x.name, y.name}, [&](const auto& row) {
      return take(row[0], unit * row[1], {x.cm * row[2], y.cm * row[3], 0});
    });
  }
  if (film.frames.size() < 2) heading.fail("midlines of two times or more are needed");
  const auto check_length = [&heading](double length) {
    if (length < least_length) heading.fail(fmt::format("an animal {:g} cm long", length));
  };
  for (std::size_t f = 0; f < film.frames.size(); ++f) {
    FilmFrame& frame = film.frames[f];
    frame.point.resize(3, static_cast<Eigen::Index>(points[f].size()));
    for (std::size_t k = 0; k < points[f].size(); ++k) {
      frame.point.col(static_cast<Eigen::Index>(k)) = points[f][k];
    }
    const double way = place_points(heading, arc.has_value(), frame);
    film.length = std::max(film.length, arc ? longest : way);
    check_length(film.length);
    if (!arc) continue;
    if (frame.place[0] < 0) heading.fail(arc->name + " is below 0");
    const double share = way / (frame.place.back() - frame.place.front());
    if (share < least_way || share > most_way) {
      heading.fail(
          fmt::format("time {:g} s: its points lie {:.3g} cm apart along the body, by {} "
                      "{:.3g} cm: is one in another unit?",
                      frame.time, way, arc->name, way / share));
    }
    for (double& place : frame.place) place /= longest;
  }
  return film;
}

Eigen::Vector3d point_on(const Model& model, const Kinematics& kin, double place) {
  const double at = place * model.body_count();
  const int body = std::clamp(static_cast<int>(at), 0, model.body_count() - 1);
  return kin.origin.col(body) + (at - body) * model.bodies[body].length * kin.rotation[body].col(0);
}

RigidMotion nearest_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Vector3d a = from.rowwise().mean(), b = to.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd((to.colwise() - b) * (from.colwise() - a).transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  RigidMotion motion;
  motion.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  motion.shift = b - motion.rotation * a;
  return motion;
}

}  // namespace hagfish
