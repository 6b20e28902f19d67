// The part of an audit that recomputes every force from q, q̇, the contacts' spline parameters and
// the multipliers, and holds their sum against the motion.
#pragma once

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

class ForceAudit {
 public:
  /// The log is referred to.
  explicit ForceAudit(const LogContents& log);
  /// Frames in their order.
  void see(const AuditedFrame& frame);
  std::vector<Finding> findings() const;

 private:
  /// Gives C_thigmo', nv x 4, zero where there is no row.
  Eigen::MatrixXd see_thigmotaxis(const AuditedFrame& frame);
  /// Hinges and cones with a force.
  std::int64_t bearing_limits(const AuditedFrame& frame) const;
  std::int64_t bearing_cones(const AuditedFrame& frame) const;
  /// The bound on the forces of rows, where there are `rows`.
  void see_cap(const AuditedFrame& frame, bool rows);
  void see_contacts(const AuditedFrame& frame);
  void see_limits(const AuditedFrame& frame);
  /// `force` on the two hinges of a cone's joint, dyn cm.
  void see_cone(const AuditedFrame& frame, const BendingCone& cone, const Eigen::Vector2d& force);
  void see_head(const AuditedFrame& frame);
  void see_tip(const AuditedFrame& frame);
  void see_balance(const AuditedFrame& frame);
  void see_means(const AuditedFrame& frame, const Eigen::MatrixXd& columns);

  const LogContents& log_;
  Hdf5Reader::Rows thigmotaxis_, contact_, limit_, head_, wall_, tip_, active_torque_;
  Hdf5Reader::Rows lambda_, command_, speed_, spline_a_, spline_b_, body_a_, body_b_;
  std::array<Hdf5Reader::Rows, 6> mean_;  ///< thigmotaxis, contact, limit, head, wall, active
  Hdf5Reader::Rows mean_net_, mean_lambda_;
  std::vector<std::int64_t> contact_frame_, active_;
  std::vector<double> middle_off_;  ///< of each step, by the midpoint rule
  Steps steps_;
  std::vector<double> cap_, contact_a_, contact_b_, contact_force_;
  double pull_from_ = NAN;        ///< time of the last frame before the pull, s
  std::size_t next_contact_ = 0;  ///< first one of frames not seen yet
  Rebuilt from_rows_;
  double imbalance_ = 0, unsettled_ = 0, mean_imbalance_ = 0, limit_miss_ = 0, cone_miss_ = 0,
         cone_turn_ = 0, ask_miss_ = 0, most_ = 0;
  double momentum_ = 0, momentum_before_ = 0;  ///< largest over h, at this frame and the one before
  std::set<std::string> shape_;                ///< datasets with a force where there can be none
  Eigen::MatrixXd columns_before_;             ///< C_thigmo' of the frame before, nv x 4
  std::vector<double> mean_deviation_;         ///< of mean f_thigmo from C' of the mean λ, shares
};

}  // namespace hagfish
