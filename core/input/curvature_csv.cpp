#include "core/input/curvature_csv.hpp"

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

struct Sample {
  double time = 0, station = 0;
  Eigen::Vector3d value;
};

[[noreturn]] void fail(const std::string& name, unsigned line, const std::string& why) {
  throw_input_error(fmt::format("{}:{}: {}", name, line, why));
}

/// Puts one row of the file at the end of `program`.
void append(const Sample& row, const std::string& name, unsigned line, CurvatureProgram& program) {
  const bool first = program.time.empty();
  const std::size_t stations = program.station.size();
  const auto at = first ? std::size_t{0} : static_cast<std::size_t>(program.value.back().cols());
  if (first || row.time != program.time.back()) {
    if (first ? row.time != 0 : row.time < program.time.back()) {
      fail(name, line, first ? "the first time must be 0" : "times must rise");
    }
    if (!first && at != stations) {
      fail(name, line,
           fmt::format("time {:g} has {} of {} stations", program.time.back(), at, stations));
    }
    program.time.push_back(row.time);
    program.value.emplace_back(3, 0);
  }
  Eigen::Matrix3Xd& values = program.value.back();
  const auto place = static_cast<std::size_t>(values.cols());
  if (program.time.size() == 1) {
    const double before = place == 0 ? 0 : program.station.back();
    if (!(row.station >= before && row.station <= 1) || (place > 0 && row.station == before)) {
      fail(name, line, "stations must rise from 0 to 1");
    }
    program.station.push_back(row.station);
  } else if (place >= stations || row.station != program.station[place]) {
    fail(name, line, "each time must have the stations of the first");
  }
  values.conservativeResize(3, values.cols() + 1);
  values.rightCols<1>() = row.value;
}

}  // namespace

CurvatureProgram read_curvature_csv(const std::string& text, const std::string& name) {
  CurvatureProgram program;
  try {
    std::istringstream stream(text);
    Reader reader(name, stream);
    const auto& column = curvature_columns;
    reader.read_header(io::ignore_extra_column, column[0], column[1], column[2], column[3],
                       column[4]);
    char* field[5];
    while (reader.read_row(field[0], field[1], field[2], field[3], field[4])) {
      double number[5];
      for (int i = 0; i < 5; ++i) {
        const std::optional<double> read = finite_number(field[i]);
        if (!read) {
          fail(name, reader.get_file_line(),
               fmt::format("{} = {}: must be a number", column[i], shortened(field[i])));
        }
        number[i] = *read;
      }
      append({number[0], number[1], {number[2], number[3], number[4]}}, name,
             reader.get_file_line(), program);
    }
  } catch (const io::error::base& error) {
    throw_input_error(name + ": " + error.what());
  }
  const std::size_t times = program.time.size();
  if (times < 2) throw_input_error(name + ": a program needs two times or more");
  if (program.value.back().cols() != program.value.front().cols()) {
    throw_input_error(name + ": its last time has not all stations");
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
