#include "experiments/design/design_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/knot/knot.hpp"
#include "experiments/common/csv.hpp"
#include "experiments/design/living_body.hpp"

namespace hagfish {

std::vector<double> strip_times(const RunSummary& run) {
  std::vector<double> times;
  for (const double time : {0.25 * run.slide_from, 0.5 * run.slide_from, 0.75 * run.slide_from,
                            run.slide_from, run.release_from, run.free_from}) {
    if (std::isfinite(time)) times.push_back(time);
  }
  return times;
}

std::string design_page(const DesignOptions& options, const DesignOutcome& outcome,
                        const ResolvedScene& scene, const RunSummary& run,
                        const std::string& strip) {
  const Candidate& best = *outcome.best;
  std::string by_reflex;
  for (const std::string& set : trial_settings({.law = 1})) {
    by_reflex += fmt::format(" --set \"{}\"", set);
  }
  std::string page = fmt::format(
      "# {0}, tied by {1}\n\n"
      "`hagfish design {5}` searched for this program from nothing. {2}.\n\n"
      "    hagfish run {3} --out again.h5   # the animal ties and slides the knot, and loses it\n"
      "    hagfish run {3} --out reflex.h5{4}   # the same by the reflex\n"
      "    hagfish check knot.h5            # audits the run that is here already\n"
      "    hagfish picture knot.h5 --out knot.png",
      knot_words(options.knot), scene.specimen.name, outcome.in_words(), scene_file, by_reflex,
      options.knot);
  for (const double time : strip_times(run)) page += fmt::format(" --time {:.2f}", time);
  page += "\n\n";
  if (!strip.empty()) {
    page +=
        fmt::format("![The way to the knot, and the knot tied, slid and untied]({})\n\n", strip);
  }
  page += fmt::format(
      "## How sure it is\n\n"
      "A start has normal noise of {:g} degrees on every hinge. A run succeeds if the animal ties "
      "and holds the knot, slides it by both ends and comes off it, within all bounds.\n\n"
      "| law that slides it | starts that succeed |\n|---|---|\n"
      "| Eq. 6 | {} of {} |\n| reflex | {} of {} |\n\n",
      start_noise_deg, best.passed[0], best.judged, best.passed[1], best.judged);
  if (options.animals) {
    page += fmt::format(
        "Other animals are {3:g} to {4:g} times as long. Their girth for the length and their "
        "limits are changed by up to {5:g} %.\n\n"
        "| law that slides it | other animals that tie it, hold it and slide it |\n|---|---|\n"
        "| Eq. 6 | {1} of {0} |\n| reflex | {2} of {0} |\n\n",
        judged_animals, best.animals[0], best.animals[1], shortest_animal, longest_animal,
        100 * animal_change);
  }
  if (outcome.found) {
    page += "The run from a straight start succeeds at steps of";
    for (const double step : finer_steps) {
      page += fmt::format("{}{:g}", step == finer_steps[0] ? " " : " and ", 1e3 * step);
    }
    page += " ms, too. Its log passes `hagfish check`.\n\n";
  }
  page += fmt::format(
      "## What it takes\n\n"
      "These figures are of the run from a straight start by Eq. 6.\n\n"
      "| figure | value |\n|---|---|\n"
      "| time of the program, over that of the soft body | {:g} |\n"
      "| tied, and slides from | {:.2f} s |\n"
      "| way of the knot's head end | {:.1f} cm |\n"
      "| released at | {:.2f} s |\n"
      "| untied at | {:.2f} s |\n"
      "| largest active torque | {:.2g} dyn cm, of {:.2g} that the muscles have |\n"
      "| largest torque of f_thigmo | {:.2g} dyn cm |\n"
      "| work of the active torques | {:.2g} erg |\n"
      "| deepest overlap | {:.2g} cm |\n"
      "| bounds not met | {} |\n\n",
      best.slower, run.slide_from, run.slide_distance, run.release_from, run.free_from,
      run.largest_active, scene.scene.active.capacity, run.largest_thigmotaxis, run.work_active,
      run.penetration, run.unmet.empty() ? "none" : run.unmet);
  page += fmt::format(
      "## What was tried\n\n"
      "{} paths of the tail in the soft body took {:.0f} s of CPU time and {:.0f} s by the clock, "
      "with all that follows.\n\n"
      "| type tied | paths |\n|---|---|\n",
      outcome.tries, outcome.time.cpu, outcome.time.wall);
  for (const auto& [type, count] : outcome.types)
    page += fmt::format("| {} | {} |\n", knot_words(type), count);
  std::map<std::string, int> reasons;
  for (const Candidate& candidate : outcome.candidates) {
    if (!candidate.shortcoming.empty()) ++reasons[candidate.shortcoming];
  }
  if (!reasons.empty()) {
    page += "\nPaths that tied the knot and were given up:\n\n| why | paths |\n|---|---|\n";
    for (const auto& [why, count] : reasons) page += fmt::format("| {} | {} |\n", why, count);
  }
  return page;
}

std::string design_row(const DesignOptions& options, const DesignOutcome& outcome,
                       const RunSummary& run) {
  const Candidate& best = *outcome.best;
  CsvTable table(2);
  const auto add = [&table](const std::string& name, const std::string& value) {
    table[0].push_back(name);
    table[1].push_back(value);
  };
  add("knot_wanted", options.knot);
  add("seed", std::to_string(options.seed));
  add("found", outcome.found ? "yes" : "no");
  add("tries", std::to_string(outcome.tries));
  add("tied_in_soft_body", std::to_string(outcome.candidates.size()));
  add("try", std::to_string(best.number));
  add("slower", fmt::format("{:g}", best.slower));
  add("starts", std::to_string(best.judged));
  for (const int law : {0, 1}) {
    add(fmt::format("starts_by_{}", judged_laws[law]), std::to_string(best.passed[law]));
  }
  for (const int law : {0, 1}) {
    add(fmt::format("animals_by_{}", judged_laws[law]),
        options.animals ? std::to_string(best.animals[law]) : "");
  }
  add("cpu_s", fmt::format("{:.1f}", outcome.time.cpu));
  add("wall_s", fmt::format("{:.1f}", outcome.time.wall));
  for (const auto& [name, value] : run.fields()) add(name, value);
  return csv_text(table);
}

}  // namespace hagfish
