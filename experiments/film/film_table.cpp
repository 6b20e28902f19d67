#include "experiments/film/film_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/input/csv/delimited_text.hpp"
#include "core/input/files/text_file.hpp"
#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/common/text_file.hpp"

namespace hagfish {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
/// Of a film, s or a unit of length: what is fitted squares it.
constexpr double largest_number = 1e9;

std::string lower(std::string_view text) {
  std::string out;
  for (const char c : text) out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// A column of lengths: which one, and units of the table in one of it.
struct LengthColumn {
  std::size_t column = 0;
  double size = 1;
  bool pixels = false;
};

/// Columns of one point in a table with a row for each time.
struct PointColumns {
  std::string name;
  LengthColumn x, y;
  std::optional<LengthColumn> z;
  std::optional<std::size_t> likelihood;
};

/// The rows of a table, read by the columns that its heading names.
class TableReader {
 public:
  TableReader(DelimitedText text, std::string file, const FilmReading& reading)
      : text_(std::move(text)), file_(std::move(file)), reading_(reading) {
    table_.unit = "cm";
  }

  FilmTable read() {
    const std::string first = text_.rows() > 0 ? lower(text_.cell(0, 0)) : "";
    if (first == "scorer") {
      deep_lab_cut();
    } else if (first.starts_with("number of header lines")) {
      wide(header_rows(), true);
    } else {
      name_columns(0);
      const bool spaced = std::ranges::any_of(names_, [](const std::string& name) {
        return name.starts_with("x ") && !name.starts_with("x (");
      });
      const bool joined =
          std::ranges::any_of(names_, [](const std::string& name) { return name.ends_with("_x"); });
      if (spaced) {
        wide(1, false);
      } else if (joined) {
        triangulated();
      } else {
        tall();
      }
    }
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { throw_input_error(file_ + ": " + why); }

  void name_columns(std::size_t row) {
    names_.clear();
    if (row >= text_.rows()) return;
    for (std::size_t k = 0; k < text_.cells(row); ++k) names_.push_back(lower(text_.cell(row, k)));
  }
  std::optional<std::size_t> column(const std::string& name) const {
    const auto at = std::ranges::find(names_, name);
    if (at == names_.end()) return std::nullopt;
    if (std::find(at + 1, names_.end(), name) != names_.end()) {
      fail("column " + name + ": its heading has this name twice");
    }
    return static_cast<std::size_t>(at - names_.begin());
  }
  [[noreturn]] void lacks(const std::string& name) const {
    std::string heading;
    for (const std::string& column : names_) heading += (heading.empty() ? "" : ",") + column;
    fail(fmt::format("no column {} among the {} that {} separate in \"{}\"", name, names_.size(),
                     text_.separator_name(), shortened(heading)));
  }

  double number(std::size_t row, std::size_t column, const std::string& name) const {
    const std::optional<double> value = text_.number(row, column);
    const auto line = text_.line(row);
    if (!value) {
      throw_input_error(fmt::format("{}:{}: {} = {}: must be a number", file_, line, name,
                                    shortened(std::string(text_.cell(row, column)))));
    }
    if (std::abs(*value) > largest_number) {
      throw_input_error(fmt::format("{}:{}: {} = {:g}: must be at most {:g} in size", file_, line,
                                    name, *value, largest_number));
    }
    return *value;
  }
  double needed(std::size_t row, std::size_t column, const std::string& name) const {
    const double value = number(row, column, name);
    if (std::isnan(value)) {
      throw_input_error(fmt::format("{}:{}: {} is missing", file_, text_.line(row), name));
    }
    return value;
  }
  bool unsure(std::size_t row, std::optional<std::size_t> likelihood) const {
    if (!likelihood) return false;
    return !(number(row, *likelihood, "likelihood") >= reading_.likelihood);
  }

  /// `name` with a unit of length behind it, or with that of --unit; nothing where there is none.
  std::optional<LengthColumn> length(const std::string& name) {
    std::vector<LengthColumn> found;
    const auto look = [&](const std::string& unit, double cm, bool pixels) {
      for (const std::string& full : {name + "_" + unit, name + " (" + unit + ")"}) {
        if (const auto at = column(full)) found.push_back({*at, cm, pixels});
      }
    };
    for (const auto& [unit, cm] : length_units) look(unit, cm, false);
    look("px", 1, true);
    if (const auto at = column(name)) {
      if (reading_.unit_cm <= 0) {
        fail("column " + name + ": has no unit: " + name + "_cm, _mm, _m or _px, or give --unit");
      }
      found.push_back({*at, reading_.unit_cm, false});
    }
    if (found.size() > 1) {
      fail(fmt::format("columns {} and {}: both have {}: leave one", names_[found[0].column],
                       names_[found[1].column], name));
    }
    return found.empty() ? std::nullopt : std::optional(found[0]);
  }
  LengthColumn needed_length(const std::string& name) {
    const auto column = length(name);
    if (!column) lacks(name + "_cm (or _mm, _m, _px)");
    return *column;
  }

  /// A column whose unit is that of --unit, or px.
  LengthColumn without_unit(std::size_t column) const {
    if (reading_.unit_cm > 0) return {column, reading_.unit_cm, false};
    return {column, 1, true};
  }

  /// Where the time is: in s, or as a frame to be counted; rows are the frames where there is none.
  struct Clock {
    std::optional<std::size_t> column;
    bool frames = false;
  };
  Clock clock(bool rows_count = false) const {
    for (const char* name : {"time_s", "time (s)", "trial time (s)", "recording time (s)"}) {
      if (const auto at = column(name)) return {at, false};
    }
    for (const char* name : {"frame", "fnum"}) {
      if (const auto at = column(name)) return {at, true};
    }
    if (!rows_count) lacks("time_s");
    return {{}, true};
  }
  double time(std::size_t row, std::size_t first, const Clock& clock) const {
    const double at = clock.column ? needed(row, *clock.column, clock.frames ? "frame" : "time_s")
                                   : static_cast<double>(row - first);
    return clock.frames ? frame_time(file_, reading_, at) : at;
  }

  /// Sizes of px in the table's unit, once all columns are known.
  void settle_units(const std::vector<LengthColumn*>& columns, const LengthColumn* arc) {
    bool any = false, all = true;
    for (const LengthColumn* column : columns) (column->pixels ? any : all) = column->pixels;
    table_.pixels = any;
    const bool scale_matters = !all || (arc != nullptr && !arc->pixels);
    if (any && scale_matters && reading_.pixels_per_cm <= 0) {
      fail("has columns in px and columns in a unit of length: needs --scale, px/cm");
    }
    if (!any && (arc == nullptr || !arc->pixels)) {
      if (reading_.pixels_per_cm > 0) fail("--scale: has no column in px: leave it out");
      return;
    }
    const double px = any ? pixel_size(reading_, table_.unit) : 1;
    for (LengthColumn* column : columns) {
      if (column->pixels) column->size = px;
    }
  }

  /// The rows from `first` on, each of a time; points are numbered as they stand.
  void read_rows(std::size_t first, const Clock& clock, std::vector<PointColumns> points) {
    std::vector<LengthColumn*> columns;
    for (PointColumns& p : points) {
      columns.insert(columns.end(), {&p.x, &p.y});
      if (p.z) columns.push_back(&*p.z);
      table_.planar = table_.planar && !p.z;
    }
    settle_units(columns, nullptr);
    for (std::size_t row = first; row < text_.rows(); ++row) {
      const double at = time(row, first, clock);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const PointColumns& p = points[k];
        const auto coordinate = [&](const LengthColumn& from) {
          return from.size * number(row, from.column, p.name);
        };
        Eigen::Vector3d place(coordinate(p.x), coordinate(p.y), table_.planar ? 0 : missing);
        if (p.z) place.z() = coordinate(*p.z);
        if (unsure(row, p.likelihood) || !place.allFinite()) place.setConstant(missing);
        table_.points.push_back({at, static_cast<double>(k + 1), place});
      }
    }
  }

  /// A row for each time and point.
  void tall() {
    const Clock clock = this->clock();
    std::optional<LengthColumn> arc = length("s");
    const auto point = column("point");
    if (!arc && !point) lacks("s_cm or point");
    LengthColumn x = needed_length("x"), y = needed_length("y");
    std::optional<LengthColumn> z = length("z");
    std::vector<LengthColumn*> columns{&x, &y};
    if (z) columns.push_back(&*z);
    settle_units(columns, arc ? &*arc : nullptr);
    if (arc && arc->pixels) {
      if (!table_.pixels && reading_.pixels_per_cm <= 0) fail("s_px: pixels need --scale, px/cm");
      arc->size = pixel_size(reading_, table_.unit);
    }
    const auto likelihood = column("likelihood");
    auto who = column("individual");
    if (!who) who = column("track");
    if (who) choose(*who);
    table_.planar = !z;
    table_.by_arc = arc.has_value();
    table_.format = "a row for each time and point";
    for (std::size_t row = 1; row < text_.rows(); ++row) {
      if (who && text_.cell(row, *who) != individual_) continue;
      FilmPoint at;
      at.time = time(row, 1, clock);
      at.number = arc ? arc->size * needed(row, arc->column, "s") : needed(row, *point, "point");
      const bool unsure = this->unsure(row, likelihood);
      at.place = {x.size * number(row, x.column, "x"), y.size * number(row, y.column, "y"),
                  z ? z->size * number(row, z->column, "z") : 0};
      if (unsure || !at.place.allFinite()) at.place.setConstant(missing);
      table_.points.push_back(at);
    }
  }

  void choose(std::size_t column) {
    std::vector<std::string> names;
    for (std::size_t row = 1; row < text_.rows(); ++row) {
      const std::string name(text_.cell(row, column));
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
      if (names.size() > 100) break;
    }
    if (names.empty()) return;
    individual_ = names[chosen_individual(file_, names, reading_.individual)];
  }

  /// Rows of EthoVision's heading, the last two of which name columns and units.
  std::size_t header_rows() const {
    const std::optional<double> lines = text_.number(0, 1);
    const auto most = static_cast<double>(text_.line(text_.rows() - 1));
    if (!lines || !(*lines >= 2) || *lines > most) {
      fail(fmt::format("number of header lines = {}: must be 2 to {:g}",
                       shortened(std::string(text_.cell(0, 1))), most));
    }
    std::size_t row = 0;
    while (row < text_.rows() && static_cast<double>(text_.line(row)) <= *lines) ++row;
    if (row < 2) fail("its heading names no columns");
    return row;
  }

  /// A row for each time: columns "X NAME" and "Y NAME" of each point, head to tail. `units`: the
  /// heading's last row has them; else they stand in brackets.
  void wide(std::size_t header, bool units) {
    name_columns(header - (units ? 2 : 1));
    if (units) {
      for (std::size_t k = 0; k < names_.size(); ++k) {
        const std::string unit = lower(text_.cell(header - 1, k));
        if (!unit.empty()) names_[k] += " (" + unit + ")";
      }
    }
    std::vector<PointColumns> points;
    for (const std::string& full : names_) {
      if (!full.starts_with("x ")) continue;
      const std::string name = full.substr(2, full.find(" (") - 2);
      points.push_back(
          {name, needed_length("x " + name), needed_length("y " + name), length("z " + name), {}});
    }
    table_.format = units ? "EthoVision's export" : "a row for each time";
    read_rows(header, clock(), std::move(points));
  }

  /// A row for each frame: columns NAME_x, NAME_y, NAME_z of each point, head to tail, as DLTdv and
  /// Anipose write them.
  void triangulated() {
    std::vector<PointColumns> points;
    for (const std::string& full : names_) {
      if (!full.ends_with("_x")) continue;
      const std::string name = full.substr(0, full.size() - 2);
      if (name.find("_cam") != name.npos) {
        fail("column " + full +
             ": is of one of several cameras: give the file that has x, y and z, "
             "of DLTdv ...xyzpts.csv");
      }
      const auto x = column(full), y = column(name + "_y"), z = column(name + "_z");
      if (!y) lacks(name + "_y");
      points.push_back({name, without_unit(*x), without_unit(*y), {}, column(name + "_score")});
      if (!z) continue;
      ask_unit(file_, reading_);
      points.back().z = without_unit(*z);
    }
    table_.format = "a row for each frame, as DLTdv and Anipose write it";
    read_rows(1, clock(true), std::move(points));
  }

  /// Three or four rows of heading: scorer, perhaps individuals, bodyparts, coords.
  void deep_lab_cut() {
    std::size_t row = 1;
    const bool several = row < text_.rows() && lower(text_.cell(row, 0)) == "individuals";
    if (several) ++row;
    if (row + 1 >= text_.rows() || lower(text_.cell(row, 0)) != "bodyparts" ||
        lower(text_.cell(row + 1, 0)) != "coords") {
      fail("begins as DeepLabCut's CSV does, but has no rows bodyparts and coords");
    }
    if (several) {
      std::vector<std::string> names;
      for (std::size_t k = 1; k < text_.cells(1); ++k) {
        const std::string name(text_.cell(1, k));
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
      }
      if (names.empty()) fail("names no individuals");
      individual_ = names[chosen_individual(file_, names, reading_.individual)];
    }
    struct Part {
      std::string name;
      std::array<std::optional<std::size_t>, 4> column;  // x, y, z, likelihood
    };
    std::vector<Part> parts;
    constexpr std::array<const char*, 4> coords = {"x", "y", "z", "likelihood"};
    for (std::size_t k = 1; k < text_.cells(row); ++k) {
      if (several && text_.cell(1, k) != individual_) continue;
      const std::string name(text_.cell(row, k));
      auto part = std::ranges::find(parts, name, &Part::name);
      if (part == parts.end()) part = parts.insert(parts.end(), {name, {}});
      const auto coord = std::ranges::find(coords, lower(text_.cell(row + 1, k)));
      if (coord == coords.end()) {
        fail(fmt::format("bodypart {}: coords {}: must be x, y, z or likelihood", shortened(name),
                         shortened(std::string(text_.cell(row + 1, k)))));
      }
      auto& column = part->column[static_cast<std::size_t>(coord - coords.begin())];
      if (column) fail(fmt::format("bodypart {}: has {} twice", shortened(name), *coord));
      column = k;
    }
    table_.format = "DeepLabCut's CSV";
    std::vector<PointColumns> points;
    for (const Part& part : parts) {
      const auto& [x, y, z, likelihood] = part.column;
      if (!x || !y) fail(part.name + ": has no x and y");
      points.push_back({part.name, without_unit(*x), without_unit(*y), {}, likelihood});
      if (!z) continue;
      ask_unit(file_, reading_);
      points.back().z = without_unit(*z);
    }
    read_rows(row + 2, {0, true}, std::move(points));
  }

  DelimitedText text_;
  std::string file_;
  const FilmReading& reading_;
  std::vector<std::string> names_;
  std::string individual_;
  FilmTable table_;
};

}  // namespace

FilmTable read_film_table(const std::string& file, const FilmReading& reading) {
  if (const std::string why = unreadable(file); !why.empty()) throw FileError(file + ": " + why);
  std::error_code error;
  if (std::filesystem::file_size(file, error) > most_bytes || error) {
    throw FileError(file + ": larger than 1 GiB");
  }
  std::string text = text_of(file);
  if (text.starts_with(hdf5_signature)) return read_sleap(file, reading);
  return TableReader(DelimitedText(std::move(text)), file, reading).read();
}

std::size_t chosen_individual(const std::string& file, const std::vector<std::string>& names,
                              const std::string& asked) {
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  if (asked.empty()) {
    if (names.size() == 1) return 0;
    throw_input_error(fmt::format("{}: has several animals: choose one by --individual: {}", file,
                                  shortened(known)));
  }
  const auto at = std::ranges::find(names, asked);
  if (at == names.end()) {
    throw_input_error(fmt::format("{}: --individual {}: must be one of {}", file, shortened(asked),
                                  shortened(known)));
  }
  if (std::find(at + 1, names.end(), asked) != names.end()) {
    throw_input_error(fmt::format("{}: has two animals of the name {}", file, shortened(asked)));
  }
  return static_cast<std::size_t>(at - names.begin());
}

double frame_time(const std::string& file, const FilmReading& reading, double frame) {
  if (!(reading.fps > 0))
    throw_input_error(file + ": gives time as frames: needs --fps, frames a second");
  return frame / reading.fps;
}

void ask_unit(const std::string& file, const FilmReading& reading) {
  if (reading.unit_cm > 0) return;
  throw_input_error(file + ": has x, y and z but names no unit: needs --unit cm, mm or m" +
                    (reading.pixels_per_cm > 0 ? "; --scale is for pixels" : ""));
}

double pixel_size(const FilmReading& reading, std::string& unit) {
  if (reading.pixels_per_cm > 0) return 1 / reading.pixels_per_cm;
  unit = "px";
  return 1;
}

}  // namespace hagfish
