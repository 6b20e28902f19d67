// Constraint rows C q̇ >= d and G q̇ = e of the step's QP (paper, Eqs. 3, 4 and 6), in one list. A
// row constrains a single dof, two dofs of a joint, or the relative motion of two points or over a
// patch of contact. Its multiplier has bounds.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/chain/articulated.hpp"
#include "core/chain/bending.hpp"
#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "core/contact/contact.hpp"
#include "core/contact/spline.hpp"
#include "core/scene/settings.hpp"
#include "core/step/rows/row_kind.hpp"

namespace hagfish {

/// A force and its moment about kin.reference, world axes.
struct BodyWrench {
  int body = 0;
  Eigen::Vector3d moment, force;
};

struct Row {
  RowKind kind = RowKind::limit;
  /// C q̇ = sign * q̇[dof] + next_sign * q̇[dof + 1]; -1 of a row with points or a patch.
  int dof = -1;
  double sign = 1;       ///< of a unit row +1 or -1
  double next_sign = 0;  ///< of a unit row 0
  /// The same physical constraint has the same id in every step. The id of a limit has its dof and
  /// side, of a cone its dof, of a contact its segments, of a plane the body. The id of a row of
  /// Eq. 6 has its tangent and the knot's end or the segments. Cones, contacts and planes may have
  /// several rows in a step, and their number is part of the id.
  std::int64_t id = 0;
  int obstacle = -1;  ///< of an obstacle's row: its index
  int command = -1;   ///< of a thigmotaxis row: the index of its command
  /// C q̇ = direction . (ẋ_a - ẋ_b), each point a mix of body centres; `b` may have none.
  Eigen::Vector3d direction;  ///< unit, world
  SplineMix a, b;
  /// One point in space for both strands, from kin.reference, cm. ẋ_a and ẋ_b are then the
  /// velocities of the rigid bodies at this point, mixed with the same weights. The forces of such
  /// a row are internal: their sum and their moment are zero.
  std::optional<Eigen::Vector3d> at;
  /// Of a row that is seen from the head: the couple at the head per unit λ that takes up the
  /// moment of the forces at the two points, world axes, cm.
  std::optional<Eigen::Vector3d> head_couple;
  /// Of a row of Eq. 6 over a patch of contact: C' of each body that takes part, rising. The points
  /// above are then only where the patch begins.
  std::vector<BodyWrench> patch;
  double rhs = 0;  ///< d, cm/s or rad/s
  /// The part of λ of an impact, which acts at once. Half of the rest acts before the middle of the
  /// step (midpoint rule, midpoint/impacts.hpp).
  double impact = 0;
  double lower = 0;  ///< bounds on the multiplier λ, dyn s or dyn cm s
  double upper = std::numeric_limits<double>::infinity();
  /// A unit row whose velocity is prescribed, C q̇ = d; λ is its reaction.
  bool prescribed = false;

  bool unit() const { return dof >= 0 && next_sign == 0; }
};

/// A row that was added since the path of the step overlaps (look_ahead.hpp). `contact` is its
/// contact, if any, at the step's start.
struct PathRow {
  Row row;
  std::optional<Contact> contact;
};

/// Calls `visit(body, moment, force)` for each force of a row with points, or of a patch: world
/// axes, per unit λ, moments about kin.reference. C q̇ is the sum of their powers.
template <class Visit>
void visit_forces(const Row& row, const Kinematics& kin, Visit visit) {
  for (const BodyWrench& wrench : row.patch) visit(wrench.body, wrench.moment, wrench.force);
  if (!row.patch.empty()) return;
  const auto of_mix = [&](const SplineMix& mix, double sign) {
    for (int k = 0; k < mix.count; ++k) {
      const int body = mix.first + k;
      const Eigen::Vector3d force = sign * mix.weight[k] * row.direction;
      const Eigen::Vector3d offset = row.at ? *row.at : kin.centre_offset(body);
      visit(body, offset.cross(force).eval(), force);
    }
  };
  of_mix(row.a, 1);
  of_mix(row.b, -1);
  if (row.head_couple) visit(0, *row.head_couple, Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

/// "limit of j05_bend_y (upper)", "contact of bodies 31 and 74", ...
std::string row_name(const Model& model, const Row& row);

/// The order of a step's rows, rising. Prescribed rows, and those of the head in any case, come
/// first, by dof. The others follow from the tail on, by the last velocity that they involve. This
/// order makes the columns of the dual problem a staircase.
int place_in_step(const Model& model, const Row& row);

/// Which contact of a knot: the first or last one, which the controller follows, or another.
enum class KnotEnd : std::uint8_t { first, last, neither };

/// The Row::id of a row of Eq. 6 at an end of the knot, or at another `contact`.
std::int64_t thigmotaxis_row_id(KnotEnd end, const Contact& contact, bool on_a);

/// Whether a thigmotaxis row is along t_a; else it is along t_b.
bool along_a(const Row& row);

/// C v of one row at velocities `v` (nv), by which the bodies move as `bodies` says.
double row_velocity(const Row& row, const BodyVelocities& bodies, const Eigen::VectorXd& v);

/// Adds C' λ of one row: to the bodies' wrenches (6 x N) or the joint forces (nv).
void add_row(const Row& row, const Kinematics& kin, double lambda, Matrix6Xd& wrench,
             Eigen::VectorXd& joint);

// The functions below append rows: a step gathers all kinds in one list and reuses its storage.

/// Selects the unilateral rows near binding. Most of the animal's 500 rows are far from it.
struct NearBinding {
  const Eigen::VectorXd& v;  ///< a velocity, nv
  BodyVelocities bodies;     ///< at it
  double slack;              ///< rows of angles are near where C v - d is below this, rad/s
  double slack_at_rest;      ///< or where -d is below this: they touch
  double radius = 1;         ///< rows of points: both bounds times this, cm

  bool operator()(double row_velocity, double rhs) const {
    return row_velocity - rhs < slack || -rhs < slack_at_rest;
  }
  bool of_points(double row_velocity, double rhs) const {
    return row_velocity - rhs < radius * slack || -rhs < radius * slack_at_rest;
  }
};

/// Sets a row to the relative motion along `direction` of the two spline points of a contact. An
/// obstacle is at rest.
void set_points(Row& row, const Contact& contact, const Eigen::Vector3d& direction,
                const Model& model);

/// The row of a contact without a right-hand side: the exact rate of its gap. Where `at` is null,
/// the points are where the contact was found. Else they are the same points of the segments `at`.
/// `number` is 0 for the row of the step's start, and counts the rows that are added later
/// (look_ahead.hpp).
Row contact_row(const Model& model, const Contact& contact, const std::vector<SplineSegment>* at,
                int number = 0);
/// The row of body `body` against a plane, without a right-hand side.
Row plane_row(const Model& model, int obstacle, int body);

/// The row of a joint bent by `bend`, without a right-hand side: the exact rate of the angle that
/// is left to its cone. `number` as above.
Row cone_row(const BendingCone& cone, const Bend& bend, int number);

/// Six bilateral rows that hold the root at the origin without rotation (paper, Eq. 3). They
/// correct a drift at the rate baumgarte / h.
void append_head_rows(const State& state, const ConstraintSettings& settings, double h,
                      std::vector<Row>& rows);

/// One row for each bounded side of each hinge, the nearer side first, and one for each cone unless
/// its joint is straight.
void append_limit_rows(const Model& model, const State& state, const ConstraintSettings& settings,
                       double h, const NearBinding& wanted, std::vector<Row>& rows);

/// The Row::id of the contact's row.
std::int64_t contact_row_id(const Contact& contact);

/// The row of a contact at `at`: the exact rate of its gap.
void append_contact_row(const Model& model, const Contact& contact,
                        const std::vector<SplineSegment>* at, const ConstraintSettings& settings,
                        double h, const NearBinding& wanted, std::vector<Row>& rows);

/// One row for each body and each plane that holds it.
void append_plane_rows(const Model& model, const Kinematics& kin,
                       const ConstraintSettings& settings, double h, const NearBinding& wanted,
                       std::vector<Row>& rows);

}  // namespace hagfish
