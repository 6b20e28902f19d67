// Tables of a log: datasets that grow by a row together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/log/axis_labels.hpp"
#include "core/log/hdf5/series.hpp"
#include "core/log/log_level.hpp"

namespace hagfish {

/// Datasets that grow together. Each is declared in one place: path, shape, unit, meaning, and how
/// a row of it follows from `Source`.
template <class Source>
class LogTable {
 public:
  struct Form {
    LogLevel level = LogLevel::full;
    std::string labels;      ///< path of the series among them that labels the rows; empty for none
    hsize_t chunk_rows = 1;  ///< most rows that are stored together
    bool packed = false;     ///< whether all are; else those whose meaning says so
  };
  /// A table of the datasets that a log of the level holds.
  explicit LogTable(Form form) : form_(std::move(form)) {}

  template <class Get>  // double(const Source&)
  void number(const std::string& path, const Meaning& meaning, Get get) {
    add<double>(layout_of<double>(path, {}, meaning), {},
                [get](auto& series, const Source& source) { series.append(get(source)); });
  }
  template <class Get>  // anything with data() and size()
  void numbers(const std::string& path, const std::vector<LabelledAxis>& axes,
               const Meaning& meaning, Get get) {
    add<double>(layout_of<double>(path, sizes(axes), meaning), axes,
                [get](auto& series, const Source& source) {
                  const auto& row = get(source);
                  series.append(row.data(), row.size());
                });
  }
  template <class Get>  // std::array<int, 2>(const Source&)
  void pair(const std::string& path, const std::string& description, Get get) {
    add<std::int32_t>(
        layout_of<std::int32_t>(path, {2}, {"1", description}), {{2, contact_labels}},
        [get](auto& series, const Source& source) { series.append(get(source).data(), 2); });
  }
  template <class Get>  // int(const Source&)
  void count(const std::string& path, const std::string& description, Get get) {
    add<std::int32_t>(layout_of<std::int32_t>(path, {}, {"1", description}), {},
                      [get](auto& series, const Source& source) {
                        series.append(static_cast<std::int32_t>(get(source)));
                      });
  }
  template <class Get>  // std::int64_t(const Source&)
  void index(const std::string& path, const std::string& description, Get get) {
    add<std::int64_t>(layout_of<std::int64_t>(path, {}, {"1", description}), {},
                      [get](auto& series, const Source& source) { series.append(get(source)); });
  }
  template <class Get>  // an enum class that counts up from 0 in the order of `names`
  void choice(const std::string& path, const std::vector<std::string>& names,
              const std::string& description, Get get) {
    add<std::uint8_t>(layout_of_choices(path, names, {"1", description}), {},
                      [get](auto& series, const Source& source) {
                        series.append(static_cast<std::uint8_t>(get(source)));
                      });
  }

  /// A row; none where a column throws, which is passed on.
  void append(const Source& source) {
    if (series_.empty()) return;
    const hsize_t rows = series_.front()->rows();
    try {
      for (const auto& append_to : appenders_) append_to(source);
    } catch (...) {
      for (const auto& series : series_) series->cut(rows);
      throw;
    }
  }
  /// Series in the order of declaration.
  const SeriesList& series() const { return series_; }

 private:
  static std::vector<hsize_t> sizes(const std::vector<LabelledAxis>& axes) {
    std::vector<hsize_t> sizes;
    for (const LabelledAxis& axis : axes) sizes.push_back(axis.size);
    return sizes;
  }

  template <class T, class Put>
  void add(SeriesLayout layout, const std::vector<LabelledAxis>& axes, Put put) {
    if (!holds(form_.level, layout.path)) return;
    layout.single = in_single_precision(form_.level, layout.path);
    layout.resolution = resolution(form_.level, layout.path);
    layout.labels = {form_.labels};
    for (const LabelledAxis& axis : axes) layout.labels.push_back(axis.labels);
    if (form_.packed || layout.meaning.storage == Storage::packed) {
      pack<T>(layout);
      layout.chunk_rows = std::min(layout.chunk_rows, form_.chunk_rows);
    } else {
      layout.chunk_rows = form_.chunk_rows;
    }
    const auto series = std::make_shared<Series<T>>(std::move(layout));
    series_.push_back(series);
    appenders_.push_back([series, put](const Source& source) { put(*series, source); });
  }

  Form form_;
  SeriesList series_;
  std::vector<std::function<void(const Source&)>> appenders_;
};

}  // namespace hagfish
