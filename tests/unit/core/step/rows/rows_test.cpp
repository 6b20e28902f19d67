#include "core/step/rows/row.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "core/contact/patch.hpp"
#include "core/step/paper_step.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/row_lists.hpp"

namespace hagfish::rows_test {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double h = 2e-3;
const ConstraintSettings speculative;
const ConstraintSettings violated{Activation::violated, 0.5};

/// A hinge about Z at `angle`.
struct OneHinge {
  Model model;
  State state;
};

OneHinge one_hinge(double angle) {
  OneHinge c;
  append_body(c.model, {1, 1, 0.3, {1, 1, 1}, 0, 0}, {});
  append_body(c.model, {1, 1, 0.3, {1, 1, 1}, 0, 0}, {Axis::z});
  c.state = rest_state(c.model);
  c.state.q[7] = angle;
  return c;
}

/// Contacts of a knotted fish, both near and overlapping, and every other kind of row.
struct Tangle {
  Model model;
  State state;
  Kinematics kin;
  ContactSet set;
  std::vector<ThigmotaxisCommand> commands;

  explicit Tangle(unsigned seed, Model fish = table1_hagfish()) : model(std::move(fish)) {
    Random random(seed);
    state = knotted_state(random, model, 2.45, 0.002);
    state.q.head<3>() = random_vector(random);
    state.qdot = random_entries(random, model.nv());
    kin = kinematics(model, state);
    set = find_contacts(spline(model, kin.centre), {});
    commands = {{set.contacts.front(), {0.5, 2}}, {set.contacts.back(), {-1, 3}}};
  }

  /// Eq. 6 of `commands_`, at the speeds commanded, whatever those now.
  std::vector<Row> at_once(const std::vector<ThigmotaxisCommand>& commands_,
                           Eq6Point at = Eq6Point::skin, double patch = 0) const {
    ControllerSettings settings;
    settings.eq6_at = at;
    settings.contact_patch = patch;
    return thigmotaxis_rows(model, commands_, settings, kin, h);
  }

  /// The same two contacts as the knot's ends, over patches of the size `side` (cm).
  std::vector<Row> over_patches(Eq6Point at = Eq6Point::skin, double side = 0.3) const {
    std::vector<ThigmotaxisCommand> ends = commands;
    ends[0].end = KnotEnd::first;
    ends[1].end = KnotEnd::last;
    return at_once(ends, at, side);
  }

  std::vector<Row> rows() const {
    std::vector<Row> all = head_rows(state, speculative, h);
    for (const auto& more :
         {limit_rows(model, state, speculative, h), contact_rows(model, set, speculative, h),
          plane_rows(model, kin, speculative, h), at_once(commands), over_patches()}) {
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }
};

/// Of joints with limits of each kind.
std::vector<Tangle> tangles(unsigned seed) { return {Tangle(seed), Tangle(seed, cone_hagfish())}; }

/// A row of a hinge: whether it bounds the angle from below (1) or above (-1), and its speed.
struct LimitRow {
  double sign, rhs;
};

// q̇ >= -(q - lower) / h and -q̇ >= -(upper - q) / h: at most to the limit within the step. Half of a
// violation is pushed out. The nearer side comes first, so that mirror images keep the order.
TEST(LimitRows, BoundEachLimitedSideTheNearerOneFirst) {
  struct Case {
    std::string name;
    double angle, lower, upper;
    ConstraintSettings settings;
    std::vector<LimitRow> rows;
  };
  const double past = 0.5 * 0.02 / h;
  for (const Case& c : {
           Case{"nearer to the lower",
                0.05,
                -0.3,
                0.5,
                speculative,
                {{1, -0.35 / h}, {-1, -0.45 / h}}},
           {"nearer to the upper", 0.2, -0.3, 0.5, speculative, {{-1, -0.3 / h}, {1, -0.5 / h}}},
           {"past the upper", 0.52, -0.3, 0.5, speculative, {{-1, past}, {1, -0.82 / h}}},
           {"past the lower", -0.32, -0.3, 0.5, speculative, {{1, past}, {-1, -0.82 / h}}},
           {"one free side", 0.1, -0.3, unbounded, speculative, {{1, -0.4 / h}}},
           {"none is violated", 0.5, -0.3, 0.5, violated, {}},
           {"one is violated", 0.52, -0.3, 0.5, violated, {{-1, past}}},
       }) {
    SCOPED_TRACE(c.name);
    OneHinge hinge = one_hinge(c.angle);
    hinge.model.hinges[0].lower = c.lower;
    hinge.model.hinges[0].upper = c.upper;
    const std::vector<Row> rows = limit_rows(hinge.model, hinge.state, c.settings, h);
    ASSERT_EQ(rows.size(), c.rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].kind, RowKind::limit);
      EXPECT_EQ(rows[i].joint()->dof, 6);
      EXPECT_EQ(rows[i].joint()->sign, c.rows[i].sign);
      EXPECT_NEAR(rows[i].rhs, c.rows[i].rhs, 1e-12 / h);
      EXPECT_EQ(rows[i].lower, 0);
      EXPECT_EQ(rows[i].upper, unbounded);
    }
  }
}

TEST(ContactRows, CloseAGapAndPushOutAnOverlap) {
  const Tangle t(81);
  ContactSet set{{2, t.set.contacts.front()}, {}, {}, 0};
  set.contacts[0].gap = 0.03;
  set.contacts[1].gap = -0.01;
  const std::vector<Row> rows = contact_rows(t.model, set, speculative, h);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_DOUBLE_EQ(rows[0].rhs, -0.03 / h);
  EXPECT_DOUBLE_EQ(rows[1].rhs, 0.5 * 0.01 / h);
  EXPECT_EQ(rows[0].lower, 0);
  EXPECT_EQ(rows[0].upper, unbounded);
  const std::vector<Row> late = contact_rows(t.model, set, violated, h);
  ASSERT_EQ(late.size(), 1U);
  EXPECT_DOUBLE_EQ(late[0].rhs, 0.5 * 0.01 / h);
}

TEST(Rows, OnlyThoseNearBindingAreAppended) {
  for (const Tangle& t : tangles(89)) {
    const BodyVelocities velocity = t.kin.velocities();
    for (const auto& [slack, at_rest] :
         {std::pair(-10.0, -unbounded), {0.1, -unbounded}, {10, 0.1}}) {
      const NearBinding wanted{t.state.qdot, velocity, slack, at_rest};
      std::vector<Row> rows;
      for (const auto* contacts : {&t.set.contacts, &t.set.near_pairs}) {
        for (const Contact& contact : *contacts) {
          append_contact_row(t.model, contact, nullptr, speculative, h, wanted, rows);
        }
      }
      append_limit_rows(t.model, t.state, speculative, h, wanted, rows);
      append_plane_rows(t.model, t.kin, speculative, h, wanted, rows);
      std::vector<RowId> expected;
      for (const auto& all : {contact_rows(t.model, t.set, speculative, h),
                              limit_rows(t.model, t.state, speculative, h),
                              plane_rows(t.model, t.kin, speculative, h)}) {
        for (const Row& row : all) {
          if (row_velocity(row, velocity, t.state.qdot) < row.rhs + slack || row.rhs > -at_rest) {
            expected.push_back(row.id);
          }
        }
      }
      std::vector<RowId> found;
      for (const Row& row : rows) found.push_back(row.id);
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(PlaneRows, SkipTheNeckAndLookAlongX) {
  Model fish = table1_hagfish();
  State state = rest_state(fish);
  state.q[0] = -20.1055;  // one body is a few micrometres in
  const Kinematics kin = kinematics(fish, state);
  fish.obstacles.at(0).shape = Plane{.neck = 2.9};
  const std::vector<Row> rows = plane_rows(fish, kin, speculative, h);
  // Centres at 0.424 (b + ½): the first beyond 2.9 cm is body 7.
  ASSERT_EQ(rows.size(), 93U);
  int slower = 0;  // pushed out by less than the fastest
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int body = static_cast<int>(i) + 7;
    const double gap = 0.424 * (body + 0.5) - 20.1055 - fish.bodies[body].radius;
    int forces = 0;
    visit_forces(rows[i], kin,
                 [&](int loaded, const Eigen::Vector3d&, const Eigen::Vector3d& force) {
                   ++forces;
                   EXPECT_EQ(loaded, body);
                   EXPECT_EQ(force, Eigen::Vector3d::UnitX());
                 });
    EXPECT_EQ(forces, 1);
    // Centres are sums of 100 lengths: 1e-14 cm over h.
    const double fastest = speculative.baumgarte_speed;
    EXPECT_NEAR(rows[i].rhs, gap >= 0 ? -gap / h : std::min(-0.5 * gap / h, fastest), 1e-9);
    if (gap < 0 && -0.5 * gap / h < fastest) ++slower;
  }
  EXPECT_GT(slower, 0);
  const std::vector<Row> late = plane_rows(fish, kin, violated, h);
  EXPECT_LT(late.size(), rows.size());
  for (const Row& row : late) EXPECT_GT(row.rhs, 0);
  fish.obstacles.at(0).shape = Plane{.neck = 0};
  EXPECT_EQ(plane_rows(fish, kin, speculative, h).size(), 100U);
  fish.obstacles.clear();
  EXPECT_TRUE(plane_rows(fish, kin, speculative, h).empty());
}

TEST(HeadRows, TakeADriftBack) {
  Model fish = table1_hagfish();
  State state = rest_state(fish);
  EXPECT_EQ(head_rows(state, speculative, h).size(), 6U);
  for (const Row& row : head_rows(state, speculative, h)) EXPECT_EQ(row.rhs, 0);

  // Going at the velocity that the rows ask for shrinks the drift by baumgarte. The angle of a
  // rotation by its sine is off by its cube.
  const Eigen::Vector3d turn(1e-4, -2e-4, 3e-4);
  state.q.head<3>() << 1e-3, 2e-3, -3e-3;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  for (const double sign : {1.0, -1.0}) {  // both quaternions of a rotation
    state.q.segment<4>(3) << sign * turned.w(), sign * turned.x(), sign * turned.y(),
        sign * turned.z();
    const std::vector<Row> rows = head_rows(state, speculative, h);
    Eigen::VectorXd v = Eigen::VectorXd::Zero(fish.nv());
    for (int k = 0; k < 6; ++k) {
      EXPECT_EQ(rows[k].joint()->dof, k);
      EXPECT_EQ(rows[k].lower, -unbounded);
      EXPECT_EQ(rows[k].upper, unbounded);
      v[k] = rows[k].rhs;
    }
    const Eigen::VectorXd q = advance(state.q, v, h);
    EXPECT_LT((q.head<3>() - 0.5 * state.q.head<3>()).norm(), 1e-15);
    const Eigen::AngleAxisd left(root_orientation(q));
    EXPECT_LT((left.angle() * left.axis() - 0.5 * turn).norm(), 1e-11);
  }
}

/// Where the material of a strand that is at `point` now is after `time`: of each body of the mix
/// that its spline point is, as rigid ones, and mixed alike.
Eigen::Vector3d carried(const Tangle& t, int segment, double along, const Eigen::Vector3d& point,
                        double time) {
  Kinematics then;
  update_positions(t.model, advance(t.state.q, t.state.qdot, time), then);
  const SplineMix mix = spline_mix(segment, along, t.model.body_count());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < mix.count; ++k) {
    const int b = mix.first + k;
    const Eigen::Vector3d own = t.kin.rotation[b].transpose() * (point - t.kin.centre.col(b));
    sum += mix.weight[k] * (then.centre.col(b) + then.rotation[b] * own);
  }
  return sum;
}

// Eq. 6 where the skins touch: velocities of the two strands' material there, by differences of
// positions, times the tangents. Rounding of speeds of some 20 cm/s, as below.
TEST(ThigmotaxisRows, AreOfTheSkinsWhereTheyTouch) {
  const Tangle t(83);
  const double e = 1e-6;
  const std::vector<SplineSegment> now = spline(t.model, t.kin.centre);
  const std::vector<Row> rows = t.at_once(t.commands);
  ASSERT_EQ(rows.size(), 4U);
  for (int place = 0; place < 2; ++place) {
    const Contact& c = t.commands[place].contact;
    const SplineSegment &a = now[c.segment_a], &b = now[c.segment_b];
    // From the middle of a to that of b: r_a, half of the gap, and on.
    const Eigen::Vector3d apart = b.point(c.t_b) - a.point(c.t_a);
    const Eigen::Vector3d point =
        a.point(c.t_a) + (a.radius(c.t_a) + 0.5 * c.gap) * apart.normalized();
    const auto velocity = [&](int segment, double along) -> Eigen::Vector3d {
      return (carried(t, segment, along, point, e) - carried(t, segment, along, point, -e)) /
             (2 * e);
    };
    const Eigen::Vector3d slip = velocity(c.segment_a, c.t_a) - velocity(c.segment_b, c.t_b);
    const auto speed = [&](const Row& row) {
      return row_velocity(row, t.kin.velocities(), t.state.qdot);
    };
    EXPECT_NEAR(speed(rows[2 * place]), c.tangent_a.dot(slip), 1e-6);
    EXPECT_NEAR(speed(rows[2 * place + 1]), -c.tangent_b.dot(slip), 1e-6);
  }
}

// An animal cannot push or turn itself as a whole, where its strands touch or by Eq. 6.
TEST(Rows, BetweenStrandsHaveNoSumAndNoMoment) {
  const Tangle t(83);
  const auto whole = [&](const Row& row) {
    Matrix6Xd wrench = Matrix6Xd::Zero(6, t.model.body_count());
    Eigen::VectorXd joint = Eigen::VectorXd::Zero(t.model.nv());
    add_row(row, t.kin, 1, wrench, joint);
    return Vector6d(wrench.rowwise().sum());
  };
  for (const Eq6Point at : {Eq6Point::skin, Eq6Point::centreline}) {
    for (const auto& rows : {t.at_once(t.commands, at), t.over_patches(at),
                             contact_rows(t.model, t.set, speculative, h)}) {
      ASSERT_GE(rows.size(), 4U);
      for (const Row& row : rows) {
        EXPECT_LT(whole(row).norm(), 1e-13);  // rounding of some ten numbers of up to 20
      }
    }
  }
}

class ThigmotaxisPatch : public testing::TestWithParam<Eq6Point> {};

// Over a patch Eq. 6 is the mean of its rows at the points of the patch, by their shares.
TEST_P(ThigmotaxisPatch, RowsAreMeans) {
  const Tangle t(83);
  const std::vector<SplineSegment> segments = spline(t.model, t.kin.centre);
  Scene scene;
  scene.controller.contact_patch = 0.3;
  scene.controller.eq6_at = GetParam();
  for (const Eq6Slip slip : {Eq6Slip::paper, Eq6Slip::shape}) {
    for (const KnotEnd end : {KnotEnd::first, KnotEnd::last}) {
      ThigmotaxisCommand command = t.commands[static_cast<std::size_t>(end)];
      command.end = end;
      command.slip = slip;
      std::vector<PatchPoint> patch;
      std::vector<int> near;
      contact_patch(segments, scene, command.contact, end == KnotEnd::last, near, patch);
      ASSERT_GE(patch.size(), 3U);
      Eigen::Vector4d mean = Eigen::Vector4d::Zero();  // left sides, right sides
      const auto sides = [&] {
        const auto rows = eq6_rows(t.model, t.kin, segments, command, scene);
        const auto left = [&](const Row& row) {
          return row_velocity(row, t.kin.velocities(), t.state.qdot);
        };
        return Eigen::Vector4d(left(rows[0]), left(rows[1]), rows[0].rhs, rows[1].rhs);
      };
      const Eigen::Vector4d over_patch = sides();
      command.end = KnotEnd::neither;
      for (const auto& [contact, share] : patch) {
        command.contact = contact;
        mean += share * sides();
      }
      EXPECT_LT((over_patch - mean).norm(), 1e-12 * mean.norm());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Points, ThigmotaxisPatch,
                         testing::Values(Eq6Point::skin, Eq6Point::centreline));

TEST(ThigmotaxisRows, TakeTheObservedPatchForTheObservedEndAlone) {
  const Tangle t(83);
  Scene scene;
  scene.controller.contact_patch = 0.3;
  Observation seen = observe(t.model, t.state, scene);
  ASSERT_TRUE(seen.ends.first && seen.ends.last);
  const auto rows = [&](const Contact& contact, KnotEnd end, const Observation* found) {
    ThigmotaxisCommand command{contact, {0.5, 2}};
    command.end = end;
    return eq6_rows(t.model, seen.kin, seen.segments, command, scene, found);
  };
  const auto differ = [](const std::array<Row, 2>& x, const std::array<Row, 2>& y) {
    const auto as_numbers = [](const Row& row) {
      std::vector<double> numbers{row.rhs};
      for (const auto& [body, moment, force] : row.patch()->wrenches) {
        numbers.push_back(body);
        numbers.insert(numbers.end(), moment.begin(), moment.end());
        numbers.insert(numbers.end(), force.begin(), force.end());
      }
      return numbers;
    };
    return as_numbers(x[0]) != as_numbers(y[0]) || as_numbers(x[1]) != as_numbers(y[1]);
  };
  const Contact first = *seen.ends.first, last = *seen.ends.last;
  Contact further = first;
  further.segment_a += 2;
  for (const auto& [contact, end] :
       {std::pair(first, KnotEnd::first), {last, KnotEnd::last}, {further, KnotEnd::first}}) {
    EXPECT_FALSE(differ(rows(contact, end, &seen), rows(contact, end, nullptr)));
  }
  // Another patch shows at the end that it is of, and nowhere else.
  seen.patches.first.resize(1);
  seen.patches.first[0].share = 1;
  EXPECT_TRUE(differ(rows(first, KnotEnd::first, &seen), rows(first, KnotEnd::first, nullptr)));
  EXPECT_FALSE(
      differ(rows(further, KnotEnd::first, &seen), rows(further, KnotEnd::first, nullptr)));
  EXPECT_FALSE(differ(rows(last, KnotEnd::last, &seen), rows(last, KnotEnd::last, nullptr)));
  seen.patches = {};
  EXPECT_FALSE(differ(rows(first, KnotEnd::first, &seen), rows(first, KnotEnd::first, nullptr)));
}

// Eq. 6 by the paper's words: velocities of the two spline points at fixed parameters, by
// differences of positions, times the tangents. They are seen from the head, which turns. Speeds of
// some 20 cm/s: 1e-15 20 / 1e-6.
TEST(ThigmotaxisRows, AreEquationSixOfThePaper) {
  const Tangle t(83);
  const double e = 1e-6;
  const std::vector<SplineSegment> now = spline(t.model, t.kin.centre);
  const auto segments = [&](double time) {
    Kinematics kin;
    update_positions(t.model, advance(t.state.q, t.state.qdot, time), kin);
    return spline(t.model, kin.centre);
  };
  const std::vector<SplineSegment> after = segments(e);
  const std::vector<SplineSegment> before = segments(-e);
  const std::vector<Row> rows = t.at_once(t.commands, Eq6Point::centreline);
  ASSERT_EQ(rows.size(), 4U);
  for (int place = 0; place < 2; ++place) {
    const Contact& c = t.commands[place].contact;
    const Eigen::Vector3d a =
        (after[c.segment_a].point(c.t_a) - before[c.segment_a].point(c.t_a)) / (2 * e);
    const Eigen::Vector3d b =
        (after[c.segment_b].point(c.t_b) - before[c.segment_b].point(c.t_b)) / (2 * e);
    const Eigen::Vector3d tangent_a = now[c.segment_a].slope(c.t_a).normalized();
    const Eigen::Vector3d tangent_b = now[c.segment_b].slope(c.t_b).normalized();
    const Eigen::Vector3d turn = t.kin.twist.col(0).head<3>();
    const Eigen::Vector3d arm = now[c.segment_a].point(c.t_a) - now[c.segment_b].point(c.t_b);
    const Eigen::Vector3d slip = a - b - turn.cross(arm);
    EXPECT_GT(turn.cross(arm).norm(), 0.1);
    const auto velocity = [&](const Row& row) {
      return row_velocity(row, t.kin.velocities(), t.state.qdot);
    };
    EXPECT_NEAR(velocity(rows[2 * place]), tangent_a.dot(slip), 1e-6);
    EXPECT_NEAR(velocity(rows[2 * place + 1]), -tangent_b.dot(slip), 1e-6);
    EXPECT_EQ(rows[2 * place].rhs, t.commands[place].speed.a);
    EXPECT_EQ(rows[2 * place + 1].rhs, t.commands[place].speed.b);
  }
  for (const Row& row : rows) {
    EXPECT_EQ(row.lower, 0);
    EXPECT_EQ(row.upper, 5000 * h);  // soft: λ / h up to the cap
  }
}

TEST(Rows, VelocityIsTheDenseRow) {
  for (const Tangle& t : tangles(84)) {
    const std::vector<Row> rows = t.rows();
    const Eigen::VectorXd expected = dense_rows(t.model, t.kin, rows) * t.state.qdot;
    Eigen::VectorXd actual(expected.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      actual[i] = row_velocity(rows[i], t.kin.velocities(), t.state.qdot);
    }
    // Sums over 100 bodies of terms that cancel.
    EXPECT_LT(relative_error(actual, expected), 1e-12);
  }
}

// (C v)' λ = v' (C' λ): the force of a row works on the velocity that the row measures.
TEST(Rows, ForceIsTheTransposeOfVelocity) {
  Random random(86);
  for (const Tangle& t : tangles(85)) {
    for (const Row& row : t.rows()) {
      const Eigen::VectorXd v = random_entries(random, t.model.nv());
      const double lambda = uniform(random, -3, 3);
      Matrix6Xd wrench = Matrix6Xd::Zero(6, t.model.body_count());
      Eigen::VectorXd joint = Eigen::VectorXd::Zero(t.model.nv());
      add_row(row, t.kin, lambda, wrench, joint);
      const Eigen::VectorXd force = generalised_force(t.model, t.kin, wrench) + joint;
      const double scale = force.cwiseAbs().dot(v.cwiseAbs());
      const Matrix6Xd twist = body_twists(t.model, t.kin, v);
      const double velocity = row_velocity(row, {twist, centre_velocities(t.kin, twist)}, v);
      EXPECT_NEAR(lambda * velocity, v.dot(force), 1e-13 * scale) << row_name(t.model, row);
    }
  }
}

TEST(Rows, TowardsTheTailBothTangentsTurn) {
  const Tangle t(86);
  const std::vector<Row> headward = t.at_once(t.commands);
  std::vector<ThigmotaxisCommand> back = t.commands;
  for (ThigmotaxisCommand& command : back) command.towards = BodyEnd::tail;
  const std::vector<Row> tailward = t.at_once(back);
  ASSERT_EQ(tailward.size(), headward.size());
  for (std::size_t i = 0; i < headward.size(); ++i) {
    EXPECT_EQ(tailward[i].points().direction, -headward[i].points().direction);
    EXPECT_EQ(tailward[i].rhs, headward[i].rhs);
    EXPECT_EQ(tailward[i].upper, headward[i].upper);
    EXPECT_EQ(tailward[i].id, headward[i].id);
  }
}

TEST(Rows, EachHasItsOwnIdAndKeepsIt) {
  const Tangle t(87);
  for (const Tangle& one : {t, Tangle(87, cone_hagfish())}) {
    const std::vector<Row> rows = one.rows();
    std::set<RowId> ids;
    for (const Row& row : rows) ids.insert(row.id);
    EXPECT_EQ(ids.size(), rows.size());
  }

  // The same constraint after a move, and in a list that lacks others.
  Tangle moved = t;
  moved.state.q = advance(t.state.q, t.state.qdot, 1e-4);
  const std::vector<Row> all = limit_rows(t.model, t.state, speculative, h);
  const std::vector<Row> later = limit_rows(t.model, moved.state, speculative, h);
  ASSERT_EQ(all.size(), later.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].id, later[i].id);
  const ContactSet last{{t.set.contacts.back()}, {}, {}, 0};
  EXPECT_EQ(contact_rows(t.model, last, speculative, h)[0].id,
            contact_rows(t.model, t.set, speculative, h)[t.set.contacts.size() - 1].id);
}

TEST(Rows, HaveNamesThatSayWhichTheyAre) {
  const Model fish = table1_hagfish();
  State state = rest_state(fish);
  const std::vector<Row> limits = limit_rows(fish, state, speculative, h);
  EXPECT_EQ(row_name(fish, limits[0]), "lower limit of j01_bend_z");
  EXPECT_EQ(row_name(fish, limits[3]), "upper limit of j01_bend_y");
  EXPECT_EQ(row_name(fish, limits[4]), "lower limit of j02_twist");
  for (const Tangle& t : tangles(88)) {
    std::set<std::string> names;
    for (const Row& row : t.rows()) names.insert(row_name(t.model, row));
    EXPECT_EQ(names.size(), t.rows().size());
  }
}

}  // namespace hagfish::rows_test
