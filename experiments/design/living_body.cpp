#include "experiments/design/living_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/input/csv/curvature_csv.hpp"
#include "core/input/scene_text.hpp"
#include "experiments/common/specimen_files.hpp"
#include "experiments/design/draw.hpp"
#include "experiments/design/program_fit.hpp"
#include "experiments/sweep/sweep_run.hpp"

namespace hagfish {
namespace {

constexpr double between_times = 0.35;  // s of the soft body
constexpr int station_count = 25;
constexpr double time_to_slide = 50;  // s, for 25 cm at the speed below
constexpr const char* row_cap =
    "cap = 5e3  # dyn, of a row of Eq. 6: muscles have the torque for it\n";

/// The scene of a found program.
std::string scene_text(const FoundScene& found) {
  std::string controller = row_cap, tables;
  std::string time = fmt::format("duration = {:.1f}  # s\n", found.tighten_from + time_to_slide);
  if (!found.specimen.empty()) {
    const ResolvedScene base = read_scene_text(
        std::string("base = \"living_overhand\"\n[controller]\n") + row_cap, "design");
    const Specimen animal = read_specimen_text(found.specimen, specimen_file);
    for (const auto& [name, lines] : sized_tables(animal, base)) {
      if (name == "controller") {
        controller = lines;
      } else if (name == "time") {
        time += lines;
      } else {
        tables += fmt::format("\n[{}]\n{}", name, lines);
      }
    }
  }
  return fmt::format(
      R"(# The animal ties a {0} itself, by a program that `hagfish design` found. Keys and units: the built-in scene table1.
base = "living_overhand"
title = "{0}, tied by the animal itself"
{1}
[script]
program = "{2}"

[controller]
tighten_from = {3:.2f}            # s: the program ends with the knot
slide_head = {{ a = 0.5, b = 0.5 }}  # cm/s
slide_tail = {{ a = 0.5, b = 0.5 }}
{5}{6}
[time]
{7}
[expect]
knot = "{4}"
hand = "any"
types = [  # type, from, to: s, or a phase and s after it
  ["{4}", "tighten", "release"],
  ["0_1", "free + 0.5", "end"],
]
slide_distance = "0.04 L"
speed_share = 0.0               # rows at the cap are slower than they are asked to be
energy_loss = 0.15              # by Euler's rule at its release
)",
      found.knot, found.specimen.empty() ? "" : fmt::format("specimen = \"{}\"\n", specimen_file),
      program_file, found.tighten_from, *name_in_scene(found.knot), controller, tables, time);
}

/// The animal of a draw: like `own`, with the density that it has.
Specimen drawn_animal(const Specimen& own, unsigned number) {
  Draw draw(0, number);
  const auto changed = [&](double value) {
    return value * draw.uniform(1 - animal_change, 1 + animal_change);
  };
  Specimen other = own;
  const double longer = draw.uniform(shortest_animal, longest_animal);
  other.length *= longer;
  other.bending_span *= longer;
  for (double& around : other.circumference) around = changed(longer * around);
  for (double& limit : other.bending_limit) limit = changed(limit);
  other.twist_limit = changed(other.twist_limit);
  other.mass *= volume_of(other) / volume_of(own);
  return other;
}

double thickness(const Specimen& animal) {
  return std::accumulate(animal.circumference.begin(), animal.circumference.end(), 0.0) /
         animal.length;
}

/// The run of a found scene with these settings. Nothing where `interrupted`.
std::optional<RunSummary> run_with(const FoundScene& found, const std::vector<std::string>& set,
                                   const std::function<bool()>& interrupted) {
  const std::optional<SweepRun> run =
      run_for_summary(resolved_scene(found, set), interrupted, std::nullopt);
  if (!run) return std::nullopt;
  return run->summary;
}

}  // namespace

std::string other_animal(const Specimen& own, unsigned number) {
  constexpr unsigned drawn_for_each = 4;
  std::vector<std::pair<double, unsigned>> draws;  // thickness, number of the draw
  for (unsigned k = 1; k <= drawn_for_each * judged_animals; ++k) {
    draws.emplace_back(thickness(drawn_animal(own, k)), k);
  }
  std::ranges::sort(draws, std::greater());
  const unsigned pair = (number - 1) / 2;
  const unsigned rank = number % 2 == 1 ? pair : judged_animals - 1 - pair;
  return specimen_text(drawn_animal(own, draws.at(drawn_for_each * rank + 1).second), own);
}

FoundScene found_scene(const Model& led, const Shapes& shapes, const std::string& knot,
                       const std::string& specimen, double slower) {
  std::vector<double> time = shapes.time;
  for (double& one : time) one *= slower;
  const double end = time.back();
  const int times = 1 + static_cast<int>(std::ceil(shapes.time.back() / between_times));
  const ProgramFit fit = fit_program(led, time, shapes.q, times, station_count);
  FoundScene found{"", curvature_csv(fit.program), specimen, knot, end};
  found.scene = scene_text(found);
  return found;
}

FoundScene in_other_animal(const FoundScene& found, const Specimen& own, unsigned number) {
  FoundScene other = found;
  other.specimen = other_animal(own, number);
  other.scene = scene_text(other);
  return other;
}

std::vector<std::string> trial_settings(const Trial& trial) {
  std::vector<std::string> set;
  if (trial.law == 1) {
    set = {"controller.law=reflex", "controller.reflex.shift=2.5e-4 L"};
  }
  if (trial.seed > 0) {
    set.push_back(fmt::format("start.noise_deg={:g}", start_noise_deg));
    set.push_back(fmt::format("start.seed={}", trial.seed));
  }
  if (trial.step > 0) set.push_back(fmt::format("time.step={:g}", trial.step));
  return set;
}

ResolvedScene resolved_scene(const FoundScene& found, const std::vector<std::string>& set) {
  return read_scene_text(found.scene, scene_file, set,
                         {{program_file, found.program}, {specimen_file, found.specimen}});
}

std::optional<RunSummary> run_trial(const FoundScene& found, const Trial& trial,
                                    const std::function<bool()>& interrupted) {
  return run_with(found, trial_settings(trial), interrupted);
}

bool repeats(const FoundScene& found, const std::function<bool()>& interrupted) {
  const std::optional<RunSummary> run = run_with(
      found, {"time.step=0.01", "time.until=form", "controller.tail_through=0"}, interrupted);
  return run && run->outcome == "ok";
}

bool succeeds(const RunSummary& run) { return run.outcome == "ok" && run.unmet.empty(); }

std::string shortcoming(const RunSummary& run) {
  if (succeeds(run)) return "";
  return run.outcome == "ok" ? run.unmet : run.message.empty() ? run.outcome : run.message;
}

}  // namespace hagfish
