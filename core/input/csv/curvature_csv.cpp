#include "core/input/csv/curvature_csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/input/csv/number_csv.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

struct Sample {
  double time = 0, station = 0;
  Eigen::Vector3d value;
};

/// Puts one row of the file at the end of `program`. Says why where it cannot follow the others.
std::string append(const Sample& row, CurvatureProgram& program) {
  const bool first = program.time.empty();
  const std::size_t stations = program.station.size();
  const auto at = first ? std::size_t{0} : static_cast<std::size_t>(program.value.back().cols());
  if (first || row.time != program.time.back()) {
    if (first ? row.time != 0 : row.time < program.time.back()) {
      return first ? "the first time must be 0" : "times must rise";
    }
    if (!first && at != stations) {
      return fmt::format("time {:g} has {} of {} stations", program.time.back(), at, stations);
    }
    program.time.push_back(row.time);
    program.value.emplace_back(3, 0);
  }
  Eigen::Matrix3Xd& values = program.value.back();
  const auto index = static_cast<std::size_t>(values.cols());
  if (program.time.size() == 1) {
    const double before = index == 0 ? 0 : program.station.back();
    if (!(row.station >= before && row.station <= 1) || (index > 0 && row.station == before)) {
      return "stations must rise from 0 to 1";
    }
    program.station.push_back(row.station);
  } else if (index >= stations || row.station != program.station[index]) {
    return "each time must have the stations of the first";
  }
  values.conservativeResize(3, values.cols() + 1);
  values.rightCols<1>() = row.value;
  return {};
}

}  // namespace

CurvatureProgram read_curvature_csv(const std::string& text, const std::string& name) {
  CurvatureProgram program;
  const auto& column = curvature_columns;
  read_number_csv(text, name, {column[0], column[1], column[2], column[3], column[4]},
                  [&](const std::array<double, 5>& row) {
                    return append({row[0], row[1], {row[2], row[3], row[4]}}, program);
                  });
  const std::size_t times = program.time.size();
  if (times < 2) throw_input_error(name + ": a program needs two times or more");
  if (program.value.back().cols() != program.value.front().cols()) {
    throw_input_error(name + ": the last time does not have all stations");
  }
  return program;
}

std::string curvature_csv(const CurvatureProgram& program) {
  // Adding 0 makes a plain 0 of -0.
  const auto rounded = [](double x) {
    return std::round(x / curvature_rounding) / std::round(1 / curvature_rounding) + 0.0;
  };
  std::string text = fmt::format("{}\n", fmt::join(curvature_columns, ","));
  for (std::size_t k = 0; k < program.time.size(); ++k) {
    for (std::size_t j = 0; j < program.station.size(); ++j) {
      const Eigen::Vector3d v = program.value[k].col(static_cast<Eigen::Index>(j));
      text += fmt::format("{:.5g},{:.5g},{},{},{}\n", program.time[k], program.station[j],
                          rounded(v[0]), rounded(v[1]), rounded(v[2]));
    }
  }
  return text;
}

}  // namespace hagfish
