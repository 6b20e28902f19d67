#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "core/input/input_text.hpp"
#include "experiments/benchmarks/qp_measure.hpp"
#include "experiments/common/csv.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

/// Quantile of a back end's times, beside their median.
constexpr double upper_quantile = 0.99;
constexpr double microseconds = 1e6;

struct QpOptions {
  std::string set;                     ///< HDF5 file of QPs
  std::vector<std::string> back_ends;  ///< those of measured_back_ends() where empty
  std::vector<double> tolerances;      ///< of Ipopt, each in turn; its own where empty
  int repeat = 3;                      ///< times that each QP is solved
  std::string csv;                     ///< table as a file; none where empty
  bool force = false;
};

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

/// A number, or nothing where it does not apply.
std::string number(const char* form, double value, bool applies = true) {
  return applies ? fmt::format(fmt::runtime(form), value) : "";
}

CsvTable csv_of(const QpReport& report) {
  CsvTable table{{"back_end", "tolerance", "start", "qps", "median_s", "p99_s", "max_s",
                  "iterations", "kkt", "error_norm", "error_norm_relative", "error_entry",
                  "error_entry_relative", "without_reference", "failures"}};
  for (const Performance& row : report.rows) {
    const bool entries = report.primal > 0;
    const double tolerance = row.back_end.tolerance;
    table.push_back({row.back_end.name, number("{:g}", tolerance, !std::isnan(tolerance)),
                     row.warm ? "warm" : "cold", std::to_string(row.time.size()),
                     number("{:.9g}", quantile(row.time, 0.5)),
                     number("{:.9g}", quantile(row.time, upper_quantile)),
                     number("{:.9g}", quantile(row.time, 1)), std::to_string(row.iterations),
                     number("{:.6g}", row.kkt), number("{:.6g}", row.velocity.norm),
                     number("{:.6g}", row.velocity.relative),
                     number("{:.6g}", row.velocity.largest, entries),
                     number("{:.6g}", row.velocity.largest_relative, entries),
                     std::to_string(report.without_reference), std::to_string(row.failures)});
  }
  return table;
}

std::string label(const BackEnd& back_end) {
  return std::isnan(back_end.tolerance) ? back_end.name
                                        : fmt::format("{} {:g}", back_end.name, back_end.tolerance);
}

/// What was measured: the QPs of `file`, their warm starts, each solved `repeat` times.
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
             report.primal == 0
                 ? ""
                 : "; entry: largest, over the velocity's with or without rows (primal QPs)");
}

/// A row for each back end and start.
void print_table(const QpReport& report) {
  fmt::print("\n{:<24} {:<5} {:>11} {:>9} {:>7}  {:>9} {:>9} {:>9} {:>8}\n", "back end", "start",
             "median, µs", "99 %, µs", "speed", "KKT", "H norm", "entry", "failures");
  for (std::size_t k = 0; k < report.rows.size(); ++k) {
    const Performance& row = report.rows[k];
    const double median = quantile(row.time, 0.5);
    const double first = quantile(report.rows[row.warm ? 1 : 0].time, 0.5);
    fmt::print("{:<24} {:<5} {:>11.1f} {:>9.1f} {:>7.3g}  {:>9.1e} {:>9.1e} {:>9} {:>8}\n",
               label(row.back_end), row.warm ? "warm" : "cold", microseconds * median,
               microseconds * quantile(row.time, upper_quantile), first / median, row.kkt,
               row.velocity.relative,
               report.primal == 0 ? "-" : fmt::format("{:.1e}", row.velocity.largest_relative),
               row.failures);
  }
  if (report.without_reference > 0) {
    fmt::print("\n{} QPs are without a reference: errors in velocity leave them out\n",
               report.without_reference);
  }
}

int qp(const QpOptions& options) {
  const QpSetReader set(options.set);
  std::optional<TextFile> csv;
  if (!options.csv.empty()) {
    csv.emplace(options.csv, options.force);
  }
  const QpReport report = measure(set, chosen(options), options.repeat);
  print_heading(printable(options.set), report, options.repeat);
  print_table(report);
  if (!options.csv.empty()) {
    csv->write(csv_text(csv_of(report)));
  }
  int failures = 0;
  for (const Performance& row : report.rows) {
    failures += row.failures;
  }
  if (failures == 0) {
    return exit_code::done;
  }
  std::fflush(stdout);
  for (const std::string& failure : report.failures) {
    say("hagfish: {}\n", printable(options.set + ": " + failure));
  }
  if (const auto told = static_cast<int>(report.failures.size()); failures > told) {
    say("hagfish: {}: and {} more failures\n", printable(options.set), failures - told);
  }
  return exit_code::failed;
}

}  // namespace

void add_qp(Program& program) {
  const auto options = std::make_shared<QpOptions>();
  CLI::App* qp_app = program.app.add_subcommand(
      "qp", "solve a set of QPs with each back end, cold and warm; exits 1 where one fails");
  qp_app->add_option("SET", options->set, "HDF5 file of QPs")->required();
  qp_app->add_option("--backend", options->back_ends, "repeatable (all)")
      ->check(one_of(measured_back_ends()))
      ->allow_extra_args(false);
  qp_app
      ->add_option("--tolerance", options->tolerances,
                   "where Ipopt stops, repeatable: measures each (1e-4; unpolished 1e-9)")
      ->check(above_zero())
      ->allow_extra_args(false);
  qp_app->add_option("--repeat", options->repeat, "times that each QP is solved")
      ->check(above_zero())
      ->capture_default_str();
  qp_app->add_option("--csv", options->csv, "file for the table");
  qp_app->add_flag("--force", options->force, force_help);
  qp_app->callback([options, &program] { program.code = qp(*options); });
}

}  // namespace hagfish
