// What one frame and one step of the log hold, before any file is there.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "core/log/log_level.hpp"
#include "core/log/log_means.hpp"
#include "core/log/series.hpp"
#include "core/log/thigmotaxis_rows.hpp"
#include "core/muscle/activation.hpp"
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

/// What the muscles have to do between two frames of the log, and what they did.
struct FrameMuscles {
  MuscleEffort effort;     ///< of the means since the frame before; nan at the first frame
  Eigen::VectorXd driven;  ///< of LawName::muscles: activations of the step; else empty
};

struct Frame {
  const StepRecord& record;
  const ThigmotaxisRows& thigmotaxis;
  const FrameMeans& mean;
  KnotVote knot;
  Worst worst;
  double wall_time = 0;  ///< s
  const FrameMuscles& muscles;
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

/// A row of Eq. 6 of the step at a frame.
struct FrameRow {
  std::int32_t frame = 0;  ///< index along the frames
  ThigmotaxisRow row;
};

// Labels of axes, in /model and along the rows.
inline constexpr const char* joint_labels = "/model/joint_name";
inline constexpr const char* dof_labels = "/model/dof_name";
inline constexpr const char* muscle_labels = "/model/muscle_name";
inline constexpr const char* coordinate_labels = "/model/coordinate_name";
inline constexpr const char* body_labels = "/model/arc";
inline constexpr const char* axis_labels = "/model/axis_name";
inline constexpr const char* plate_labels = "/model/plate_axis_name";
inline constexpr const char* contact_labels = "/model/contact_name";
inline constexpr const char* strand_labels = "/model/strand_name";
inline constexpr const char* frame_labels = "/trajectory/time";
inline constexpr const char* step_labels = "/steps/time";
inline constexpr const char* contact_frame_labels = "/contacts/frame";
inline constexpr const char* row_frame_labels = "/eq6/frame";

/// Datasets that grow together. Each is declared in one place: path, shape, unit, meaning, and how
/// a row of it follows from `Source`.
template <class Source>
class LogTable {
 public:
  struct Form {
    LogLevel level = LogLevel::full;
    std::string labels;      ///< path of the series among them that labels the rows; empty for none
    hsize_t chunk_rows = 1;  ///< that are stored together, at most
    bool packed = false;     ///< all of them, or only those whose meaning says so
  };
  /// Those that a log of the level holds.
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

  void append(const Source& source) {
    for (const auto& append_to : appenders_) {
      append_to(source);
    }
  }
  /// In the order of declaration.
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

/// Every dataset along the frames (log schema, rows along T). Of a law other than the paper's what
/// it asks for does not all follow from the scene: /control holds it where the law is the run's
/// own.
LogTable<Frame> frame_table(const Model& model, const Scene& scene, LogLevel level);

/// The datasets along the steps, /steps: few figures, but of every step.
LogTable<LoggedStep> step_table(const Scene& scene, LogLevel level);

/// /eq6, a row for each row of Eq. 6 at a frame, at whatever contact. Empty of the paper's law,
/// whose rows are those of /thigmotaxis.
LogTable<FrameRow> row_table(LogLevel level);
inline bool has_row_table(const Scene& scene) { return scene.controller.law != LawName::paper; }

/// /contacts, a row for each contact with a force at a frame.
LogTable<BearingContact> contact_table(LogLevel level);

}  // namespace hagfish
