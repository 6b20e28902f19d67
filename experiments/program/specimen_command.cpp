#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <tuple>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/program/number_options.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scene_argument.hpp"
#include "experiments/program/shell_word.hpp"
#include "experiments/program/text_file.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

/// The animal and the scene that others are made from.
constexpr const char* base_scene = "living_overhand";
constexpr int paper_bodies = 100;     // of the chain whose every other joint bends by the limits
constexpr double most_around = 1000;  // cm
constexpr double most_bending = 180;  // degrees, as specimen files have it
constexpr double degree = std::numbers::pi / 180;
// Beyond these the figures are pointed out.
constexpr double least_density = 0.9, largest_density = 1.2;        // g/cm^3; water has 1
constexpr double least_slenderness = 15, largest_slenderness = 45;  // length over mean diameter

struct SpecimenOptions {
  std::string out, scene_out, name = "my animal";
  double length = 0, mass = 0, twist = 0;                                   ///< cm, g, degrees
  std::vector<double> station{0.2, 0.4, 0.6, 0.8}, circumference, bending;  ///< cm, degrees
  bool force = false;
};

void check(const SpecimenOptions& options) {
  if (printable(options.name) != options.name) {
    throw InputError("--name " + printable(options.name) + ": must be letters");
  }
  const std::tuple<const char*, const std::vector<double>&, double> lists[] = {
      {"--circumference", options.circumference, most_around},
      {"--bending", options.bending, most_bending}};
  for (const auto& [name, list, most] : lists) {
    if (list.size() != options.station.size()) {
      throw InputError(
          fmt::format("{}: {} values for {} stations", name, list.size(), options.station.size()));
    }
    for (const double value : list) {
      if (!(value > 0 && value < most)) {
        throw InputError(fmt::format("{} {:g}: must be above 0 and below {:g}", name, value, most));
      }
    }
  }
  for (std::size_t k = 0; k < options.station.size(); ++k) {
    const double here = options.station[k];
    if (!(here >= 0 && here <= 1) || (k > 0 && !(here > options.station[k - 1]))) {
      throw InputError(fmt::format("--station {:g}: must rise from 0 to 1", here));
    }
  }
}

Specimen specimen_of(const SpecimenOptions& options) {
  Specimen animal;
  animal.name = options.name;
  animal.length = options.length;
  animal.mass = options.mass;
  animal.station = options.station;
  animal.circumference = options.circumference;
  for (const double limit : options.bending) animal.bending_limit.push_back(limit * degree);
  animal.bending_span = 2 * options.length / paper_bodies;
  animal.twist_limit = options.twist * degree;
  return animal;
}

/// Mass over the volume of round cross-sections.
double density_of(const Specimen& animal) {
  constexpr int parts = 1000;
  double volume = 0;
  for (int k = 0; k < parts; ++k) {
    const double around = profile(animal.station, animal.circumference, (k + 0.5) / parts);
    volume += around * around / (4 * std::numbers::pi) * animal.length / parts;
  }
  return animal.mass / volume;
}

/// What is said of the animal; what is odd about it says so.
void tell(const SpecimenOptions& options, const Specimen& animal, double largest_limit) {
  const double density = density_of(animal);
  const double slender = animal.length / mean_diameter(animal);
  const auto judged = [](double value, double least, double most, const char* odd) {
    return value < least || value > most ? odd : "plausible";
  };
  fmt::print("density        {:.3g} g/cm^3 of round cross-sections, water 1: {}\n", density,
             judged(density, least_density, largest_density,
                    "ODD for an animal: check mass (g) and circumference (cm)"));
  fmt::print("slenderness    {:.3g}, length over mean diameter: {}\n", slender,
             judged(slender, least_slenderness, largest_slenderness,
                    "ODD for a hagfish (24 in the paper's): check length and circumference"));
  fmt::print("bending_span   {:g} cm of body to a limit: two of the paper's {} bodies\n",
             animal.bending_span, paper_bodies);
  for (std::size_t k = 0; k < animal.station.size(); ++k) {
    if (animal.bending_limit[k] > largest_limit) {
      fmt::print(
          "bending limit  {:g} degrees at {:g} L: a joint bends by {:g} at most "
          "(model.largest_limit_deg)\n",
          options.bending[k], animal.station[k], largest_limit / degree);
    }
  }
}

std::string toml_of(const SpecimenOptions& options, const Specimen& animal, const Specimen& base,
                    double fourth) {
  const auto list = [](const std::vector<double>& values) {
    return fmt::format("[{}]", fmt::join(values, ", "));
  };
  const auto scaled = [&](const std::vector<double>& values) {
    // Where the base was measured is not where this one was.
    std::vector<double> own;
    for (const double station : animal.station) {
      own.push_back(std::round(fourth * profile(base.station, values, station)));
    }
    return list(own);
  };
  const auto muscle = [&](const std::vector<double>& area) {
    std::vector<std::string> own;
    for (std::size_t k = 0; k < animal.station.size(); ++k) {
      const double station = animal.station[k];
      const double thicker =
          animal.circumference[k] / profile(base.station, base.circumference, station);
      own.push_back(
          fmt::format("{:.3g}", thicker * thicker * profile(base.station, area, station)));
    }
    return fmt::format("[{}]", fmt::join(own, ", "));
  };
  std::string quoted;
  for (const char c : animal.name)
    quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return fmt::format(
      "# Written by `hagfish specimen`.\n"
      "name = \"{}\"\n\n"
      "length = {}  # cm, head to tail\n"
      "mass = {}  # g, whole body\n\n"
      "station = {}  # fraction of the length, from the head\n"
      "circumference = {}  # cm, at the stations\n"
      "bending_limit_deg = {}  # degrees, at the stations, to each side\n"
      "twist_limit_deg = {}  # degrees, whole body\n"
      "bending_span = {}  # cm of body that one bending limit belongs to: 2 x length / {}\n\n"
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
      quoted, animal.length, animal.mass, list(animal.station), list(animal.circumference),
      list(options.bending), options.twist, animal.bending_span, paper_bodies, base.name,
      scaled(base.bending_stiffness), scaled(base.bending_damping), scaled(base.twist_stiffness),
      scaled(base.twist_damping), base.name, muscle(base.muscle.longitudinal_area),
      muscle(base.muscle.oblique_area), base.muscle.stress, base.muscle.radius_share,
      base.muscle.oblique_angle / degree);
}

int specimen(const SpecimenOptions& options) {
  check(options);
  TextFile out(options.out, options.force);
  std::optional<TextFile> scene_out;
  if (!options.scene_out.empty()) scene_out.emplace(options.scene_out, options.force);
  const ResolvedScene base = scene_argument(base_scene, {});
  const Specimen animal = specimen_of(options);
  const double fourth = std::pow(mean_diameter(animal) / mean_diameter(base.specimen), 4);
  tell(options, animal, base.scene.model.largest_limit);
  out.write(toml_of(options, animal, base.specimen, fourth));
  fmt::print("{}\n", printable(options.out));
  if (scene_out) {
    const fs::path relative =
        fs::absolute(options.out).lexically_relative(fs::absolute(options.scene_out).parent_path());
    scene_out->write(fmt::format(
        "# Written by `hagfish specimen`: {} with another animal. Lengths and what a run must "
        "show\n"
        "# are shares of its body; muscles go by the fourth power of the mean diameter, as its\n"
        "# stiffness does.\n"
        "base = \"{}\"\n"
        "title = \"Overhand knot, tied by an animal of {:g} cm\"\n"
        "specimen = \"{}\"\n\n"
        "[active]\n"
        "stiffness = {:.4g}  # dyn cm^2\n"
        "capacity = {:.4g}  # dyn cm\n\n"
        "[controller]\n"
        "cap = {:.4g}  # dyn\n",
        base_scene, base_scene, animal.length, relative.string(),
        fourth * base.scene.active.stiffness, fourth * base.scene.active.capacity,
        std::max(1.0, fourth) * base.scene.controller.cap));
    fmt::print("hagfish run {}\n", shell_word(options.scene_out));
  }
  return exit_code::done;
}

}  // namespace

void add_specimen(Program& program) {
  const auto options = std::make_shared<SpecimenOptions>();
  CLI::App* app = program.app.add_subcommand(
      "specimen", "write a specimen file from what was measured of an animal, and a scene for it");
  const auto list = [app](const char* name, std::vector<double>& values, const char* help) {
    return app->add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
  };
  app->add_option("--length", options->length, "head to tail, cm")
      ->required()
      ->check(from_to(1.0, 1000.0));
  app->add_option("--mass", options->mass, "whole body, g")->required()->check(from_to(1e-3, 1e6));
  list("--circumference", options->circumference, "at the stations, cm, as in 4.6,4.4,3.2")
      ->required();
  list("--bending", options->bending,
       "bending limits at the stations, degrees, separated by commas")
      ->required();
  app->add_option("--twist", options->twist, "twisting limit of the whole body, degrees")
      ->required()
      ->check(from_to(1e-3, 3600.0));
  list("--station", options->station,
       "where they were measured, shares of the length, separated by commas")
      ->capture_default_str();
  app->add_option("--name", options->name, "what the animal is called")->capture_default_str();
  app->add_option("--out", options->out, "TOML file to write")->required();
  app->add_option("--scene-out", options->scene_out,
                  "scene file to write, in which it ties an overhand knot");
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = specimen(*options); });
}

}  // namespace hagfish
