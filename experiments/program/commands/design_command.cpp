
#include <algorithm>
#include <sstream>

#include "core/input/files/scene_reader.hpp"
#include "core/input/files/text_file.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "experiments/common/cores.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/design/design.hpp"
#include "experiments/design/soft_body.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

constexpr const char* known_names = "3_1 to 8_21, A#B or A#-B of two of these, or det=..,v2=..";

struct DesignArguments {
  std::string knot, specimen, out, start;
  std::string budget = "15m";
  int threads = usable_cores();
  int seed = 1;
  bool animals = false, resume = false, quiet = false;
};

/// "90s", "15m", "1h" or a number of seconds, in s.
double seconds_of(const std::string& text) {
  std::istringstream stream(text);
  double number = 0;
  std::string unit;
  stream >> number;
  const bool read = !stream.fail() && number > 0;
  stream.clear();
  stream >> unit;
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  if (!read || factor == 0) {
    throw InputError("--budget " + printable(text) + ": must be a time, as 90s, 15m or 1h");
  }
  return factor * number;
}

int make_design(const DesignArguments& arguments, const std::string& typed) {
  DesignOptions options;
  if (!name_in_scene(arguments.knot) || arguments.knot == "0_1") {
    throw InputError(printable(arguments.knot) + ": not a known knot: " + known_names);
  }
  options.knot = arguments.knot;
  if (!arguments.specimen.empty()) {
    read_specimen(arguments.specimen);  // says what is wrong with it
    options.specimen = read_text_file(arguments.specimen);
  }
  options.folder = arguments.out;
  options.resume = arguments.resume;
  options.start = arguments.start;
  options.budget = seconds_of(arguments.budget);
  options.threads = arguments.threads;
  options.seed = static_cast<unsigned>(arguments.seed);
  options.animals = arguments.animals;
  options.typed = typed;
  options.interrupted = interrupted;
  options.progress = [&](const std::string& line) {
    if (!arguments.quiet) say("{}\n", line);
  };
  note_signals();
  const DesignOutcome outcome = design(options);
  if (outcome.interrupted) {
    say("hagfish: {}: interrupted after {} tries; --resume continues\n", printable(arguments.out),
        outcome.tries);
    return exit_code::failed;
  }
  say("hagfish: {}: {}: {}; {:.0f} s of CPU time, {:.0f} s by the clock\n",
      printable(arguments.out), knot_words(arguments.knot), printable(outcome.in_words()),
      outcome.time.cpu, outcome.time.wall);
  return outcome.found ? exit_code::done : exit_code::wrong_knot;
}

}  // namespace

void add_design(Program& program) {
  const auto arguments = std::make_shared<DesignArguments>();
  CLI::App* app = program.app.add_subcommand(
      "design", "find a program by which an animal ties a knot itself, from the knot's name");
  app->add_option("KNOT", arguments->knot, known_names)->required();
  app->add_option("--out", arguments->out, "folder for what is found, and for the search")
      ->required();
  app->add_option("--specimen", arguments->specimen, "the animal's file (Table 1's animal)");
  app->add_option("--budget", arguments->budget, "wall time for the search: 90s, 15m, 1h")
      ->capture_default_str();
  app->add_option("--threads", arguments->threads, "tries side by side (one a core)")
      ->check(from_to(1, 1024));
  app->add_option("--seed", arguments->seed, "of the search")
      ->check(from_to(0, 1e9))
      ->capture_default_str();
  app->add_flag("--animals", arguments->animals, "what is found must serve other animals, too");
  CLI::Option* start = app->add_option("--start", arguments->start,
                                       "folder of another search, whose paths are continued");
  app->add_flag("--resume", arguments->resume, "continue a search that was stopped")
      ->excludes(start);
  app->add_flag("--quiet", arguments->quiet, "no progress");
  app->callback([arguments, &program] { program.code = make_design(*arguments, program.typed); });
}

}  // namespace hagfish
