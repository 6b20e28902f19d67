#include "experiments/sweep/sweep_table.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iterator>
#include <sstream>
#include <utility>

#include "core/input/input_text.hpp"
#include "experiments/common/csv.hpp"
#include "experiments/common/text_file.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

constexpr const char* identity_name = "sweep.toml";

[[noreturn]] void throw_system_error(const fs::path& file, const char* what) {
  throw FileError(file.string() + ": cannot be " + what + ": " + std::strerror(errno));
}

/// The first line in which two texts differ.
std::pair<std::string, std::string> first_difference(const std::string& a, const std::string& b) {
  std::istringstream in_a(a), in_b(b);
  std::string of_a, of_b;
  do {
    of_a.clear();
    of_b.clear();
    std::getline(in_a, of_a);
    std::getline(in_b, of_b);
  } while (of_a == of_b && in_a && in_b);
  return {of_a, of_b};
}

/// The number of the cell that a line of the table begins with, and where its CPU time begins.
std::pair<std::size_t, std::size_t> ends_of_line(const std::string& line) {
  std::size_t cell = 0;
  const auto read = std::from_chars(line.data(), line.data() + line.size(), cell);
  const std::size_t last = line.rfind(',');
  if (read.ec != std::errc() || last == std::string::npos || line[read.ptr - line.data()] != ',' ||
      !finite_number(line.substr(last + 1))) {
    throw FileError("damaged");
  }
  return {cell, last};
}

}  // namespace

std::vector<std::size_t> SweepPart::cells(std::size_t size) const {
  std::vector<std::size_t> mine;
  for (std::size_t cell = index - 1; cell < size; cell += count) mine.push_back(cell);
  return mine;
}

void claim_folder(const fs::path& folder, const std::string& identity) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder.string() + ": cannot be created: " + error.message());
  const fs::path file = folder / identity_name;
  if (!fs::exists(file, error)) {
    // By a link, which one process of several makes, with all of the text.
    const fs::path own = fmt::format("{}.{}.new", file.string(), ::getpid());
    fs::remove(own, error);
    try {
      AppendedFile(own).add(identity);
    } catch (const FileError&) {
      fs::remove(own, error);
      throw;
    }
    const bool made = ::link(own.c_str(), file.c_str()) == 0 || errno == EEXIST;
    const int reason = errno;
    fs::remove(own, error);
    errno = reason;
    if (!made) throw_system_error(file, "created");
  }
  const auto [there, here] = first_difference(text_of(file), identity);
  if (there != here) {
    throw FileError(fmt::format("{}: holds another sweep: it has \"{}\", this one \"{}\"",
                                folder.string(), shortened(printable(there)),
                                shortened(printable(here))));
  }
}

SweepTable::SweepTable(const fs::path& folder, const SweepPart& part, std::size_t size,
                       const std::vector<std::string>& heading)
    : cells_(part.cells(size)), heading_(csv_text({heading})) {
  const std::string suffix =
      part.count == 1 ? ".csv" : fmt::format(".{}-of-{}.csv", part.index, part.count);
  table_ = folder / ("table" + suffix);
  times_ = folder / ("times" + suffix);
  std::error_code error;
  if (fs::is_regular_file(table_, error)) {
    done_ = cells_;
    return;
  }
  const bool begun = fs::exists(table_.string() + ".part", error);
  file_ = std::make_unique<OutputFile>(table_, begun ? Existing::go_on : Existing::refuse);
  if (begun) read_rows();
  rows_ = std::make_unique<AppendedFile>(file_->partial());
}

/// What a kill left of a last line is cut off.
void SweepTable::read_rows() {
  const fs::path& partial = file_->partial();
  std::string text = text_of(partial);
  const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  if (whole < text.size()) fs::resize_file(partial, whole);
  std::istringstream lines(text.substr(0, whole));
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    try {
      const std::size_t cell = ends_of_line(line).first;
      if (!std::ranges::binary_search(cells_, cell)) throw FileError("of another part");
      done_.push_back(cell);
    } catch (const FileError& error) {
      throw FileError(fmt::format("{}:{}: the row is {}", partial.string(), number, error.what()));
    }
  }
  std::ranges::sort(done_);
  if (std::ranges::adjacent_find(done_) != done_.end()) {
    throw FileError(partial.string() + ": has two rows of one cell");
  }
}

std::vector<std::size_t> SweepTable::missing() const {
  std::vector<std::size_t> cells;
  std::ranges::set_difference(cells_, done_, std::back_inserter(cells));
  return cells;
}

void SweepTable::add(std::size_t cell, const std::vector<std::string>& fields, double cpu_time) {
  std::vector<std::string> row{std::to_string(cell)};
  row.insert(row.end(), fields.begin(), fields.end());
  row.push_back(fmt::format("{:.4f}", cpu_time));
  rows_->add(csv_text({row}));
}

void SweepTable::finish() {
  if (!file_) return;
  const fs::path& partial = file_->partial();
  std::vector<std::pair<std::size_t, std::string>> rows;
  std::istringstream lines(text_of(partial));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back(ends_of_line(line).first, line);
  }
  std::ranges::sort(rows);
  std::string table = heading_, times = "cell,cpu_s\n";
  for (const auto& [cell, line] : rows) {
    const std::size_t last = ends_of_line(line).second;
    table += line.substr(0, last) + '\n';
    times += std::to_string(cell) + line.substr(last) + '\n';
  }
  TextFile(times_.string(), true).write(times);
  // The sorted rows take the place of those in the order in which they came in one step: a kill
  // leaves the one or the other.
  const fs::path sorted = partial.string() + ".new";
  std::error_code error;
  fs::remove(sorted, error);
  AppendedFile(sorted).add(table);
  if (std::rename(sorted.c_str(), table_.c_str()) != 0) throw_system_error(table_, "named");
  fs::remove(partial, error);
}

}  // namespace hagfish
