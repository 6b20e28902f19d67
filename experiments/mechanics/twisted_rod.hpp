// Twisting moments at which elastic rods give way: a straight one under tension (Greenhill), and
// one bent into a ring (Michell). They are chains of alternating joints.
#pragma once

namespace hagfish {

struct TwistedRod {
  int bodies = 0;       ///< a multiple of 4
  double ratio = 1;     ///< B / C
  bool in_turn = true;  ///< chain_of()'s `in_turn`
};

/// Over that of theory.
struct GivesWay {
  double moment = 0;
  double cpu = 0;  ///< s
};

/// The rod is clamped at both ends, one of which slides along it and is pulled.
GivesWay greenhill(const TwistedRod& rod);
/// Head and tail are welded. Theory has a total twist of 2 pi sqrt(3) B / C.
GivesWay michell(const TwistedRod& rod);

}  // namespace hagfish
