#include "core/input/csv/basis_csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/input/csv/number_csv.hpp"
#include "core/input/input_text.hpp"

namespace hagfish {
namespace {

/// A station may be off by what a file rounds, as a share of the length.
constexpr double rounding = 1e-4;

struct Sample {
  double shape = 0, station = 0, bend_y = 0, bend_z = 0, twist = 0;
};

/// Why `sample` cannot follow what `basis` has of the shapes so far; empty where it can.
std::string objection(const Sample& sample, const ReducedBasisSettings& basis) {
  const std::size_t read = basis.bend_y.size();
  const std::size_t count = basis.stations.size();
  if (sample.shape == 1) {
    if (read > count) return "shapes must be 1, 2, 3, ...";
    const bool rises = count == 0 ? sample.station == 0 : sample.station > basis.stations.back();
    return rises ? "" : "stations must rise from 0";
  }
  const std::size_t shape = count == 0 ? 0 : read / count + 1;
  if (count == 0 || sample.shape != static_cast<double>(shape)) {
    return "shapes must be 1, 2, 3, ..., each with all stations";
  }
  return sample.station == basis.stations[read % count]
             ? ""
             : "each shape must have the stations of the first";
}

}  // namespace

void read_basis_csv(const std::string& text, const std::string& name, double length,
                    ReducedBasisSettings& basis) {
  const bool window = basis.frame == BasisFrame::knot;
  const std::array<std::string, 5> columns{basis_columns[0],
                                           window ? window_station_column : basis_columns[1],
                                           basis_columns[2], basis_columns[3], basis_columns[4]};
  read_number_csv(text, name, columns, [&](const std::array<double, 5>& row) {
    const Sample sample{row[0], row[1], row[2], row[3], row[4]};
    std::string why = objection(sample, basis);
    if (!why.empty()) return why;
    if (sample.shape == 1) basis.stations.push_back(sample.station);
    basis.bend_y.push_back(sample.bend_y);
    basis.bend_z.push_back(sample.bend_z);
    basis.twist.push_back(sample.twist);
    return why;
  });
  if (basis.stations.size() < 2) throw_input_error(name + ": a basis needs two stations or more");
  if (basis.bend_y.size() % basis.stations.size() != 0) {
    throw_input_error(name + ": the last shape does not have all stations");
  }
  const double end = window ? 1 : length;
  if (std::abs(basis.stations.back() - end) > rounding * end) {
    throw_input_error(
        window ? fmt::format(
                     "{}: the last station is {:g} and must be 1, the end of the knot's window",
                     name, basis.stations.back())
               : fmt::format("{}: made for a body of {:g} cm, but the animal is {:g} cm long", name,
                             basis.stations.back(), length));
  }
}

}  // namespace hagfish
