// What a log holds besides its run: how it came about, and its model.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/chain/model.hpp"
#include "core/log/hdf5/hdf5_writer.hpp"
#include "core/log/log_level.hpp"

namespace hagfish {

inline constexpr const char* log_format = "hagfish-log";
inline constexpr int log_format_version = 1;

/// A scene that a branch's run was in before the log's own.
struct SceneBefore {
  std::string scene;     ///< fully resolved TOML
  std::int64_t end = 0;  ///< step before which the next one began
};
/// Paths of these in a branch's log.
inline constexpr const char* past_scenes = "/branch/scene";
inline constexpr const char* past_ends = "/branch/end";

/// How a log came about.
struct LogHeader {
  std::string command;  ///< command line as typed
  std::string scene;    ///< fully resolved TOML
  std::string qp;       ///< QP back end
  std::string libraries;
  std::map<std::string, std::string> mjcf;  ///< the mirrored model's files by name
  LogLevel level = LogLevel::full;
  std::string simulator;      ///< program that took the steps, unless it is this one
  std::string branched_from;  ///< log, step and time of a branch's origin; empty otherwise
  std::vector<SceneBefore> past;
};

/// Root attributes, and /mjcf.
void write_header(const LogHeader& header, Hdf5Writer& h5);

/// Arc length of each body's middle from the head's end at rest, cm (N).
Eigen::VectorXd body_arcs(const Model& model);

/// Path of the obstacles' names, in logs of a model that has some, and the names.
inline constexpr const char* obstacle_names_path = "/model/obstacle_name";
std::vector<std::string> obstacle_names(const Model& model);

/// Names of what other axes than coordinates, velocities and bodies count: path and names.
const std::vector<std::pair<const char*, std::vector<std::string>>>& axis_names();

/// /enumerations, lists for readers to walk over, each with its path: the phases in the order of
/// time, the forces that do work, what energy is lost to, the knots that have names.
std::vector<std::pair<std::string, std::vector<std::string>>> enumerations();

/// These, /model, and labels of the axes of what stands along bodies and velocities.
void write_model(const Model& model, Hdf5Writer& h5);

}  // namespace hagfish
