// Constraint rows C q̇ >= d and G q̇ = e of the step's QP (paper, Eqs. 3, 4 and 6), in one list. A
// row constrains a single dof, two dofs of a joint, or the relative motion of two points or over a
// patch of contact. Its multiplier has bounds.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
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

/// A contact of a knot: the first or last one, which the controller follows, or another.
enum class KnotEnd : std::uint8_t { first, last, neither };

/// Identity of a row: one physical constraint has the same id in every step.
struct RowId {
  enum class Of : std::uint8_t {
    head,
    lower,
    upper,
    cone,
    contact,
    plane,
    strand,
    along_a,
    along_b,
    flesh
  };
  Of of = Of::head;
  KnotEnd end = KnotEnd::neither;  ///< end of a row of Eq. 6
  /// Head and limits: the dof. Plane: body, obstacle. Contacts, strands, and rows of Eq. 6 at
  /// neither end of the knot: segments. Flesh: the point's segment, its foot's segment.
  int first = 0, second = 0;
  int number = 0;  ///< cones, contacts, planes and flesh may have several rows in a step

  auto operator<=>(const RowId&) const = default;
};

/// C q̇ = sign q̇[dof] + next_sign q̇[dof + 1]. A *unit row* has sign +1 or -1 and next_sign 0.
struct OnJoint {
  int dof = -1;
  double sign = 1;       ///< coefficient of q̇[dof]
  double next_sign = 0;  ///< coefficient of q̇[dof + 1]
};

/// C q̇ = direction . (ẋ_a - ẋ_b), each point a mix of body centres; `b` may have none.
struct BetweenPoints {
  Eigen::Vector3d direction;  ///< unit, world
  SplineMix a, b;
  /// One point in space for both strands, from kin.reference, cm. ẋ_a and ẋ_b are then the
  /// velocities of the rigid bodies at this point, mixed with the same weights. The forces of such
  /// a row are internal: their sum and their moment are zero.
  std::optional<Eigen::Vector3d> at;
  /// The couple at the head, per unit λ, of a row that is seen from the head. It takes up the
  /// moment of the forces at the two points. World axes, cm.
  std::optional<Eigen::Vector3d> head_couple;
};

/// The mean of rows between points over a patch of contact (Eq. 6), of which the points are only
/// where the patch begins.
struct OverPatch : BetweenPoints {
  std::vector<BodyWrench> wrenches;  ///< C' on each body that takes part, rising
};

/// One row of C q̇ >= d, of C q̇ = d, or of C q̇ + compliance λ >= d.
struct Row {
  RowKind kind = RowKind::limit;
  RowId id;
  std::variant<OnJoint, BetweenPoints, OverPatch> shape;
  int obstacle = -1;  ///< index of the obstacle, in rows of obstacles
  int command = -1;   ///< index of the command, in rows of thigmotaxis
  double rhs = 0;     ///< d, cm/s or rad/s
  /// The part of λ of an impact, which acts at once. Half of the rest acts before the middle of the
  /// step (midpoint rule, midpoint/impacts.cpp).
  double impact = 0;
  double lower = 0;  ///< bounds on the multiplier λ, dyn s or dyn cm s
  double upper = INFINITY;
  /// Flesh yields: C q̇ + compliance λ >= d, cm/s over dyn s; 0 in hard rows (flesh_rows.hpp).
  double compliance = 0;
  double damper = 0;  ///< damping of flesh, k' w τ, dyn s/cm; 0 before skins touch
  /// A unit row whose velocity is prescribed, C q̇ = d; λ is its reaction.
  bool prescribed = false;

  /// Null where it has another shape.
  const OnJoint* joint() const { return std::get_if<OnJoint>(&shape); }
  const OverPatch* patch() const { return std::get_if<OverPatch>(&shape); }
  /// The points of a row that is not on a joint.
  const BetweenPoints& points() const {
    const OverPatch* over = patch();
    return over != nullptr ? *over : std::get<BetweenPoints>(shape);
  }
  bool unit() const { return joint() != nullptr && joint()->next_sign == 0; }
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
  if (row.joint() != nullptr) return;
  if (const OverPatch* patch = row.patch()) {
    for (const auto& [body, moment, force] : patch->wrenches) visit(body, moment, force);
    return;
  }
  const BetweenPoints& points = row.points();
  const auto of_mix = [&](const SplineMix& mix, double sign) {
    for (int k = 0; k < mix.count; ++k) {
      const int body = mix.first + k;
      const Eigen::Vector3d force = sign * mix.weight[k] * points.direction;
      const Eigen::Vector3d offset = points.at ? *points.at : kin.centre_offset(body);
      visit(body, offset.cross(force).eval(), force);
    }
  };
  of_mix(points.a, 1);
  of_mix(points.b, -1);
  if (points.head_couple) visit(0, *points.head_couple, Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

/// "limit of j05_bend_y (upper)", "contact of bodies 31 and 74", ...
std::string row_name(const Model& model, const Row& row);

/// The order of a step's rows, rising. Prescribed rows, and those of the head in any case, come
/// first, by dof. The others follow from the tail on, by the last velocity that they involve. This
/// order makes the columns of the dual problem a staircase.
int order_in_step(const Model& model, const Row& row);

/// Whether a thigmotaxis row is along t_a; else it is along t_b.
bool along_a(const Row& row);

/// C v of one row at velocities `v` (nv), by which the bodies move as `bodies` says.
double row_velocity(const Row& row, const BodyVelocities& bodies, const Eigen::VectorXd& v);

/// Adds C' λ of one row: to the bodies' wrenches (6 x N) or the joint forces (nv).
void add_row(const Row& row, const Kinematics& kin, double lambda, Matrix6Xd& wrench,
             Eigen::VectorXd& joint);

}  // namespace hagfish
