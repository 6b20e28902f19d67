// The part of an audit that follows the body from frame to frame: its contacts, and that it goes
// where its velocities take it.
#pragma once

#include <vector>

#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/logged_contacts.hpp"
#include "experiments/judge/expectations.hpp"

namespace hagfish {

class FrameAudit {
 public:
  /// The log is referred to.
  explicit FrameAudit(const LogContents& log);
  /// Frames in their order.
  void see(const AuditedFrame& frame);
  std::vector<Finding> findings() const;

 private:
  void see_ends(const AuditedFrame& frame);
  void see_contacts(const AuditedFrame& frame);
  void see_motion(const AuditedFrame& frame);

  const LogContents& log_;
  Steps steps_;
  std::vector<std::int64_t> contacts_;
  std::vector<LoggedContact> bearing_;
  std::vector<double> left_out_;
  Hdf5Reader::Rows spline_a_, spline_b_;
  std::int64_t frames_ = 0, contacts_off_ = 0, contacts_off_by_ = 0, followed_ = 0, late_ = 0;
  /// The centre of mass at the frame before, cm, its velocity there, cm/s, and the
  /// furthest that it was off since, of what is allowed.
  Eigen::Vector3d centre_before_ = Eigen::Vector3d::Zero(), left_with_ = centre_before_;
  double off_way_ = 0;
};

}  // namespace hagfish
