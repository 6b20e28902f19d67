#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "core/input/input_error.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/qp/qp_measure.hpp"

namespace hagfish {
namespace {

constexpr double microseconds = 1e6;
constexpr double tail = 0.99;

std::vector<BackEnd> chosen(const QpOptions& options) {
  const std::vector<std::string> names =
      options.back_ends.empty() ? measured_back_ends() : options.back_ends;
  std::vector<BackEnd> back_ends;
  for (const std::string& name : names) {
    if (options.tolerances.empty() || !name.starts_with("ipopt")) {
      back_ends.push_back({name});
      continue;
    }
    for (const double tolerance : options.tolerances) {
      back_ends.push_back({name, tolerance});
    }
  }
  return back_ends;
}

std::string label(const BackEnd& back_end) {
  return std::isnan(back_end.tolerance) ? back_end.name
                                        : fmt::format("{} {:g}", back_end.name, back_end.tolerance);
}

void print_heading(const std::string& file, const QpReport& report, int repeat) {
  std::vector<double> rows(report.row_counts.begin(), report.row_counts.end());
  fmt::print("{}: {} QPs ({} primal) in {} sequences; {:g} to {:g} rows, median {:g}\n", file,
             rows.size(), report.primal, report.sequences, quantile(rows, 0), quantile(rows, 1),
             quantile(rows, 0.5));
  fmt::print("warm starts: {} stored, {} carried over, {} zero\n", report.stored_starts,
             report.carried_starts, rows.size() - report.stored_starts - report.carried_starts);
  fmt::print("time: of solve() alone, least of {}; speed: over the first back end's, by medians\n",
             repeat);
  fmt::print("H norm: error of the velocity against long double, over the rows' change of it{}\n",
             report.primal == 0 ? "" : "; entry: largest, over the velocity's (primal QPs)");
}

void print_table(const QpReport& report) {
  fmt::print("\n{:<24} {:<5} {:>11} {:>9} {:>7}  {:>9} {:>9} {:>9} {:>8}\n", "back end", "start",
             "median, µs", "99 %, µs", "speed", "KKT", "H norm", "entry", "failures");
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const Performance& row = report.rows[k];
    const double median = quantile(row.time, 0.5);
    const double first = quantile(report.rows[row.warm ? 1 : 0].time, 0.5);
    fmt::print("{:<24} {:<5} {:>11.1f} {:>9.1f} {:>7.3g}  {:>9.1e} {:>9.1e} {:>9} {:>8}\n",
               label(row.back_end), row.warm ? "warm" : "cold", microseconds * median,
               microseconds * quantile(row.time, tail), first / median, row.kkt,
               row.velocity.relative,
               report.primal == 0 ? "-" : fmt::format("{:.1e}", row.velocity.largest_relative),
               row.failures);
  }
  if (report.without_reference > 0) {
    fmt::print("\n{} QPs are without a reference: errors in velocity leave them out\n",
               report.without_reference);
  }
}

fmt::ostream open_csv(const std::string& file) {
  try {
    return fmt::output_file(file);
  } catch (const std::system_error& error) {
    throw FileError(file + ": cannot be written: " + error.code().message());
  }
}

/// Whether the folder takes files must show before the work, not after.
void try_csv(const std::string& file) {
  const std::string trial = file + ".part";
  open_csv(trial).close();
  std::filesystem::remove(trial);
}

void write_csv(const std::string& file, const QpReport& report) {
  auto out = open_csv(file);
  out.print(
      "back_end,tolerance,start,qps,median_s,p99_s,max_s,iterations,kkt,"
      "error_norm,error_norm_relative,error_entry,error_entry_relative,"
      "without_reference,failures\n");
  for (const Performance& row : report.rows) {
    const bool entries = report.primal > 0;
    out.print(
        "{},{},{},{},{:.9g},{:.9g},{:.9g},{},{:.6g},{:.6g},{:.6g},{},{},{},{}\n", row.back_end.name,
        std::isnan(row.back_end.tolerance) ? "" : fmt::format("{:g}", row.back_end.tolerance),
        row.warm ? "warm" : "cold", row.time.size(), quantile(row.time, 0.5),
        quantile(row.time, tail), quantile(row.time, 1), row.iterations, row.kkt, row.velocity.norm,
        row.velocity.relative, entries ? fmt::format("{:.6g}", row.velocity.largest) : "",
        entries ? fmt::format("{:.6g}", row.velocity.largest_relative) : "",
        report.without_reference, row.failures);
  }
  out.close();
}

}  // namespace

int qp(const QpOptions& options) {
  const QpSetReader set(options.set);
  if (!options.csv.empty()) {
    try_csv(options.csv);
  }
  const QpReport report = measure(set, chosen(options), options.repeat);
  print_heading(options.set, report, options.repeat);
  print_table(report);
  if (!options.csv.empty()) {
    write_csv(options.csv, report);
  }
  int failures = 0;
  for (const Performance& row : report.rows) {
    failures += row.failures;
  }
  if (failures == 0) {
    return 0;
  }
  std::fflush(stdout);
  for (const std::string& failure : report.failures) {
    fmt::print(stderr, "hagfish: {}: {}\n", options.set, failure);
  }
  if (const auto told = static_cast<int>(report.failures.size()); failures > told) {
    fmt::print(stderr, "hagfish: {}: and {} more failures\n", options.set, failures - told);
  }
  return 1;
}

}  // namespace hagfish
