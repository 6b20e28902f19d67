// Makes a program by which the animal ties a knot itself, from the knot's name.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hagfish {

/// Starts with noise that a program is judged by, for each law, and how many of them may fail.
inline constexpr int judged_starts = 20, allowed_failures = 1;

struct DesignOptions {
  std::string knot;              ///< name that name_in_scene() reads
  std::string specimen;          ///< text of the animal's file; empty: Table 1's animal
  std::filesystem::path folder;  ///< files of the search and of what it found
  bool resume = false;           ///< goes on in it
  std::filesystem::path start;  ///< folder of another search, whose paths are gone on from, or none
  double budget = 900;          ///< wall time for the search, s
  int threads = 1;
  unsigned seed = 1;
  bool animals = false;                              ///< a program must serve other animals, too
  std::string typed;                                 ///< the command line, for the log
  std::function<bool()> interrupted;                 ///< asked at each step, by every thread
  std::function<void(const std::string&)> progress;  ///< gets a line now and then
};

/// A path that ties the knot, tried in the living body.
struct Candidate {
  int number = 0;           ///< number of the try
  double slower = 1;        ///< the last tried of `paces` (living_body.hpp)
  std::string shortcoming;  ///< why it was given up; empty of one that is good enough
  int judged = 0;           ///< starts
  int passed[2] = {0, 0};   ///< how many of these succeed, by judged_laws
  int animals[2] = {0, 0};  ///< other ones that it serves, by judged_laws
  int passes() const { return passed[0] + passed[1] + animals[0] + animals[1]; }
};

struct DesignTime {
  double wall = 0, cpu = 0;  ///< s, with that of the search before it was resumed
};

struct DesignOutcome {
  bool found = false;        ///< a program of enough starts; its files are in the folder
  bool interrupted = false;  ///< all is kept: go on by `resume`
  int tries = 0;
  int judged_runs = 2 * judged_starts;             ///< runs of the living animal for each candidate
  std::optional<Candidate> best;                   ///< the found one, or which came nearest
  std::vector<Candidate> candidates;               ///< candidates in the order of their tries
  std::vector<std::pair<std::string, int>> types;  ///< tied by how many tries
  DesignTime time;
  std::string in_words() const;  ///< one line: what was found, or how near it came
};

/// Searches by whole batches until a program is found, the budget is over, or it is interrupted.
/// Which program is found depends on knot, animal, seed and the tries of `start` alone. The folder
/// gets tries.csv, candidates.csv and times.csv, and start.csv, the tries of `start`, by which it
/// is resumed, and of the best program, where there is one, the files of FoundScene, knot.h5,
/// strip.png, README.md and result.csv. Throws InputError for a knot that the animal is too short
/// for (length_bound.hpp), FileError where the folder holds another search, or cannot be written.
DesignOutcome design(const DesignOptions& options);

}  // namespace hagfish
