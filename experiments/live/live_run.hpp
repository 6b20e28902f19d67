// A scene that runs step by step, shown as arrays: what the page in a browser draws.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/input/scene_text.hpp"
#include "core/log/means/log_means.hpp"
#include "core/log/means/moment_means.hpp"
#include "core/run/simulation.hpp"
#include "core/run/slide.hpp"

namespace hagfish {

/// A spring between a body and a place: the hand that pulls.
struct Pull {
  int body = 0;
  Eigen::Vector3d to = Eigen::Vector3d::Zero();  ///< cm, world
  double stiffness = 0;                          ///< dyn / cm
  double most = 0;                               ///< dyn
};

/// Numbers of a frame, or of the animal, by name; row by row.
struct LiveArray {
  std::string_view name;
  std::vector<double> values;
};

class LiveRun {
 public:
  explicit LiveRun(ResolvedScene resolved);

  /// Goes on in another scene of as many bodies, as change_scene() has it. Throws what that throws.
  void change(ResolvedScene resolved);

  /// While it is set it takes the place of the script's force.
  void pull(const std::optional<Pull>& pull) { pull_ = pull; }

  /// Takes up to `count` steps, fewer where the scene is over. Returns how many. Throws StepError.
  int advance(int count);

  /// The state, and means of forces since the last call.
  std::span<const LiveArray> frame();

  /// What stays while the scene runs: length, radii, arcs, stations.
  std::vector<LiveArray> animal() const;

  bool over() const { return finished(sim_, resolved_.scene); }
  const ResolvedScene& resolved() const { return resolved_; }
  const Simulation& simulation() const { return sim_; }
  /// Warnings of the steps since the last call, a line each.
  std::string take_warnings();

 private:
  void hold_pull();
  void put(std::string_view name, std::vector<double> values);

  ResolvedScene resolved_;
  const Model& model_ = resolved_.model;
  Simulation sim_;
  Scene pulled_scene_;  ///< the scene by a law of its own, which pulls besides
  NamedLaw named_law_;
  RunningMeans means_;
  MomentMeans moments_;
  SlideWatch slides_;
  StepRecord record_;
  std::optional<Pull> pull_;
  std::string warnings_;
  std::vector<LiveArray> arrays_;
  std::size_t filled_ = 0;
};

}  // namespace hagfish
