// Whether what a scene asks for can be meant.
#pragma once

#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/input/files/scene_reader.hpp"

namespace hagfish {

/// Steps of a run that lasts its whole time.duration, and bytes of its log at most: nothing in it
/// compressed.
struct RunSize {
  double steps = 0, bytes = 0;
};
RunSize run_size(const Scene& scene, const Model& model);

/// What is odd about the animal but may be meant, a line each: its density, its length.
std::vector<std::string> odd_things(const ResolvedScene& scene);

/// Throws InputError where a run cannot be meant: a law of the program that made it, which this one
/// does not have, matter denser than any; or, without `force`, more than 1e8 steps or 10 GB of log.
void check_sense(const ResolvedScene& scene, bool force);

/// Says what is odd on standard error; once nothing else keeps the run from being taken.
void warn_of_odd_things(const ResolvedScene& scene);

}  // namespace hagfish
