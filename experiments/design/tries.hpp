// The search for paths of the tail that tie a knot: what was tried, and what to try next.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/design/soft_body.hpp"

namespace hagfish {

/// Paths on which a type was seen, by type. New paths are random ones, go on from these, each type
/// being as likely, so that what is rare is looked into as often as what is common, or displace
/// those that tied the wanted type. Types of more crossings than that are led on from by no path.
/// Which try makes which path depends on the seed and on the results of all batches before its own,
/// so that results may come in any order and from anywhere.
class Archive {
 public:
  Archive(unsigned seed, const std::string& wanted);

  /// The plan of a try, whose results of all batches before are there.
  PathPlan plan_of(int number) const;

  /// The result of that try, one after the other.
  void add(int number, const Tying& tying);

  /// In how many tries each type was seen at two looks in a row.
  const std::map<std::pair<int, int>, int>& counts() const { return counts_; }

 private:
  using Type = std::pair<int, int>;  // determinant, v2: rises

  unsigned seed_;
  KnotInvariants wanted_;
  int crossings_;                                // of wanted_
  std::map<Type, std::vector<PathPlan>> paths_;  // to where the type was seen, without turns
  std::vector<TailPath> tied_, lost_;            // the wanted type, which the pull kept or not
  std::map<Type, int> counts_;
};

/// Tries whose paths are made of the same archive.
inline constexpr int batch_size = 32;

/// As a file of tries has it: "0_1 0 8.4 3_1 8.8 12 .", types with the times of their first and
/// last looks (s), how it ended, and each part of the path: how many waypoints, and these.
std::string tying_text(const Tying& tying);
/// What tying_text() made, or nothing where it is not whole.
std::optional<Tying> tying_of(const std::string& text);

}  // namespace hagfish
