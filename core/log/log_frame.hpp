// What one frame and one step of the log hold, before any file is there.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/log/hdf5_writer.hpp"
#include "core/log/log_means.hpp"
#include "core/log/thigmotaxis_rows.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

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
  const ThigmotaxisRows& thigmotaxis;
  const FrameMeans& mean;
  KnotVote knot;
  Worst worst;
  double wall_time = 0;  ///< s
};

/// What is logged of every step.
struct LoggedStep {
  const StepRecord& record;
  const ThigmotaxisRows& thigmotaxis;
};

/// A contact with a force, of the step at a frame.
struct BearingContact {
  std::int32_t frame = 0;  ///< index along the frames
  const Row& row;          ///< of kind contact or wall
  double force = 0;        ///< λ / h, dyn
};

/// What a column of a table is in the file.
struct DeclaredColumn {
  std::string path;
  std::vector<hsize_t> row;  ///< its shape
  H5T_class_t type;          ///< of its values
};

/// A group of datasets that grow together. Each is declared in one place: path, shape, unit,
/// meaning, and how a row of it follows from `Source`.
template <class Source>
class LogTable {
 public:
  explicit LogTable(Hdf5Writer& file) : file_(file) {}

  template <class Get>  // double(const Source&)
  void number(const std::string& path, const Meaning& meaning, Get get) {
    add(path, {}, file_.doubles(path, {}, meaning),
        [get](Series<double>& series, const Source& source) { series.append(get(source)); });
  }
  template <class Get>  // anything with data() and size()
  void numbers(const std::string& path, const std::vector<hsize_t>& shape, const Meaning& meaning,
               Get get) {
    add(path, shape, file_.doubles(path, shape, meaning),
        [get](Series<double>& series, const Source& source) {
          const auto& row = get(source);
          series.append(row.data(), row.size());
        });
  }
  template <class Get>  // std::array<int, 2>(const Source&)
  void pair(const std::string& path, const std::string& description, Get get) {
    add(path, {2}, file_.ints(path, {2}, {"1", description}),
        [get](Series<std::int32_t>& series, const Source& source) {
          series.append(get(source).data(), 2);
        });
  }
  template <class Get>  // int(const Source&)
  void count(const std::string& path, const std::string& description, Get get) {
    add(path, {}, file_.ints(path, {}, {"1", description}),
        [get](Series<std::int32_t>& series, const Source& source) {
          series.append(static_cast<std::int32_t>(get(source)));
        });
  }
  template <class Get>  // std::int64_t(const Source&)
  void index(const std::string& path, const std::string& description, Get get) {
    add(path, {}, file_.longs(path, {"1", description}),
        [get](Series<std::int64_t>& series, const Source& source) { series.append(get(source)); });
  }
  template <class Get>  // an enum class that counts up from 0 in the order of `names`
  void choice(const std::string& path, const std::vector<std::string>& names,
              const std::string& description, Get get) {
    add(path, {}, file_.choices(path, names, {"1", description}),
        [get](Series<std::uint8_t>& series, const Source& source) {
          series.append(static_cast<std::uint8_t>(get(source)));
        });
  }

  const std::vector<DeclaredColumn>& declared() const { return declared_; }

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
  void add(const std::string& path, const std::vector<hsize_t>& shape, Series<T> series, Put put) {
    // An enumeration is all that is kept in a byte.
    constexpr H5T_class_t type = std::is_floating_point_v<T>       ? H5T_FLOAT
                                 : std::is_same_v<T, std::uint8_t> ? H5T_ENUM
                                                                   : H5T_INTEGER;
    declared_.push_back({path, shape, type});
    const auto shared = std::make_shared<Series<T>>(std::move(series));
    columns_.push_back({[shared, put](const Source& source) { put(*shared, source); },
                        [shared] { shared->flush(); }});
  }

  Hdf5Writer& file_;
  std::vector<DeclaredColumn> declared_;
  std::vector<Column> columns_;
};

/// Declares every dataset along the frames (log schema, rows along T).
void declare_frames(const Model& model, Hdf5Writer& file, LogTable<Frame>& table);

/// Declares the datasets along the steps, /steps: few figures, but of every step.
void declare_steps(Hdf5Writer& file, LogTable<LoggedStep>& table);

/// Declares /contacts, a row for each contact with a force at a frame.
void declare_contacts(Hdf5Writer& file, LogTable<BearingContact>& table);

}  // namespace hagfish
