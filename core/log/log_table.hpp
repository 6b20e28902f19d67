// Tables of a log: datasets that grow by a row together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
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
    add_values<double>(path, meaning, get);
  }
  template <class Get>  // anything with data() and size()
  void numbers(const std::string& path, const std::vector<LabelledAxis>& axes,
               const Meaning& meaning, Get get) {
    add_rows<double>(path, axes, meaning, get);
  }
  template <class Get>  // std::array<int, 2>(const Source&)
  void pair(const std::string& path, const std::string& description, Get get) {
    add_rows<std::int32_t>(path, {{2, contact_labels}}, {"1", description}, get);
  }
  template <class Get>  // int(const Source&)
  void count(const std::string& path, const std::string& description, Get get) {
    add_values<std::int32_t>(path, {"1", description}, get);
  }
  template <class Get>  // std::int64_t(const Source&)
  void index(const std::string& path, const std::string& description, Get get) {
    add_values<std::int64_t>(path, {"1", description}, get);
  }
  template <class Get>  // an enum class that counts up from 0 in the order of `names`
  void choice(const std::string& path, const std::vector<std::string>& names,
              const std::string& description, Get get) {
    add(layout_of(path, {}, {"1", description}, choice_type(names)), {},
        value_of<std::uint8_t>(get));
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
  using Put = std::function<void(Series& series, const Source& source)>;

  /// Puts one T of each source.
  template <class T, class Get>
  static Put value_of(Get get) {
    return [get](Series& series, const Source& source) {
      const auto value = static_cast<T>(get(source));
      series.append(&value, sizeof value);
    };
  }
  template <class T, class Get>
  void add_values(const std::string& path, const Meaning& meaning, Get get) {
    add(layout_of(path, {}, meaning, stored_type<T>()), {}, value_of<T>(get));
  }
  template <class T, class Get>
  void add_rows(const std::string& path, const std::vector<LabelledAxis>& axes,
                const Meaning& meaning, Get get) {
    std::vector<hsize_t> shape;
    for (const LabelledAxis& axis : axes) shape.push_back(axis.size);
    add(layout_of(path, shape, meaning, stored_type<T>()), axes,
        [get](Series& series, const Source& source) {
          const auto& row = get(source);
          static_assert(std::is_same_v<std::decay_t<decltype(*row.data())>, T>);
          series.append(row.data(), static_cast<std::size_t>(row.size()) * sizeof(T));
        });
  }

  void add(SeriesLayout layout, const std::vector<LabelledAxis>& axes, Put put) {
    if (!holds(form_.level, layout.path)) return;
    layout.single = in_single_precision(form_.level, layout.path);
    layout.resolution = resolution(form_.level, layout.path);
    layout.labels = {form_.labels};
    for (const LabelledAxis& axis : axes) layout.labels.push_back(axis.labels);
    if (form_.packed || layout.meaning.storage == Storage::packed) {
      pack(layout);
      layout.chunk_rows = std::min(layout.chunk_rows, form_.chunk_rows);
    } else {
      layout.chunk_rows = form_.chunk_rows;
    }
    const auto series = std::make_shared<Series>(std::move(layout));
    series_.push_back(series);
    appenders_.push_back(
        [series, put = std::move(put)](const Source& source) { put(*series, source); });
  }

  Form form_;
  SeriesList series_;
  std::vector<std::function<void(const Source&)>> appenders_;
};

}  // namespace hagfish
