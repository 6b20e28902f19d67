// A rope without stiffness or friction lies half round a post. The pull F at its loose end is the
// pull at its clamped one, and the post presses with F over its radius on each length of rope.
#pragma once

namespace hagfish {

/// Over F, and over pi F.
struct Capstan {
  int bodies = 0;
  bool at_rest = false;
  double head = 0;   ///< pull at the clamped end
  double press = 0;  ///< sum of the post's forces, whatever their ways
  double cpu = 0;    ///< s
};
/// `link`: length of a body over the post's radius.
Capstan lie_round_post(double link);

}  // namespace hagfish
