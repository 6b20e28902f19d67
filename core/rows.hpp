// Constraint rows C q̇ >= d and G q̇ = e of the step's QP (paper, Eqs. 3, 4 and 6), all kept as one
// list: a row is a unit dof or forces on a few body centres, with bounds on its multiplier.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/articulated.hpp"
#include "core/contact.hpp"
#include "core/kinematics.hpp"
#include "core/model.hpp"
#include "core/settings.hpp"
#include "core/state.hpp"

namespace hagfish {

enum class RowKind : std::uint8_t { head, limit, contact, wall, thigmotaxis };

struct Row {
  RowKind kind = RowKind::limit;
  /// Same from step to step for the same physical constraint: limits by dof and side, contacts by
  /// segments, thigmotaxis by place and tangent.
  std::int64_t id = 0;
  int dof = -1;     ///< unit row: C q̇ = sign * q̇[dof]; -1 where forces are used
  double sign = 1;  ///< +1 or -1
  struct BodyForce {
    int body = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< at the body's centre, world, per unit λ
  };
  std::array<BodyForce, 8> force{};  ///< C q̇ = Σ force . centre velocity
  int forces = 0;
  double rhs = 0;      ///< d, cm/s or rad/s
  bool waits = false;  ///< enters the problem only once a solution without it violates it
  double lower = 0;    ///< bounds on the multiplier λ, dyn s or dyn cm s
  double upper = std::numeric_limits<double>::infinity();
};

/// "limit of j05_bend_y (upper)", "contact of bodies 31 and 74", ...
std::string row_name(const Model& model, const Row& row);

/// C q̇ of one row at body twists (6 x N) and velocities (nv).
double row_velocity(const Row& row, const Kinematics& kin, const Matrix6Xd& twist,
                    const Eigen::VectorXd& v);

/// Adds C' λ of one row: to the bodies' wrenches (6 x N) or the joint forces (nv).
void add_row(const Row& row, const Kinematics& kin, double lambda, Matrix6Xd& wrench,
             Eigen::VectorXd& joint);

/// Six bilateral rows that hold the root at the origin and unturned (paper, Eq. 3); a drift is
/// taken back at the rate push_out / h.
std::vector<Row> head_rows(const State& state, const ConstraintSettings& settings, double h);

/// One row per bounded side of each hinge.
std::vector<Row> limit_rows(const Model& model, const State& state,
                            const ConstraintSettings& settings, double h);

/// One row per contact, the exact rate of its gap; those that are no local minimum wait.
std::vector<Row> contact_rows(const Model& model, const ContactSet& contacts,
                              const ConstraintSettings& settings, double h);

/// One row per body behind the neck: it stays clear of the head plate x = 0.
std::vector<Row> wall_rows(const Model& model, const Kinematics& kin, const WallSettings& wall,
                           const ConstraintSettings& settings, double h);

/// Commanded sliding at one contact.
struct ThigmotaxisCommand {
  Contact contact;
  ThigmotaxisSpeeds speed;
};

/// Eq. 6 at the first and the last contact: rows t_a, t_b of each. `cap` bounds λ / h (dyn).
std::vector<Row> thigmotaxis_rows(const Model& model,
                                  const std::vector<ThigmotaxisCommand>& commands, double cap,
                                  double h);

}  // namespace hagfish
