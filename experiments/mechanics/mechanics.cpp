// Tables of experiments/results/mechanics.md: rows of CSV on standard output.
//   mechanics loose      loose open knots in elastic rods, pulled
//   mechanics tight      tight open knots in rope
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "experiments/mechanics/loose_knot.hpp"
#include "experiments/mechanics/tight_knot.hpp"

namespace {

using namespace hagfish;

void print_loose(const char* series, const LooseKnotInput& input) {
  const LooseKnot knot = pull_loose_knot(input);
  double points = 0;
  double interval = 0;
  for (std::size_t i = 0; i < knot.touches.size(); ++i) {
    double& extent = i == 0 || i + 1 == knot.touches.size() ? points : interval;
    extent = std::max(extent, knot.touches[i].extent);
  }
  std::printf("%s,%s,%.3g,%d,%g,%.4f,%.3f,%zu,%.1f,%.1f,%s,%.2g\n", series, knot.type.c_str(),
              std::sqrt(input.radius), knot.bodies, input.ratio, knot.load, knot.integral,
              knot.touches.size(), interval, points, knot.at_rest ? "yes" : "no", knot.cpu);
  std::fflush(stdout);
}

void loose() {
  std::puts("series,type,thin,bodies,ratio,load,integral,touches,interval,points,rest,cpu");
  for (const int crossings : {3, 5}) {
    for (double radius = 0.04; radius > (crossings == 3 ? 0.002 : 0.004); radius /= 2) {
      print_loose("thin", {.crossings = crossings, .radius = radius});
    }
  }
  for (const double per_braid : {2.0, 4.0, 6.0})
    print_loose("bodies", {.radius = 0.01, .per_braid = per_braid});
  for (const double ratio : {1.0, 2.0})
    print_loose("twist", {.radius = 0.02, .per_braid = 4, .ratio = ratio});
}

void tight() {
  std::puts("type,link,bodies,shortening,rest,cpu");
  for (const char* type : {"3_1", "4_1", "5_2"}) {
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
