// Tight open knots in a rope: a chain of uniform girth without stiffness, as sharp as a circle
// whose tube fills it at most.
#pragma once

#include <string>

namespace hagfish {

/// Pulled to rest. Nothing rubs, so that the pull sets the time that it takes alone.
struct TightKnot {
  std::string type;  ///< "3_1"
  int bodies = 0;    ///< number of bodies at rest
  bool at_rest = false;
  double shortening = 0;  ///< rope less the distance of its ends, diameters
  double cpu = 0;         ///< s
};

/// `type`: 3_1, 4_1, 5_1 or 5_2. `link`: length of a body, diameters.
TightKnot tighten(const std::string& type, double link);

}  // namespace hagfish
