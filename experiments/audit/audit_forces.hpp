// The part of an audit that recomputes every force from q, q̇, the contacts' spline parameters and
// the multipliers, and holds their sum against the motion.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "experiments/audit/audit_thigmotaxis.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/logged_contacts.hpp"
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
  void see_contacts(const AuditedFrame& frame);
  void see_limits(const AuditedFrame& frame);
  /// `force` on the two hinges of a cone's joint, dyn cm.
  void see_cone(const AuditedFrame& frame, const BendingCone& cone, const Eigen::Vector2d& force);
  void see_head(const AuditedFrame& frame);
  void see_balance(const AuditedFrame& frame);
  void see_means(const AuditedFrame& frame, const ThigmotaxisAudit::Rows& rows);

  const LogContents& log_;
  ThigmotaxisAudit rows_;
  ByKind<Hdf5Reader::Rows> force_, mean_;
  Hdf5Reader::Rows tip_, active_torque_, mean_active_, mean_net_, mean_lambda_;
  std::vector<LoggedContact> contacts_;
  std::vector<double> remaining_;  ///< StepMiddle::remaining of each step, by the midpoint rule
  Steps steps_;
  std::size_t next_contact_ = 0;  ///< first one of frames not seen yet
  Rebuilt from_rows_;
  double imbalance_ = 0, unsettled_ = 0, mean_imbalance_ = 0, limit_miss_ = 0, cone_miss_ = 0,
         cone_turn_ = 0;
  double momentum_ = 0, momentum_before_ = 0;  ///< largest over h, at this frame and the one before
  std::set<std::string> shape_;                ///< datasets with a force where there can be none
  ThigmotaxisAudit::Rows rows_before_;         ///< rows of the frame before
  std::vector<double> mean_deviation_;         ///< how far mean f_thigmo is off C' mean λ, shares
};

}  // namespace hagfish
