#include "experiments/benchmarks/qp_table.hpp"

#include <fmt/format.h>

#include <cmath>

namespace hagfish {
namespace {

constexpr double microseconds = 1e6;

std::string label(const BackEnd& back_end) {
  return std::isnan(back_end.tolerance) ? back_end.name
                                        : fmt::format("{} {:g}", back_end.name, back_end.tolerance);
}

}  // namespace

void print_qp_heading(const std::string& file, const QpReport& report, int repeat) {
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

void print_qp_table(const QpReport& report) {
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

}  // namespace hagfish
