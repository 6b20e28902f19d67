#include "experiments/common/specimen_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hagfish {
namespace {

constexpr double to_degrees = 180 / std::numbers::pi;
// Nobody knows how far a fresh animal's knot slides; of the paper's animal other meshes alone make
// it less than half (experiments/results/sure/page.md).
constexpr double share_of_slide = 0.25;

/// A smaller animal is as much faster: its step is the scene's halved as often as it takes.
double step_of(const AnimalRatios& beside, const Scene& scene) {
  return scene.time.step * std::exp2(std::min(0.0, std::floor(std::log2(beside.length))));
}

std::string list(const std::vector<double>& values, double by = 1, const char* form = "{:.6g}") {
  std::vector<std::string> own;
  for (const double value : values) own.push_back(fmt::format(fmt::runtime(form), by * value));
  return fmt::format("[{}]", fmt::join(own, ", "));
}

/// In quotes, as TOML has it.
std::string quoted(const std::string& text) {
  std::string own = "\"";
  for (const char c : text) own += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return own + '"';
}

/// A profile of `paper` at the stations of `animal`: where the one was measured is not where the
/// other was.
std::vector<double> at_stations(const Specimen& animal, const Specimen& paper,
                                const std::vector<double>& values) {
  std::vector<double> own;
  for (const double station : animal.station)
    own.push_back(profile(paper.station, values, station));
  return own;
}

/// Cross-sections go by the square of the girth at each station.
std::vector<double> areas(const Specimen& animal, const Specimen& paper,
                          const std::vector<double>& area) {
  std::vector<double> own = at_stations(animal, paper, area);
  const std::vector<double> around = at_stations(animal, paper, paper.circumference);
  for (std::size_t k = 0; k < own.size(); ++k) {
    own[k] *= std::pow(animal.circumference[k] / around[k], 2);
  }
  return own;
}

}  // namespace

double volume_of(const Specimen& animal) {
  constexpr int parts = 1000;
  double volume = 0;
  for (int k = 0; k < parts; ++k) {
    const double around = profile(animal.station, animal.circumference, (k + 0.5) / parts);
    volume += around * around / (4 * std::numbers::pi) * animal.length / parts;
  }
  return volume;
}

double AnimalRatios::stiffness() const { return std::pow(girth, 4); }
double AnimalRatios::torque() const { return std::pow(girth, 3); }

AnimalRatios ratios(const Specimen& animal, const Specimen& paper) {
  const std::vector<double> limits = at_stations(animal, paper, paper.bending_limit);
  AnimalRatios found{animal.length / paper.length, mean_diameter(animal) / mean_diameter(paper),
                     animal.mass / paper.mass, animal.bending_limit.front() / limits.front()};
  for (std::size_t k = 0; k < limits.size(); ++k) {
    found.limits = std::min(found.limits, animal.bending_limit[k] / limits[k]);
  }
  return found;
}

std::string specimen_text(const Specimen& animal, const Specimen& paper) {
  const AnimalRatios beside = ratios(animal, paper);
  const auto passive = [&](const std::vector<double>& values) {
    return list(at_stations(animal, paper, values), beside.stiffness(), "{:.4g}");
  };
  const auto muscle = [&](const std::vector<double>& area) {
    return list(areas(animal, paper, area), 1, "{:.3g}");
  };
  return fmt::format(
      "# Written by `hagfish specimen`.\n"
      "name = {}\n\n"
      "length = {:.6g}  # cm, head to tail\n"
      "mass = {:.6g}  # g, whole body\n\n"
      "station = {}  # fraction of the length, from the head\n"
      "circumference = {}  # cm, at the stations\n"
      "bending_limit_deg = {}  # degrees, at the stations, to each side\n"
      "twist_limit_deg = {:.6g}  # degrees, whole body\n"
      "bending_span = {:.6g}  # cm of body that one bending limit belongs to\n\n"
      "# Guess: those of the {} by the fourth power of the mean diameter.\n"
      "[passive]\n"
      "bending_stiffness = {}  # EI, dyn cm^2\n"
      "bending_damping = {}  # dyn cm^2 s\n"
      "twist_stiffness = {}  # GJ, dyn cm^2\n"
      "twist_damping = {}  # dyn cm^2 s\n\n"
      "# Guess: those of the {}, areas by the square of the diameter at each station, depth by "
      "the\n"
      "# radius.\n"
      "[muscle]\n"
      "longitudinal_area = {}  # cm^2 on each of four sides\n"
      "oblique_area = {}  # cm^2 of each hand\n"
      "stress = {}  # dyn cm^-2, largest\n"
      "radius_share = {}  # of the radius of the skin\n"
      "oblique_angle_deg = {:.6g}  # to the body's axis\n",
      quoted(animal.name), animal.length, animal.mass, list(animal.station),
      list(animal.circumference), list(animal.bending_limit, to_degrees),
      to_degrees * animal.twist_limit, animal.bending_span, paper.name,
      passive(paper.bending_stiffness), passive(paper.bending_damping),
      passive(paper.twist_stiffness), passive(paper.twist_damping), paper.name,
      muscle(paper.muscle.longitudinal_area), muscle(paper.muscle.oblique_area),
      paper.muscle.stress, paper.muscle.radius_share, to_degrees * paper.muscle.oblique_angle);
}

void go_with_size(Scene& scene, const AnimalRatios& beside) {
  scene.active.stiffness *= beside.stiffness();
  scene.active.capacity *= beside.torque();
  scene.controller.cap *= std::max(1.0, beside.stiffness());
  for (double* drag : {&scene.drag.normal, &scene.drag.tangential}) *drag *= beside.drag();
  for (double* across :
       {&scene.constraints.tolerance, &scene.constraints.stride, &scene.contact.margin,
        &scene.controller.contact_gap, &scene.controller.contact_patch}) {
    *across *= beside.girth;
  }
  scene.time.step = step_of(beside, scene);
}

std::vector<std::pair<std::string, std::string>> sized_tables(const Specimen& animal,
                                                              const ResolvedScene& base) {
  Scene scene = base.scene;
  go_with_size(scene, ratios(animal, base.specimen));
  return {
      {"active", fmt::format("stiffness = {:.4g}  # dyn cm^2: by the fourth power of the mean "
                             "diameter\n"
                             "capacity = {:.4g}  # dyn cm: by its third power\n",
                             scene.active.stiffness, scene.active.capacity)},
      {"drag", fmt::format("normal = {:.4g}  # g/(s cm): by its first power\n"
                           "tangential = {:.4g}  # g/(s cm)\n",
                           scene.drag.normal, scene.drag.tangential)},
      {"constraints", fmt::format("tolerance = {:.4g}  # cm: lengths across the body by its mean "
                                  "diameter\n"
                                  "stride = {:.4g}  # cm\n",
                                  scene.constraints.tolerance, scene.constraints.stride)},
      {"contact", fmt::format("margin = {:.4g}  # cm\n", scene.contact.margin)},
      {"controller", fmt::format("cap = {:.4g}  # dyn\n"
                                 "contact_gap = {:.4g}  # cm\n"
                                 "contact_patch = {:.4g}  # cm\n",
                                 scene.controller.cap, scene.controller.contact_gap,
                                 scene.controller.contact_patch)},
      {"time", fmt::format("step = {:.6g}  # s\n", scene.time.step)},
  };
}

std::string specimen_scene_text(const Specimen& animal, const std::string& file,
                                const std::string& base_name, const ResolvedScene& base) {
  const Scene& scene = base.scene;
  const std::string knot = scene.title.substr(0, scene.title.find(','));
  std::string text = fmt::format(
      "# Written by `hagfish specimen`: {} with another animal. Lengths are shares of its body.\n"
      "base = \"{}\"\n"
      "title = {}\n"
      "specimen = {}\n\n",
      base_name, base_name, quoted(fmt::format("{}, tied by {}", knot, animal.name)), quoted(file));
  for (const auto& [name, lines] : sized_tables(animal, base)) {
    text += fmt::format("[{}]\n{}\n", name, lines);
  }
  return text +
         fmt::format(
             "[expect]\n"
             "slide_distance = \"{:.3g} L\"  # a quarter of what the paper's animal "
             "must slide\n"
             "slide_share = 0.0   # the paper's animal alone is known to slide by both ends,\n"
             "torque_share = 0.0  # and within its muscles' capacity\n"
             "speed_share = 0.9\n",
             share_of_slide * scene.expect.slide_distance / base.specimen.length);
}

}  // namespace hagfish
