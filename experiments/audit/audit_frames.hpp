// The part of an audit that recomputes a log's figures from q and q̇: where the body is, how it is
// knotted, its energies and how well it keeps its bounds.
#pragma once

#include <vector>

#include "core/knot/knot.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/logged_contacts.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

class FrameAudit {
 public:
  /// The log is referred to.
  explicit FrameAudit(const LogContents& log);
  /// Frames in their order. `knot` is the type of this frame's centreline.
  void see(const AuditedFrame& frame, const KnotVote& knot);
  std::vector<Finding> findings() const;

 private:
  Finding skin() const;
  void see_trajectory(const AuditedFrame& frame);
  void see_knot(const AuditedFrame& frame, const KnotVote& knot);
  void see_fold(const AuditedFrame& frame);
  void see_energy(const AuditedFrame& frame);
  void see_bounds(const AuditedFrame& frame);
  void see_worst_at_end(const Observation& end, double drift);
  void see_motion(const AuditedFrame& frame);

  const LogContents& log_;
  Steps steps_;
  std::vector<std::int64_t> step_, determinant_, v2_, contacts_;
  std::vector<LoggedContact> bearing_;
  std::vector<double> agreement_, head_end_, tail_end_, kinetic_, elastic_, gravity_, integrator_,
      integrator_error_, skin_fold_, penetration_, left_out_, limit_violation_, head_drift_;
  Hdf5Reader::Rows position_, momentum_, angular_momentum_, spline_a_, spline_b_;
  int last_order_ = 0;
  double largest_fold_ = 0;  ///< while the knot is held
  std::int64_t held_ = 0, folded_ = 0;
  std::int64_t frames_ = 0, contacts_off_ = 0, contacts_off_by_ = 0, followed_ = 0, late_ = 0;
  /// The centre of mass at the frame before, cm, its velocity there, cm/s, and the
  /// furthest that it was off since, of what is allowed.
  Eigen::Vector3d centre_before_ = Eigen::Vector3d::Zero(), left_with_ = centre_before_;
  double off_way_ = 0;
  Rebuilt by_itself_, from_q_;
};

}  // namespace hagfish
