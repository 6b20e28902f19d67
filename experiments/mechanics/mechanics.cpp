// Tables of experiments/results/mechanics/page.md on standard output: rows of CSV, but where said.
//   mechanics twisted    moments at which twisted rods give way, over those of theory
//   mechanics hooked     ropes round a post, and ropes that hook into each other
//   mechanics loose      loose open knots in elastic rods, pulled
//   mechanics mujoco     the same clasp by MuJoCo
//   mechanics ply        twisted rods that have wound up loops of themselves
//   mechanics states     the Table 1 animal on its way, as JSON, for other simulators
//   mechanics tight      tight open knots in rope
//   mechanics time       a rod that is bent and released, by steps of several lengths
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "experiments/mechanics/clasp.hpp"
#include "experiments/mechanics/loose_knot.hpp"
#include "experiments/mechanics/mechanics.hpp"

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
    for (double radius = 0.04; radius > 0.002; radius /= 2) {
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
  for (const std::string type : {"3_1", "4_1", "5_1", "5_2"}) {
    for (const double link : {0.2, 0.17, 0.14}) {
      const TightKnot knot = tighten(type, link);
      std::printf("%s,%g,%d,%.4f,%s,%.2g\n", knot.type.c_str(), link, knot.bodies, knot.shortening,
                  knot.at_rest ? "yes" : "no", knot.cpu);
      std::fflush(stdout);
    }
  }
}

void print_twisted(const char* problem, const GivesWay& of, const TwistedRod& rod) {
  std::printf("%s,%s,%g,%d,%.5f,%.2g\n", problem, rod.in_turn ? "in turn" : "alike", rod.ratio,
              rod.bodies, of.moment, of.cpu);
  std::fflush(stdout);
}

void twisted() {
  std::puts("problem,joints,ratio,bodies,moment,cpu");
  const auto each = [](bool in_turn, const char* problem, GivesWay (*of)(const TwistedRod&)) {
    for (const double ratio : {0.5, 1.0, 2.0}) {
      for (const int bodies : {80, 160, 320}) {
        const TwistedRod rod{.bodies = bodies, .ratio = ratio, .in_turn = in_turn};
        print_twisted(problem, of(rod), rod);
      }
    }
  };
  each(false, "Greenhill's rod", greenhill);
  each(true, "Greenhill's rod", greenhill);
  each(true, "Michell's ring", michell);
}

void print_hooked(const char* problem, const char* figure, double link, int bodies, double value,
                  double expected, bool at_rest, double cpu) {
  std::printf("%s,%s,%g,%d,%.5f,%.5f,%s,%.2g\n", problem, figure, link, bodies, value, expected,
              at_rest ? "yes" : "no", cpu);
  std::fflush(stdout);
}

void hooked() {
  std::puts("problem,figure,link,bodies,value,expected,rest,cpu");
  for (const double link : {0.4, 0.2, 0.1, 0.05}) {
    const Capstan rope = lie_round_post(link);
    print_hooked("capstan", "pull at the head over that at the tail", link, rope.bodies, rope.head,
                 1, rope.at_rest, rope.cpu);
    print_hooked("capstan", "sum of the post's forces over π F", link, rope.bodies, rope.press, 1,
                 rope.at_rest, rope.cpu);
  }
  for (const double link : {0.4, 0.2, 0.1, 0.05}) {
    const Clasp rope = hook(link);
    print_hooked("clasp", "distance of the tips", link, rope.bodies, rope.tips, ideal_tips(),
                 rope.at_rest, rope.cpu);
    print_hooked("clasp", "force of one rope on the other one over F", link, rope.bodies, rope.load,
                 2, rope.at_rest, rope.cpu);
  }
}

#ifdef HAGFISH_MUJOCO
void mujoco() {
  std::puts("link,bodies,step,density,tips,expected,overlap,rest,cpu");
  const std::vector<std::pair<double, MujocoRope>> ropes{{0.4, {0.02, 1}},
                                                         {0.4, {0.02, 0.1}},
                                                         {0.4, {0.01, 0.1}},
                                                         {0.2, {0.02, 1}},
                                                         {0.2, {0.02, 0.1}}};
  for (const auto& [link, rope] : ropes) {
    const MujocoClasp clasp = hook_in_mujoco(link, rope);
    std::printf("%g,%d,%g,%g,%.5f,%.5f,%.2e,%s,%.2g\n", link, clasp.bodies, rope.step, rope.density,
                clasp.tips, ideal_tips(), clasp.overlap, clasp.at_rest ? "yes" : "no", clasp.cpu);
    std::fflush(stdout);
  }
}
#endif

void ply() {
  std::puts("per_radius,bodies,angle,radius,force,moment,rest,cpu");
  for (const double angle : {0.35, 0.45}) {
    for (const double per_radius : {1.0, 2.0, 3.0}) {
      const Ply rod = wind_up({.angle = angle, .per_radius = per_radius});
      std::printf("%g,%d,%.4f,%.4f,%.4f,%.4f,%s,%.2g\n", per_radius, rod.bodies, rod.angle,
                  rod.radius, rod.force, rod.moment, rod.at_rest ? "yes" : "no", rod.cpu);
      std::fflush(stdout);
    }
  }
}

void time_rules() {
  std::puts("rule,steps,error,cpu");
  constexpr int fine = 25600;
  const Eigen::Vector3d right = release(TimeRule::midpoint, fine).tail;
  for (const auto& [name, rule] :
       {std::pair{"Euler", TimeRule::euler}, {"midpoint", TimeRule::midpoint}}) {
    for (const int steps : {100, 200, 400, 800, 1600, 3200}) {
      const ReleasedRod rod = release(rule, steps);
      std::printf("%s,%d,%.3e,%.2g\n", name, steps, (rod.tail - right).norm(), rod.cpu);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, void (*)()> tables{
      {"hooked", hooked},  {"loose", loose},

#ifdef HAGFISH_MUJOCO
      {"mujoco", mujoco},
#endif
      {"ply", ply},        {"states", print_mirrored_states},
      {"tight", tight},    {"time", time_rules},
      {"twisted", twisted}};
  const auto table = argc == 2 ? tables.find(argv[1]) : tables.end();
  if (table == tables.end()) {
    std::fputs("mechanics hooked | loose | mujoco | ply | states | tight | time | twisted\n",
               stderr);
    return 2;
  }
  table->second();
  return 0;
}
