// The search for paths of the tail that tie a knot: what was tried, and what to try next.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/design/soft_body.hpp"

namespace hagfish {

/// Paths that tied something, by what they tied. New paths are random ones, or mutations of these,
/// each type being as likely, so that what is rare is looked into as often as what is common: no
/// measure tells how near a path is to a knot. Which try makes which path depends on the seed and
/// on the results of all batches before its own, so that results may come in any order and from
/// anywhere.
class Archive {
 public:
  explicit Archive(unsigned seed) : seed_(seed) {}

  /// The path of a try, whose results of all batches before are there.
  TailPath path_of(int number) const;

  /// The result of that try, one after the other.
  void add(int number, const TailPath& path, const Tying& tying);

  /// How many tries tied each type at their end.
  const std::map<std::pair<int, int>, int>& counts() const { return counts_; }

 private:
  using Type = std::pair<int, int>;  // determinant, v2: rises
  void keep(int number, const KnotInvariants& type, const TailPath& path);

  unsigned seed_;
  std::map<Type, std::vector<TailPath>> paths_;
  std::map<Type, int> counts_;
};

/// Tries whose paths are made of the same archive.
inline constexpr int batch_size = 32;

/// As a file of tries has it: "0_1 0 8.4 3_1 8.8 12 .", types with the times of their first and
/// last looks (s), and how it ended.
std::string tying_text(const Tying& tying);
/// What tying_text() made, or nothing where it is not whole.
std::optional<Tying> tying_of(const std::string& text);

}  // namespace hagfish
