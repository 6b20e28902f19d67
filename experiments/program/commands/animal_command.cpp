#include <fmt/format.h>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/film/animal_fit.hpp"
#include "experiments/film/film_checks.hpp"
#include "experiments/program/film_words.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

/// A model of this many bodies bends as one of a hundred does, to less than films tell.
constexpr const char* bodies = "model.bodies=50";

struct AnimalOptions {
  std::string film, scene = "living_overhand";
  std::vector<std::string> set;
  FilmReading reading;
  double until = 0;  ///< s; 0: to the film's end
  bool free_head = false;
};

/// A trait's line: its name, factor, interval, and what the scene's value becomes.
void tell(const char* name, const TraitEstimate& trait, double of_scene, const char* unit) {
  if (trait.told) {
    fmt::print("{}: {:.3g} times the scene's, {:.3g} to {:.3g} (90 %): {:.3g} {}\n", name,
               trait.factor, trait.low, trait.high, trait.factor * of_scene, unit);
  } else {
    fmt::print("{}: the film does not tell\n", name);
  }
}

int animal(const AnimalOptions& options) {
  std::vector<std::string> set{bodies};
  set.insert(set.end(), options.set.begin(), options.set.end());
  const ResolvedScene resolved = scene_argument(options.scene, set);
  const Scene& scene = resolved.scene;
  Film film = read_film(options.film, options.reading);
  end_at(film, options.until);
  const FilmRemarks remarks = tidy(film);
  const FilmHead head = options.free_head ? FilmHead::free : FilmHead::still;
  AnimalFit found;
  try {
    if (film.frames.size() < 3) throw InputError("has fewer than three usable midlines");
    refuse_jumps(film);
    found = fit_animal(resolved, film, head, [](int change) { say("change {}\n", change); });
  } catch (const InputError& error) {
    throw InputError(options.film + ": " + error.what());
  }
  const std::string size = scaled(film, found.scale);
  fmt::print("{}: read as {}, {} midlines{}\n{}{}", printable(options.film), film.format,
             film.frames.size(), size, ends_note(film, options.reading, size),
             another_animal_note(film, options.reading, options.scene, resolved.model, "figures"));
  for (const std::string& told : remarks.told) fmt::print("{}\n", told);
  for (const std::string& doubt : remarks.doubts) fmt::print("look at: {}\n", doubt);
  if (found.moved <= found.rms) {
    fmt::print(
        "the body moves by {:.2g} cm (rms), no more than the film is off: it tells nothing\n",
        found.moved);
  }
  const bool of_specimen = scene.model.passive == PassiveSource::specimen;
  const auto first = [&](const std::vector<double>& of_animal, double of_scene) {
    return of_specimen && !of_animal.empty() ? of_animal.front() : of_scene;
  };
  tell("stiffness EI", found.trait[AnimalFit::stiffness],
       first(resolved.specimen.bending_stiffness, scene.model.bending_stiffness), "dyn cm^2");
  tell("damping", found.trait[AnimalFit::damping],
       first(resolved.specimen.bending_damping, scene.model.bending_damping), "dyn cm^2 s");
  tell("drag", found.trait[AnimalFit::drag], scene.drag.normal, "g/(s cm) across the body");
  fmt::print(
      "the run is {:.2g} cm from the film (rms){}\n", found.rms,
      !found.settled ? ", and not yet as near as can be: do not use it"
      : found.moves_alike
          ? ""
          : fmt::format(", whose own shapes are within {:.2g} cm: muscles or another force "
                        "move the body, or a shorter film (--until) tells more: do not use it",
                        found.shapes));
  fmt::print(
      "true where nothing but the body, its mass and the water moves it: an animal that is dead, "
      "asleep or let go\n");
  return found.settled && found.moves_alike ? exit_code::done : not_fitted;
}

}  // namespace

void add_animal(Program& program) {
  const auto options = std::make_shared<AnimalOptions>();
  CLI::App* app = program.app.add_subcommand(
      "animal", "find stiffness, damping and drag of a body that a film shows without muscles");
  app->add_option("FILM", options->film, film_help)->required();
  app->add_option("--scene", options->scene,
                  "whose animal and water it is compared with: " + std::string(scene_help))
      ->capture_default_str();
  app->add_option("--set", options->set, set_help)->allow_extra_args(false);
  add_film_options(*app, options->reading);
  app->add_option("--until", options->until, "s; where not given, to the end of the film")
      ->check(above_zero());
  app->add_flag("--free-head", options->free_head, "nothing holds the head; else it is held still");
  app->callback([options, &program] { program.code = animal(*options); });
}

}  // namespace hagfish
