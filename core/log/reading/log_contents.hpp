// A log read back: its scene, the model that the scene makes, and the frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/input/files/scene_reader.hpp"
#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/log/log_level.hpp"

namespace hagfish {

/// What every reader of a log starts from.
struct LogContents {
  /// Throws FileError where the file is not a log whose datasets fit the model that its own scene
  /// makes (log_schema.hpp), where /model has another value, of which the first is named, or where
  /// the log holds less than `least`.
  explicit LogContents(const std::string& file, LogLevel least = LogLevel::full);
  LogContents(const LogContents&) = delete;  // `model` refers to its own scene
  LogContents& operator=(const LogContents&) = delete;
  Hdf5Reader h5;
  ResolvedScene resolved;
  const Model& model = resolved.model;
  std::vector<double> time;         ///< s
  std::vector<std::int64_t> phase;  ///< values of Phase
  /// Frames x nq, nv, nv. Below LogLevel::frames there is no q, below full neither velocity.
  Hdf5Reader::Rows q, qdot, qdot_next;
  /// /midway, frames x nv each; empty of logs by Euler's rule, where they would be qdot and
  /// qdot_next.
  Hdf5Reader::Rows middle_step_velocity, middle_mean_velocity, qdot_step;
  /// Frames at which a step begins: all but the last one, where that is the state at the end. Below
  /// LogLevel::full it is not known, and all are counted.
  Eigen::Index begun = 0;
  bool has_end() const { return begun < std::ssize(time); }
  std::vector<std::int64_t> passes;      ///< StepSolution's passes of each step; or empty
  std::vector<std::int64_t> clamp_head;  ///< 1 or 0 by a law of the run's own; else empty
  bool own_law() const { return resolved.scene.controller.law == hagfish::own_law; }
  /// Whether the head is clamped in the step that begins at a frame.
  bool clamped(Eigen::Index frame) const;
  /// Whether the step that begins at a frame balances its bias (midpoint rule).
  bool balanced(Eigen::Index frame) const;
  bool midpoint() const { return resolved.scene.time.rule == TimeRule::midpoint; }

 private:
  void check_model() const;
};

}  // namespace hagfish
