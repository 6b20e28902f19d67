#include "core/input/basis_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"

#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

namespace hagfish {
namespace {

using Reader = io::CSVReader<5, io::trim_chars<' ', '\t'>, io::double_quote_escape<',', '"'>,
                             io::throw_on_overflow, io::single_line_comment<'#'>>;

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
  if (count == 0 || sample.shape != static_cast<double>(read / count) + 1) {
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
  const auto& column = basis_columns;
  try {
    std::istringstream stream(text);
    Reader reader(name, stream);
    reader.read_header(io::ignore_extra_column, column[0],
                       window ? window_station_column : column[1], column[2], column[3], column[4]);
    char* field[5];
    while (reader.read_row(field[0], field[1], field[2], field[3], field[4])) {
      double number[5];
      for (int i = 0; i < 5; ++i) {
        const std::optional<double> value = finite_number(field[i]);
        if (!value) {
          throw_input_error(fmt::format("{}:{}: {} = {}: must be a number", name,
                                        reader.get_file_line(), column[i], shortened(field[i])));
        }
        number[i] = *value;
      }
      const Sample sample{number[0], number[1], number[2], number[3], number[4]};
      if (const std::string why = objection(sample, basis); !why.empty()) {
        throw_input_error(fmt::format("{}:{}: {}", name, reader.get_file_line(), why));
      }
      if (sample.shape == 1) basis.stations.push_back(sample.station);
      basis.bend_y.push_back(sample.bend_y);
      basis.bend_z.push_back(sample.bend_z);
      basis.twist.push_back(sample.twist);
    }
  } catch (const io::error::base& error) {
    throw_input_error(name + ": " + error.what());
  }
  if (basis.stations.size() < 2) throw_input_error(name + ": a basis needs two stations or more");
  if (basis.bend_y.size() % basis.stations.size() != 0) {
    throw_input_error(name + ": its last shape has not all stations");
  }
  const double end = window ? 1 : length;
  if (std::abs(basis.stations.back() - end) > rounding * end) {
    throw_input_error(
        window ? fmt::format("{}: its stations end at {:g} of the knot's window, not at 1", name,
                             basis.stations.back())
               : fmt::format("{}: the basis of a body of {:g} cm, but the animal has {:g} cm", name,
                             basis.stations.back(), length));
  }
}

}  // namespace hagfish
