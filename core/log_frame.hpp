// What one frame and one step of the log hold, before any file is there.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "core/hdf5_writer.hpp"
#include "core/simulation.hpp"

namespace hagfish {

/// The four rows of Eq. 6 in the log's order: first t_a, first t_b, last t_a, last t_b.
struct ThigmotaxisRows {
  std::array<double, 4> lambda{};  ///< over h, dyn; 0 where there is no row
  std::array<double, 4> speed{};   ///< left side of Eq. 6 at the solution, cm/s; nan where no row
  std::array<double, 4>
      slack{};  ///< shortfall of the row's right-hand side, cm/s; nan where no row
  bool any = false;
  bool met = false;  ///< all rows as fast as asked (controller.acceleration) without slack
};

ThigmotaxisRows thigmotaxis_rows_of(const StepSolution& solution, double h);

/// Worst figures of the steps since the last frame.
struct Worst {
  double penetration = 0;      ///< cm
  double limit_violation = 0;  ///< rad
  double head_drift = 0;       ///< cm
  double kkt = 0;
  void take(const StepRecord& record);
};

struct Frame {
  const StepRecord& record;
  ThigmotaxisRows thigmotaxis;
  KnotVote knot;
  Worst worst;
  double wall_time = 0;  ///< s
};

/// A group of datasets that grow together. Each is declared in one place: path, shape, unit,
/// meaning, and how a row of it follows from `Source`.
template <class Source>
class LogTable {
 public:
  explicit LogTable(Hdf5Writer& file) : file_(file) {}

  template <class Get>  // double(const Source&)
  void number(const std::string& path, const Meaning& meaning, Get get) {
    add(file_.doubles(path, {}, meaning),
        [get](Series<double>& series, const Source& source) { series.append(get(source)); });
  }
  template <class Get>  // anything with data() and size()
  void numbers(const std::string& path, std::vector<hsize_t> shape, const Meaning& meaning,
               Get get) {
    add(file_.doubles(path, std::move(shape), meaning),
        [get](Series<double>& series, const Source& source) {
          const auto& row = get(source);
          series.append(row.data(), row.size());
        });
  }
  template <class Get>  // std::array<int, 2>(const Source&)
  void pair(const std::string& path, const std::string& description, Get get) {
    add(file_.ints(path, {2}, {"1", description}),
        [get](Series<std::int32_t>& series, const Source& source) {
          series.append(get(source).data(), 2);
        });
  }
  template <class Get>  // int(const Source&)
  void count(const std::string& path, const std::string& description, Get get) {
    add(file_.ints(path, {}, {"1", description}),
        [get](Series<std::int32_t>& series, const Source& source) {
          series.append(static_cast<std::int32_t>(get(source)));
        });
  }
  template <class Get>  // std::int64_t(const Source&)
  void index(const std::string& path, const std::string& description, Get get) {
    add(file_.longs(path, {"1", description}),
        [get](Series<std::int64_t>& series, const Source& source) { series.append(get(source)); });
  }
  template <class Get>  // an enum class that counts up from 0 in the order of `names`
  void choice(const std::string& path, const std::vector<std::string>& names,
              const std::string& description, Get get) {
    add(file_.choices(path, names, {"1", description}),
        [get](Series<std::uint8_t>& series, const Source& source) {
          series.append(static_cast<std::uint8_t>(get(source)));
        });
  }

  void append(const Source& source) {
    for (Column& column : columns_) {
      column.append(source);
    }
  }
  void flush() {
    for (Column& column : columns_) {
      column.flush();
    }
  }

 private:
  struct Column {
    std::function<void(const Source&)> append;
    std::function<void()> flush;
  };
  template <class T, class Put>
  void add(Series<T> series, Put put) {
    const auto shared = std::make_shared<Series<T>>(std::move(series));
    columns_.push_back({[shared, put](const Source& source) { put(*shared, source); },
                        [shared] { shared->flush(); }});
  }

  Hdf5Writer& file_;
  std::vector<Column> columns_;
};

/// Declares every dataset along the frames (log schema, rows along T).
void declare_frames(const Model& model, Hdf5Writer& file, LogTable<Frame>& table);

/// Declares the datasets along the steps, /steps: few figures, but of every step.
void declare_steps(Hdf5Writer& file, LogTable<StepRecord>& table, double h);

}  // namespace hagfish
