// The search for paths of the tail that tie a knot: what was tried, and what to try next.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/design/soft_body.hpp"

namespace hagfish {

/// Paths on which a type was seen, by type. New paths are random ones, go on from these, each type
/// being as likely, so that what is rare is looked into as often as what is common, or displace
/// those on which the wanted type was seen. Only types of fewer crossings than that are led on
/// from; for a sum, only its summands. Of each type the paths that left most of the tail are kept,
/// of those alone that the living body repeats.
/// A path is the less likely gone on from, the more often what came of it, or of a path before it,
/// failed in the living body, and the more likely, the more runs the best of that passed. Which try
/// makes which path depends on the seed and on the results of all batches before its own, so that
/// results may come in any order and from anywhere.
class Archive {
 public:
  Archive(unsigned seed, const std::string& wanted);

  /// Whether the path of a try to where it saw a type is to be kept, if the living body repeats it.
  bool would_keep(const TailPath& path, const TypeSeen& seen) const;

  /// The plan of a try, whose results of all batches before are there.
  PathPlan plan_of(int number) const;

  /// The result of that try, one after the other.
  void add(int number, const PathPlan& plan, const Tying& tying);

  /// How many runs of the living body the program of that try, which was added, passed.
  void judged(int number, int passes);

  /// Number of tries in which each type was seen at two looks in a row.
  const std::map<std::pair<int, int>, int>& counts() const { return counts_; }

 private:
  using Type = std::pair<int, int>;  // determinant, v2: rises

  unsigned seed_;
  KnotInvariants wanted_;
  int crossings_;            // crossings of wanted_
  std::set<Type> summands_;  // summands of wanted_, where it is a sum
  struct Kept {
    PathPlan plan;  // path to where the type was seen, without turns
    double left;    // share left of the tail
  };
  struct Line {
    int parent, failures, passes;  // the try's; of it and what came of it; the best
  };
  bool leads_on(const KnotInvariants& type) const;
  double promise(const PathPlan& plan) const;
  const PathPlan& likely(const std::vector<Kept>& kept, Draw& draw) const;

  std::map<Type, std::vector<Kept>> paths_;  // most of the tail first
  std::vector<Kept> with_pull_;              // paths on which the wanted type was seen
  std::vector<Line> lines_;                  // lines by number
  std::map<Type, int> counts_;
};

/// Tries whose paths are made of the same archive.
inline constexpr int batch_size = 32;

/// A line of a file of tries: "0_1 0 8.4 0 0 0 3_1 8.8 12 9.6 0.2 1 .", the fields of each TypeSeen
/// but `reached`, how it ended, and each part of the path: how many waypoints, and these.
std::string tying_text(const Tying& tying);
/// What tying_text() made, or nothing where it is not whole.
std::optional<Tying> tying_of(const std::string& text);

}  // namespace hagfish
