// A set of QPs as other programs write it: by the HDF5 API, not by ours.
#pragma once

#include <H5Cpp.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace hagfish {

class ForeignQps {
 public:
  explicit ForeignQps(const std::string& file) : h5_(file, H5F_ACC_TRUNC) {
    h5_.createGroup("/qp");
  }

  /// Begins a problem, to which what follows belongs.
  void problem(const std::string& name) {
    group_ = "/qp/" + name + "/";
    h5_.createGroup(group_);
  }

  void sequence(std::int64_t number) {
    h5_.openGroup(group_)
        .createAttribute("sequence", H5::PredType::STD_I32BE, H5::DataSpace(H5S_SCALAR))
        .write(H5::PredType::NATIVE_INT64, &number);
  }

  void vector(const std::string& name, const std::vector<double>& values) {
    const hsize_t size = values.size();
    h5_.createDataSet(group_ + name, H5::PredType::IEEE_F64LE, H5::DataSpace(1, &size))
        .write(values.data(), H5::PredType::NATIVE_DOUBLE);
  }

  /// `values` row by row.
  void matrix(const std::string& name, hsize_t rows, const std::vector<double>& values,
              hsize_t columns) {
    const std::array<hsize_t, 2> shape{rows, columns};
    h5_.createDataSet(group_ + name, H5::PredType::IEEE_F64LE, H5::DataSpace(2, shape.data()))
        .write(values.data(), H5::PredType::NATIVE_DOUBLE);
  }

  void replace(const std::string& name, const std::vector<double>& values) {
    h5_.unlink(group_ + name);
    vector(name, values);
  }

  void replace(const std::string& name, hsize_t rows, const std::vector<double>& values,
               hsize_t columns) {
    h5_.unlink(group_ + name);
    matrix(name, rows, values, columns);
  }

  H5::H5File& h5() { return h5_; }
  const std::string& group() const { return group_; }

 private:
  H5::H5File h5_;
  std::string group_;
};

/// v = (1, 2) wished for, v_0 + v_1 <= 2 and v_1 >= 0 required: v = (0.5, 1.5), λ = (0.5, 0).
inline void put_primal(ForeignQps& set) {
  set.matrix("H", 2, {1, 0, 0, 1}, 2);
  set.vector("g", {1, 2});
  set.matrix("C", 2, {-1, -1, 0, 1}, 2);
  set.vector("d", {-2, 0});
}

/// x = (1, 0) with w = (0, 2).
inline void put_box(ForeignQps& set) {
  set.matrix("A", 2, {2, 1, 1, 2}, 2);
  set.vector("b", {2, -1});
  set.vector("l", {0, 0});
  set.vector("u", {std::numeric_limits<double>::infinity(), 3});
}

/// v >= 1 and -v >= 1.
inline void put_contradiction(ForeignQps& set) {
  set.matrix("H", 1, {1}, 1);
  set.vector("g", {0});
  set.matrix("C", 2, {1, -1}, 1);
  set.vector("d", {1, 1});
}

}  // namespace hagfish
