// Tables of experiments/results/mechanics.md: rows of CSV on standard output.
//   mechanics loose      loose open knots in elastic rods, pulled
//   mechanics tight      tight open knots in rope
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "experiments/mechanics/loose_knot.hpp"
#include "experiments/mechanics/tight_knot.hpp"

namespace {

using namespace hagfish;

void print_loose(const LooseKnotInput& input, const LooseKnot& knot) {
  std::printf("%s,%.3g,%d,%g,%.4f,%.4f,%.4f,%zu,%.1f,%.1f,%.1f,%s,%.2g\n", knot.type.c_str(),
              std::sqrt(input.radius), knot.bodies, input.ratio, knot.load, knot.top_load,
              knot.integral, knot.touches.size(), knot.touches.front().extent,
              knot.touches[knot.touches.size() / 2].extent, knot.touches.back().extent,
              knot.at_rest ? "yes" : "no", knot.cpu);
  std::fflush(stdout);
}

void loose() {
  for (const int crossings : {3, 5}) {
    for (double radius = 0.04; radius > (crossings == 3 ? 0.002 : 0.004); radius /= 2) {
      const LooseKnotInput input{.crossings = crossings, .radius = radius};
      print_loose(input, pull_loose_knot(input));
    }
  }
  for (const double per : {2.0, 4.0, 6.0}) {
    const LooseKnotInput input{.radius = 0.01, .per_braid = per};
    print_loose(input, pull_loose_knot(input));
  }
  for (const double ratio : {1.0, 2.0}) {
    const LooseKnotInput input{.radius = 0.02, .per_braid = 4, .ratio = ratio};
    print_loose(input, pull_loose_knot(input));
  }
}

void tight() {
  for (const char* type : {"3_1", "4_1", "5_1", "5_2"}) {
    for (const double link : {0.2, 0.17, 0.14}) {
      const TightKnot knot = tighten(type, link);
      std::printf("%s,%g,%d,%.4f,%s,%.2g\n", knot.type.c_str(), link, knot.bodies, knot.shortening,
                  knot.at_rest ? "yes" : "no", knot.cpu);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "loose") == 0) {
    loose();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "tight") == 0) {
    tight();
    return 0;
  }
  std::fputs("mechanics loose | tight\n", stderr);
  return 2;
}
