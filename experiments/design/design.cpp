#include "experiments/design/design.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include "core/input/input_error.hpp"
#include "core/log/build_info.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/audit/audit.hpp"
#include "experiments/common/cores.hpp"
#include "experiments/common/cpu_time.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/design/design_page.hpp"
#include "experiments/design/length_bound.hpp"
#include "experiments/design/living_body.hpp"
#include "experiments/design/tries.hpp"
#include "experiments/sweep/appended_file.hpp"
#include "experiments/sweep/sweep_run.hpp"
#ifdef HAGFISH_MUJOCO
#include "core/log/reading/log_contents.hpp"
#include "experiments/mujoco/strip.hpp"
#endif

namespace hagfish {
namespace {

namespace fs = std::filesystem;

constexpr int few_starts = 4;   // of each law, before the animals and the other starts
constexpr int few_animals = 4;  // that must repeat what is to be gone on from

constexpr const char *tries_name = "tries.csv", *candidates_name = "candidates.csv",
                     *times_name = "times.csv", *start_name = "start.csv", *log_name = "knot.h5",
                     *strip_name = "strip.png";

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw FileError(file.string() + ": cannot be written");
}

/// What makes a search what it is.
std::string identity(const DesignOptions& options) {
  return fmt::format(
      "knot = \"{}\"\nseed = {}\nanimals = {}\nrevision = \"{}\"\nspecimen = '''\n{}'''\n",
      options.knot, options.seed, options.animals, build_revision(), options.specimen);
}

void claim(const DesignOptions& options) {
  const fs::path file = options.folder / "search.toml";
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (!fs::exists(file)) {
    if (options.resume) throw FileError(file.string() + ": no search to continue");
    if (!options.start.empty()) {
      const fs::path tries = options.start / tries_name;
      if (!fs::exists(tries)) throw FileError(tries.string() + ": no tries to start from");
      write_text(options.folder / start_name, text_of(tries));
    }
    return write_text(file, identity(options));
  }
  if (!options.resume) {
    throw FileError(options.folder.string() + ": has a search already; --resume continues it");
  }
  if (text_of(file) != identity(options)) {
    throw FileError(file.string() +
                    ": holds a search with another knot, animal, seed or program version; choose "
                    "another folder");
  }
}

/// Lines "NUMBER,TEXT" of a file, the last of a number; incomplete ones of a kill are left out.
std::map<int, std::string> numbered_lines(const fs::path& file) {
  std::map<int, std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos || line.find_first_not_of("0123456789") != comma) continue;
    lines[std::stoi(line.substr(0, comma))] = line.substr(comma + 1);
  }
  return lines;
}

/// Ends a line that a kill left unfinished, so that what is added stands by itself.
void end_last_line(const fs::path& name, AppendedFile& file) {
  const std::string text = text_of(name);
  if (!text.empty() && text.back() != '\n') file.add("\n");
}

/// The last line "WALL,CPU" of a file that holds the time spent at each report, s; zero without
/// one.
DesignTime time_before(const fs::path& file) {
  DesignTime time;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    std::istringstream fields(line);
    DesignTime of_line;
    char comma = 0;
    if (fields >> of_line.wall >> comma >> of_line.cpu) time = of_line;
  }
  return time;
}

std::string candidate_text(const Candidate& candidate) {
  return fmt::format("{},{:g},{},{},{},{},{},{}\n", candidate.number, candidate.slower,
                     candidate.judged, candidate.passed[0], candidate.passed[1],
                     candidate.animals[0], candidate.animals[1], candidate.shortcoming);
}

std::optional<Candidate> candidate_of(int number, const std::string& text) {
  std::istringstream stream(text);
  Candidate candidate;
  candidate.number = number;
  char comma = 0;
  stream >> candidate.slower >> comma >> candidate.judged >> comma;
  for (int* count :
       {&candidate.passed[0], &candidate.passed[1], &candidate.animals[0], &candidate.animals[1]}) {
    stream >> *count >> comma;
  }
  if (!stream) return std::nullopt;
  std::getline(stream, candidate.shortcoming);
  return candidate;
}

class Search {
 public:
  Search(const DesignOptions& options, SoftBody own)
      : options_(options),
        wanted_(*knot_called(*name_in_scene(options.knot))),
        known_tries_(numbered_lines(options.folder / tries_name)),
        known_candidates_(numbered_lines(options.folder / candidates_name)),
        before_(time_before(options.folder / times_name)),
        tries_file_(options.folder / tries_name),
        candidates_file_(options.folder / candidates_name),
        times_file_(options.folder / times_name) {
    lead_too(std::move(own));
    if (options.animals) {
      lead_too(soft_body(other_animal(own_animal(), thickest_animal)));
      outcome_.judged_runs += 2 * judged_animals;
    }
    end_last_line(options.folder / tries_name, tries_file_);
    end_last_line(options.folder / candidates_name, candidates_file_);
    end_last_line(options.folder / times_name, times_file_);
    for (const auto& [number, text] : numbered_lines(options.folder / start_name)) {
      const std::optional<Tying> tying = tying_of(text);
      if (!tying) continue;
      led_by(first_).archive.add(first_, {}, *tying);
      ++first_;
    }
  }

  DesignOutcome run() {
    const auto begin = std::chrono::steady_clock::now();
    const double cpu_begin = cpu_time();
    const auto elapsed = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const auto over = [&] { return options_.interrupted() || elapsed() > options_.budget; };
    do {
      judge(try_batch(), over);
      const double cpu = cpu_time() - cpu_begin;
      outcome_.time = {before_.wall + elapsed(), before_.cpu + cpu};
      report();
    } while (!outcome_.found && !over());
    outcome_.interrupted = options_.interrupted();
    note_types();
    if (outcome_.best && !outcome_.interrupted) write_best();
    return outcome_;
  }

 private:
  /// A soft body, and what was tried with it.
  struct LedBody {
    SoftBody body;
    Archive archive;
  };

  void lead_too(SoftBody body) {
    led_.push_back({std::move(body), Archive(options_.seed, options_.knot)});
  }

  const Specimen& own_animal() const { return led_.front().body.specimen; }

  /// By turns the animal's own body and, where a program must serve others, the thickest of these.
  LedBody& led_by(int number) { return led_[number % led_.size()]; }
  const LedBody& led_by(int number) const { return led_[number % led_.size()]; }

  /// Tries a batch; gives the tries that tied the knot.
  std::vector<int> try_batch() {
    const int first = first_ + outcome_.tries;
    std::vector<PathPlan> plans(batch_size);
    std::vector<std::optional<Tying>> tyings(batch_size);
    for (int k = 0; k < batch_size; ++k) {
      plans[k] = led_by(first + k).archive.plan_of(first + k);
    }
    in_parallel(batch_size, options_.threads, [&](int k) {
      const int number = first + k;
      if (const auto known = known_tries_.find(number); known != known_tries_.end()) {
        tyings[k] = tying_of(known->second);
      }
      if (tyings[k]) return;
      Draw draw(options_.seed + 1, static_cast<unsigned>(number));
      const LedBody& led = led_by(number);
      tyings[k] = try_plan(led.body, plans[k], options_.knot, draw, options_.interrupted);
      if (tyings[k] && !try_living(led, *tyings[k])) tyings[k].reset();
      if (tyings[k]) tries_file_.add(fmt::format("{},{}\n", number, tying_text(*tyings[k])));
    });
    if (options_.interrupted()) return {};
    std::vector<int> tied;
    for (int k = 0; k < batch_size; ++k) {
      led_by(first + k).archive.add(first + k, plans[k], *tyings[k]);
      if (tyings[k]->tied() == wanted_) {
        tied.push_back(first + k);
        tied_paths_[first + k] = tyings[k]->path;
      }
    }
    outcome_.tries += batch_size;
    return tied;
  }

  FoundScene in_other(const FoundScene& scene, int number) const {
    return in_other_animal(scene, own_animal(), static_cast<unsigned>(number));
  }

  /// Finds out where the living body repeats what a try tied, in a few other animals,
  /// too, where the program must serve these; false where it is interrupted.
  bool try_living(const LedBody& led, Tying& tying) const {
    for (TypeSeen& seen : tying.seen) {
      if (!led.archive.would_keep(tying.path, seen)) continue;
      const Shapes shapes = led_shapes(led.body, path_reached(tying.path, seen.at), seen.at);
      if (!shapes.failure.empty()) continue;
      const FoundScene scene = found_scene(led.body.model, shapes, knot_name(seen.type),
                                           options_.specimen, std::ranges::max(paces));
      seen.repeats = repeats(scene, options_.interrupted);
      const int animals = options_.animals ? few_animals : 0;
      for (int k = 1; k <= animals && seen.repeats; ++k) {
        seen.repeats = repeats(in_other(scene, k), options_.interrupted);
      }
      if (options_.interrupted()) return false;
    }
    return true;
  }

  /// Of the path of a try that tied the knot.
  Shapes shapes_of(int number) const {
    return tied_shapes(led_by(number).body, tied_paths_.at(number), options_.knot);
  }

  FoundScene found_from(int number, const Shapes& shapes, double slower) const {
    return found_scene(led_by(number).body.model, shapes, options_.knot, options_.specimen, slower);
  }

  std::optional<Candidate> known_candidate(int number) const {
    const auto known = known_candidates_.find(number);
    if (known == known_candidates_.end()) return std::nullopt;
    return candidate_of(number, known->second);
  }

  /// Tries paths that tied the knot in the living body, until one is good enough: all of them from
  /// a straight start, of which few succeed, then these from starts with noise.
  void judge(const std::vector<int>& tied, const std::function<bool()>& over) {
    std::vector<Candidate> candidates(tied.size());
    std::vector<FoundScene> scenes(tied.size());
    in_parallel(static_cast<int>(tied.size()), options_.threads, [&](int k) {
      if (const std::optional<Candidate> known = known_candidate(tied[k])) {
        candidates[k] = *known;
      } else {
        candidates[k] = from_straight(tied[k], scenes[k]);
      }
    });
    for (std::size_t k = 0; k < tied.size() && !outcome_.found && !over(); ++k) {
      Candidate& candidate = candidates[k];
      if (!known_candidate(tied[k])) {
        if (candidate.shortcoming.empty()) judge_variety(scenes[k], candidate);
        if (candidate.shortcoming.empty()) judge_steps(scenes[k], candidate);
        if (options_.interrupted()) return;
        candidates_file_.add(candidate_text(candidate));
      }
      outcome_.candidates.push_back(candidate);
      led_by(candidate.number).archive.judged(candidate.number, candidate.passes());
      outcome_.found = candidate.shortcoming.empty();
      if (!outcome_.best || candidate.passes() > outcome_.best->passes() || outcome_.found) {
        outcome_.best = candidate;
      }
    }
  }

  /// The scene of a try at the first pace at which it succeeds without noise by one law and the
  /// other, or why it succeeds at none.
  Candidate from_straight(int number, FoundScene& scene) const {
    Candidate candidate;
    candidate.number = number;
    const Shapes shapes = shapes_of(number);
    if (!shapes.failure.empty()) {
      candidate.shortcoming = "soft body: " + shapes.failure;
      return candidate;
    }
    for (const double slower : paces) {
      scene = found_from(number, shapes, slower);
      candidate.slower = slower;
      candidate.shortcoming = why_not_from_straight(scene);
      if (candidate.shortcoming.empty()) break;
    }
    return candidate;
  }

  std::string why_not_from_straight(const FoundScene& scene) const {
    for (int law = 0; law < 2; ++law) {
      const std::optional<RunSummary> run = run_trial(scene, {.law = law}, options_.interrupted);
      if (run && !succeeds(*run)) return why_not(law, "start", 0, *run);
    }
    return "";
  }

  static std::string why_not(int law, const char* what, int number, const RunSummary& run) {
    return fmt::format("{}, {} {}: {}", judged_laws[law], what, number, shortcoming(run));
  }

  /// Runs that a candidate is judged by, numbered from 1, for each law.
  struct Series {
    const char* what;
    int allowed;       ///< failures
    int (&passed)[2];  ///< of the candidate
    std::function<std::optional<RunSummary>(int number, int law)> run;
  };

  /// Runs numbers `first` to `last`; false where too many have failed by now, or it is interrupted.
  bool serves(const Series& series, int first, int last, Candidate& candidate) const {
    const int count = 2 * (last - first + 1);
    std::vector<std::optional<RunSummary>> runs(count);
    in_parallel(count, options_.threads,
                [&](int k) { runs[k] = series.run(first + k / 2, k % 2); });
    if (options_.interrupted()) return false;
    for (int k = 0; k < count; ++k) {
      const int number = first + k / 2;
      if (succeeds(*runs[k])) {
        ++series.passed[k % 2];
      } else if (number - series.passed[k % 2] > series.allowed) {
        candidate.shortcoming = why_not(k % 2, series.what, number, *runs[k]);
      }
    }
    return candidate.shortcoming.empty();
  }

  /// A few starts first, then all animals: how many a program serves tells which paths to go on
  /// from. The other starts seldom fail where these did not.
  void judge_variety(const FoundScene& scene, Candidate& candidate) const {
    const Series starts{"start", allowed_failures, candidate.passed, [&](int seed, int law) {
                          return run_trial(scene, {.law = law, .seed = seed}, options_.interrupted);
                        }};
    const Series animals{
        "other animal", allowed_animals, candidate.animals, [&](int number, int law) {
          return run_trial(in_other(scene, number), {.law = law}, options_.interrupted);
        }};
    candidate.judged = few_starts;
    if (!serves(starts, 1, few_starts, candidate)) return;
    if (options_.animals && !serves(animals, 1, judged_animals, candidate)) return;
    candidate.judged = judged_starts;
    serves(starts, few_starts + 1, judged_starts, candidate);
  }

  /// Its run must not depend on the time step, and its log must pass the audit.
  void judge_steps(const FoundScene& scene, Candidate& candidate) const {
    constexpr int count = static_cast<int>(std::size(finer_steps));
    std::vector<std::optional<RunSummary>> runs(count);
    in_parallel(count, options_.threads, [&](int k) {
      runs[k] = run_trial(scene, {.step = finer_steps[k]}, options_.interrupted);
    });
    for (int k = 0; k < count; ++k) {
      if (runs[k] && !succeeds(*runs[k])) {
        candidate.shortcoming =
            fmt::format("steps of {:g} s: {}", finer_steps[k], shortcoming(*runs[k]));
        return;
      }
    }
    if (!write_run(scene)) return;
    for (const Finding& finding : audit((options_.folder / log_name).string())) {
      if (!finding.passed) candidate.shortcoming = "audit: " + finding.name;
    }
  }

  void note_types() {
    outcome_.types.clear();
    std::map<std::pair<int, int>, int> counts;
    for (const LedBody& led : led_) {
      for (const auto& [type, count] : led.archive.counts()) counts[type] += count;
    }
    for (const auto& [type, count] : counts) {
      outcome_.types.emplace_back(knot_name({type.first, type.second}), count);
    }
  }

  void report() {
    times_file_.add(fmt::format("{:.1f},{:.1f}\n", outcome_.time.wall, outcome_.time.cpu));
    note_types();
    std::string types;
    for (const auto& [name, count] : outcome_.types) types += fmt::format(" {} {}", name, count);
    std::string best = outcome_.candidates.empty()
                           ? std::string("none tied yet")
                           : fmt::format("{} tied, best {} of {}", outcome_.candidates.size(),
                                         outcome_.best->passes(), outcome_.judged_runs);
    options_.progress(
        fmt::format("{:.0f} s, {} tries:{}; {}", outcome_.time.wall, outcome_.tries, types, best));
  }

  /// The scene, what it names, and the log of its run. Nothing where it is interrupted.
  std::optional<SweepRun> write_run(const FoundScene& found) const {
    write_text(options_.folder / scene_file, found.scene);
    write_text(options_.folder / program_file, found.program);
    if (!found.specimen.empty()) write_text(options_.folder / specimen_file, found.specimen);
    std::mutex alone;
    return run_for_summary(resolved_scene(found, {}), options_.interrupted,
                           SweepLog{options_.folder / log_name, options_.typed, alone});
  }

  void write_best() {
    const Shapes shapes = shapes_of(outcome_.best->number);
    if (!shapes.failure.empty()) return;
    const FoundScene found = found_from(outcome_.best->number, shapes, outcome_.best->slower);
    const std::optional<SweepRun> run = write_run(found);
    if (!run) return;
    write_text(options_.folder / "result.csv", design_row(options_, outcome_, run->summary));
    write_text(options_.folder / "README.md",
               design_page(options_, outcome_, resolved_scene(found, {}), run->summary,
                           draw_strip(run->summary)));
  }

  /// The file of the film strip; none where nothing is knotted, or there is no renderer.
  std::string draw_strip([[maybe_unused]] const RunSummary& run) const {
#ifdef HAGFISH_MUJOCO
    try {
      const LogContents log((options_.folder / log_name).string(), LogLevel::frames);
      write_png(strip_of(log, strip_times(run), {420, 330}), options_.folder / strip_name);
      return strip_name;
    } catch (const InputError& error) {
      options_.progress(fmt::format("no film strip: {}", error.what()));
    }
#endif
    return "";
  }

  const DesignOptions& options_;
  KnotInvariants wanted_;
  std::vector<LedBody> led_;  // the animal's own body first
  int first_ = 0;             // number of its own first try: those of the start come before
  std::map<int, std::string> known_tries_, known_candidates_;
  DesignTime before_;
  AppendedFile tries_file_, candidates_file_, times_file_;
  std::map<int, TailPath> tied_paths_;
  DesignOutcome outcome_;
};

}  // namespace

std::string DesignOutcome::in_words() const {
  if (found) {
    std::string words =
        fmt::format("Try {} is good: it succeeds from {} (Eq. 6) and {} (reflex) of {} starts",
                    best->number, best->passed[0], best->passed[1], judged_starts);
    if (judged_runs > 2 * judged_starts) {
      words += fmt::format(", and in {} and {} of {} other animals", best->animals[0],
                           best->animals[1], judged_animals);
    }
    return words;
  }
  if (!best) return fmt::format("None of {} tries tied the knot", tries);
  return fmt::format(
      "No try is good enough: {} of {} tied the knot in the soft body. The best "
      "one, try {}, succeeded in {} of {} runs of the living animal ({})",
      candidates.size(), tries, best->number, best->passes(), judged_runs, best->shortcoming);
}

DesignOutcome design(const DesignOptions& options) {
  SoftBody own = soft_body(options.specimen);
  const std::string why = too_short_for(own.specimen, options.knot);
  if (!why.empty()) throw InputError(why);
  claim(options);
  Search search(options, std::move(own));
  return search.run();
}

}  // namespace hagfish
