// A loose overhand knot in an elastic rod under tension F, without friction: the loop becomes a
// circle that carries no tension, and F R² / B = 1/2 for a rod of no thickness (Audoly, Clauvelin,
// Neukirch, "Elastic knots", Phys. Rev. Lett. 99, 2007). Thickness adds about 1.3 r / R to that:
// measured here at r = 0.05, 0.1, 0.15 and 0.2 cm, and the same with links of 0.2 cm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/knot/knot.hpp"
#include "tests/support/chain_runs.hpp"

namespace hagfish::loose_knot_test {

constexpr int bodies = 120;
constexpr double link = 0.35;      // cm
constexpr double rigidity = 400;   // B, dyn cm^2
constexpr double tension = 50;     // F, dyn: R = 2 cm in the limit
constexpr double settling = 5;     // s; the loop's slowest motion fades with 0.6 s
constexpr double averaging = 1;    // s, the last of them
constexpr double touching = 0.02;  // cm: gaps of the knot's contacts

/// Shastri's long trefoil (t³ - 3t, t⁴ - 4t², t⁵ - 10t), its third axis shortened, run on straight
/// at both ends: unit directions of the rod's links.
std::vector<Eigen::Vector3d> trefoil_links() {
  const auto curve = [](double t) -> Eigen::Vector3d {
    const double tt = t * t;
    return 0.8 * Eigen::Vector3d(t * (tt - 3), tt * (tt - 4), 0.25 * t * (tt * tt - 10));
  };
  std::vector<Eigen::Vector3d> knotted;
  constexpr double end = 2.2;
  Eigen::Vector3d before = curve(-end);
  for (double t = -end; t < end; t += 1e-4) {
    const Eigen::Vector3d point = curve(t);
    if ((point - before).norm() >= link) {
      knotted.push_back((point - before).normalized());
      before = point;
    }
  }
  const int count = static_cast<int>(knotted.size());
  std::vector<Eigen::Vector3d> links(bodies);
  for (int b = 0; b < bodies; ++b) {
    links[b] = knotted[std::clamp(b - (bodies - count) / 2, 0, count - 1)];
  }
  return links;
}

/// Hinge angles, Y before Z at each joint, that give the links these directions, the first one
/// turned to +X.
Eigen::VectorXd angles_of(const std::vector<Eigen::Vector3d>& links) {
  Eigen::VectorXd angles(2 * (links.size() - 1));
  Eigen::Quaterniond frame = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), links[0]);
  for (std::size_t b = 1; b < links.size(); ++b) {
    const Eigen::Vector3d next = frame.conjugate() * links[b];
    const double y = std::atan2(-next.z(), next.x());
    const double z = std::asin(next.y());
    angles.segment<2>(2 * (b - 1)) << y, z;
    frame = frame * Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(z, Eigen::Vector3d::UnitZ());
  }
  return angles;
}

/// Universal joints alone: a rod that cannot twist. The free end lets any twist out, so that the
/// rod at rest has none either way.
ChainRun knotted_rod(double radius, double h) {
  Body body;
  body.length = link;
  body.mass = 0.1 * link;
  body.radius = radius;
  body.inertia = cylinder_inertia(body.mass, link, radius);
  Model model;
  append_body(model, body, {});
  for (int b = 1; b < bodies; ++b) {
    append_body(model, body, {Axis::y, Axis::z});
  }
  for (Hinge& hinge : model.hinges) {
    hinge.stiffness = rigidity / link;
    hinge.damping = 0.1 * hinge.stiffness;
  }
  model.drag = {0.2, 0.2};
  Scene scene = bare_scene(h);
  scene.contact.margin = 0.05;
  scene.contact.least_arc = 6;  // half of the loop, which is 14 cm long
  ChainRun run(model, scene);
  run.state.q.tail(2 * (bodies - 1)) = angles_of(trefoil_links());
  return run;
}

/// Bend of the rod between bodies b - 1 and b, 1/cm.
double curvature(const Kinematics& kin, int b) {
  const Eigen::Vector3d before = kin.rotation[b - 1].col(0);
  const Eigen::Vector3d after = kin.rotation[b].col(0);
  return std::atan2(before.cross(after).norm(), before.dot(after)) / link;
}

/// Force (dyn) that the part of the rod from body b on exerts on the part before it, at rest.
Eigen::Vector3d force_behind(const ChainRun& run, int b) {
  Eigen::Vector3d force(tension, 0, 0);
  for (std::size_t i = 0; i < run.last.rows.size(); ++i) {
    const Row& row = run.last.rows[i];
    if (row.kind != RowKind::contact) {
      continue;
    }
    visit_forces(row, run.seen.kin,
                 [&](int body, const Eigen::Vector3d& unit_force, const Eigen::Vector3d&) {
                   if (body >= b) {
                     force += run.last.lambda[i] / run.scene.time.step * unit_force;
                   }
                 });
  }
  return force;
}

/// What one step shows of the loop; contact forces pass between neighbouring contacts from step to
/// step, so that only averages count.
struct Loop {
  double mean_curvature = 0;  ///< from the first to the last contact that bound the loop, 1/cm
  double integral = 0;        ///< F_t + B κ² / 2 at its top, dyn
};

Loop loop_of(const ChainRun& run) {
  int begin = 0;
  int end = bodies;
  for (const Contact& contact : run.seen.contact.contacts) {
    if (contact.gap < touching) {
      begin = std::max(begin, contact.body_a());
      end = std::min(end, contact.body_b());
    }
  }
  Loop loop;
  for (int b = begin; b <= end && end < bodies; ++b) {
    loop.mean_curvature += curvature(run.seen.kin, b) / (end - begin + 1);
  }
  const int top = (begin + end) / 2;
  const Eigen::Vector3d tangent =
      (run.seen.kin.rotation[top - 1].col(0) + run.seen.kin.rotation[top].col(0)).normalized();
  loop.integral = force_behind(run, top).dot(tangent) +
                  0.5 * rigidity * std::pow(curvature(run.seen.kin, top), 2);
  return loop;
}

/// The knot pulled to rest: time averages over the last of it.
struct Rest {
  double thickness = 0;  ///< r / R
  double load = 0;       ///< F R² / B
  double integral = 0;   ///< (F_t + B κ² / 2) / F at the loop's top
};

Rest pull(double radius, double h) {
  ChainRun run = knotted_rod(radius, h);
  TipForce tip;
  tip.value.x() = tension;
  Loop sum;
  int count = 0;
  while (run.time < settling - 0.5 * h) {
    run.step(tip);
    if (run.time > settling - averaging) {
      const Loop loop = loop_of(run);
      sum.mean_curvature += loop.mean_curvature;
      sum.integral += loop.integral;
      ++count;
    }
    // No strand may have passed through another: looked at as often as the phases of a run.
    if (std::lround(run.time / h) % std::lround(0.25 / h) == 0) {
      EXPECT_EQ(knot_name(knot_type(run.centres(), {.votes = 9, .seed = 1}).type), "3_1")
          << "at " << run.time << " s";
    }
  }
  const double loop_radius = count / sum.mean_curvature;
  return {radius / loop_radius, tension * loop_radius * loop_radius / rigidity,
          sum.integral / count / tension};
}

TEST(LooseKnot, LoadOfTheThinRod) {
  const Rest thick = pull(0.1, 4e-3);
  const Rest thin = pull(0.05, 2e-3);  // half the radius bears half the overlap

  // Frictionless contacts do no work along the rod: F_t + B κ² / 2 is the same all along it and F
  // at the free end, whatever the thickness. 0.03: what the average leaves of the forces' flicker.
  EXPECT_NEAR(thick.integral, 1, 0.03);
  EXPECT_NEAR(thin.integral, 1, 0.03);

  // Thickness adds in proportion to r / R. 0.02: the loop's ends are known to one hinge in 36, and
  // terms of second order in r / R are left.
  const double slope = (thick.load - thin.load) / (thick.thickness - thin.thickness);
  EXPECT_NEAR(thin.load - slope * thin.thickness, 0.5, 0.02);
}

}  // namespace hagfish::loose_knot_test
