#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/specimen_files.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/shell_word.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

/// A scene that others are made from, with the paper's animal.
struct BaseScene {
  std::string name;
  /// How much thicker than that one for its length an animal was that the scene's program still
  /// tied. Those of 4_1 and 5_2 did not tie at 1.2.
  double thickest;
};
/// By the knot that they tie.
const std::map<std::string, BaseScene> base_scenes{{"3_1", {"living_overhand", 1.4}},
                                                   {"4_1", {"living_figure_eight", 1.1}},
                                                   {"5_1", {"living_double_overhand", 1.1}},
                                                   {"5_2", {"living_three_twist", 1.1}}};
/// How thin, likewise: the program of each knot still tied at this, and none did at 0.7.
constexpr double thinnest = 0.8;
constexpr int paper_bodies = 100;     // of the chain whose every other joint bends by the limits
constexpr double most_around = 1000;  // cm
constexpr double most_bending = 180;  // degrees, as specimen files have it
constexpr double degree = std::numbers::pi / 180;
// Beyond these the figures are pointed out. Girths at a few stations give the volume roughly: by
// those of the paper, its animal has 13 % less mass than the water that it displaces.
constexpr double least_density = 0.85, largest_density = 1.15;      // g/cm^3; water has 1
constexpr double least_slenderness = 15, largest_slenderness = 45;  // length over mean diameter

/// Zero or empty: the paper's animal's, scaled.
struct SpecimenOptions {
  std::string out, scene_out, name = "my animal", knot = "3_1";
  double length = 0, mass = 0, twist = 0, thicker = 1;  ///< cm, g, degrees, 1
  std::vector<double> station{0.2, 0.4, 0.6, 0.8}, circumference, bending, height,
      width;  ///< cm, degrees
  bool force = false;
};

void check(const SpecimenOptions& options) {
  if (printable(options.name) != options.name) {
    throw InputError("--name " + printable(options.name) + ": must be printable characters");
  }
  const std::tuple<const char*, const std::vector<double>&, double> lists[] = {
      {"--circumference", options.circumference, most_around},
      {"--height", options.height, most_around},
      {"--width", options.width, most_around},
      {"--bending", options.bending, most_bending}};
  for (const auto& [name, list, most] : lists) {
    if (!list.empty() && list.size() != options.station.size()) {
      throw InputError(fmt::format("{}: has {} values, but there are {} stations", name,
                                   list.size(), options.station.size()));
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

/// Sections of the model are round: the girths of circles of the same areas, cm.
std::vector<double> round_girths(const SpecimenOptions& options) {
  std::vector<double> girths;
  for (std::size_t k = 0; k < options.height.size(); ++k) {
    girths.push_back(std::numbers::pi * std::sqrt(options.height[k] * options.width[k]));
  }
  return girths;
}

double slenderness(const Specimen& animal) { return animal.length / mean_diameter(animal); }

/// Given values, or those of the paper's animal at the stations, times `scale`.
std::vector<double> given_or(const std::vector<double>& given, const SpecimenOptions& options,
                             const Specimen& paper, const std::vector<double>& of_paper,
                             double scale) {
  if (!given.empty()) return given;
  std::vector<double> own;
  for (const double station : options.station) {
    own.push_back(scale * profile(paper.station, of_paper, station));
  }
  return own;
}

/// What was not measured is scaled from the paper's animal: girth with the length, mass by the same
/// density, and limits so that the skin is stretched as much, which a thicker body's is sooner.
Specimen specimen_of(const SpecimenOptions& options, const Specimen& paper) {
  Specimen animal;
  animal.name = options.name;
  animal.length = options.length > 0 ? options.length : paper.length;
  animal.station = options.station;
  animal.circumference = given_or(options.circumference, options, paper, paper.circumference,
                                  animal.length / paper.length);
  const double density = paper.mass / volume_of(paper);
  animal.mass = options.mass > 0 ? options.mass : density * volume_of(animal);
  const double stretch = slenderness(animal) / slenderness(paper);
  std::vector<double> given;
  for (const double limit : options.bending) given.push_back(limit * degree);
  animal.bending_limit = given_or(given, options, paper, paper.bending_limit, stretch);
  animal.bending_span = 2 * animal.length / paper_bodies;
  animal.twist_limit = options.twist > 0 ? options.twist * degree : stretch * paper.twist_limit;
  for (double& around : animal.circumference) around *= options.thicker;
  animal.mass *= options.thicker * options.thicker;
  for (double& limit : animal.bending_limit) limit /= options.thicker;
  animal.twist_limit /= options.thicker;
  return animal;
}

/// What is said of the animal; what is odd about it says so.
void tell(const Specimen& animal, const Specimen& paper, double largest_limit) {
  const double density = animal.mass / volume_of(animal);
  const auto judged = [](double value, double least, double most, const char* odd) {
    return value < least || value > most ? odd : "plausible";
  };
  const AnimalRatios beside = ratios(animal, paper);
  fmt::print(
      "beside paper's length x {:.3g}, girth x {:.3g}, mass x {:.3g}, limits x {:.3g} at least, "
      "stiffness x {:.3g}, muscles' torques x {:.3g}, drag x {:.3g}\n",
      beside.length, beside.girth, beside.mass, beside.limits, beside.stiffness(), beside.torque(),
      beside.drag());
  fmt::print("density        {:.3g} g/cm^3 of round cross-sections, water 1: {}\n", density,
             judged(density, least_density, largest_density,
                    "ODD for an animal: check mass (g) and circumference (cm)"));
  fmt::print("slenderness    {:.3g}, length over mean diameter: {}\n", slenderness(animal),
             judged(slenderness(animal), least_slenderness, largest_slenderness,
                    "ODD for a hagfish (24 in the paper's): check length and circumference"));
  fmt::print("bending_span   {:g} cm of body to a limit: two of the paper's {} bodies\n",
             animal.bending_span, paper_bodies);
  for (std::size_t k = 0; k < animal.station.size(); ++k) {
    if (animal.bending_limit[k] > largest_limit) {
      fmt::print(
          "bending limit  {:.4g} degrees at {:g} L: a joint bends by {:g} at most "
          "(model.largest_limit_deg)\n",
          animal.bending_limit[k] / degree, animal.station[k], largest_limit / degree);
    }
  }
}

/// Says so where nobody saw that an animal as thick or as thin as this ties the knot.
void tell_whether_it_ties(const SpecimenOptions& options, const AnimalRatios& beside) {
  constexpr double rounding = 1e-9;
  const BaseScene& base = base_scenes.at(options.knot);
  const double thickness = beside.thickness();
  if (thickness >= thinnest * (1 - rounding) && thickness <= base.thickest * (1 + rounding)) {
    return;
  }
  fmt::print(
      "knot           {} may not be tied: the animal is {:.3g} times as thick for its length as "
      "the paper's; {:g} to {:g} was tied. For a program of its own: hagfish design {} --specimen "
      "{} --out FOLDER\n",
      knot_words(options.knot), thickness, thinnest, base.thickest, options.knot,
      shell_word(options.out));
}

int specimen(SpecimenOptions options) {
  check(options);
  if (!options.height.empty()) {
    options.circumference = round_girths(options);
    fmt::print(
        "girth          {:.3g} cm: of circles of the sections' areas; the model is round and bends "
        "alike up and sideways, a flat animal does not\n",
        fmt::join(options.circumference, ", "));
  }
  TextFile out(options.out, options.force);
  std::optional<TextFile> scene_out;
  if (!options.scene_out.empty()) scene_out.emplace(options.scene_out, options.force);
  const std::string& base_name = base_scenes.at(options.knot).name;
  const ResolvedScene base = scene_argument(base_name, {});
  const Specimen animal = specimen_of(options, base.specimen);
  tell(animal, base.specimen, base.scene.model.largest_limit);
  out.write(specimen_text(animal, base.specimen));
  fmt::print("{}\n", printable(options.out));
  if (scene_out) {
    const fs::path relative =
        fs::absolute(options.out).lexically_relative(fs::absolute(options.scene_out).parent_path());
    scene_out->write(specimen_scene_text(animal, relative.string(), base_name, base));
    tell_whether_it_ties(options, ratios(animal, base.specimen));
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
  app->add_option("--length", options->length, "head to tail, cm (the paper's animal's)")
      ->check(from_to(1.0, 1000.0));
  app->add_option("--mass", options->mass, "whole body, g (the same density)")
      ->check(from_to(1e-3, 1e6));
  CLI::Option* circumference = list("--circumference", options->circumference,
                                    "at the stations, cm, as in 4.6,4.4,3.2 (the same shape)");
  CLI::Option* height = list("--height", options->height,
                             "of flat animals instead, with --width: of their sections, cm");
  CLI::Option* width = list("--width", options->width, "likewise");
  height->needs(width)->excludes(circumference);
  width->needs(height);
  list("--bending", options->bending,
       "bending limits at the stations, degrees, separated by commas (the skin stretched as much)");
  app->add_option("--twist", options->twist,
                  "twisting limit of the whole body, degrees (the skin stretched as much)")
      ->check(from_to(1e-3, 3600.0));
  list("--station", options->station,
       "where they were measured, shares of the length, separated by commas")
      ->capture_default_str();
  app->add_option("--thicker", options->thicker,
                  "then as much thicker: girth, and with it mass, limits, stiffness, muscles, drag")
      ->check(from_to(0.1, 10.0));
  app->add_option("--name", options->name, "what the animal is called")->capture_default_str();
  app->add_option("--out", options->out, "TOML file to write")->required();
  std::vector<std::string> knots;
  for (const auto& [knot, scene] : base_scenes) knots.push_back(knot);
  app->add_option("--knot", options->knot, "which it ties in the scene: 3_1, 4_1, 5_1 or 5_2")
      ->check(one_of(knots))
      ->capture_default_str();
  app->add_option("--scene-out", options->scene_out,
                  "scene file to write, in which it ties a knot");
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = specimen(*options); });
}

}  // namespace hagfish
