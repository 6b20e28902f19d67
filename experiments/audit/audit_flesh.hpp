// The part of an audit that recomputes the forces of flesh from q and q̇ by their law, and the
// energy that it stores by a search of its own.
#pragma once

#include <vector>

#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/logged_contacts.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

class FleshAudit {
 public:
  /// The log is referred to.
  explicit FleshAudit(const LogContents& log);
  /// Frames in their order.
  void see(const AuditedFrame& frame);
  /// None of a scene with hard contact.
  std::vector<Finding> findings() const;

 private:
  double weight_of(const AuditedFrame& frame, const LoggedContact& contact) const;
  double stored_between_strands(const std::vector<SplineSegment>& segments) const;
  double stored_in_planes(const Kinematics& kin) const;

  const LogContents& log_;
  std::vector<LoggedContact> contacts_;
  std::vector<double> energy_;
  std::size_t next_contact_ = 0;  ///< first one of frames not seen yet
  Rebuilt rebuilt_;
};

}  // namespace hagfish
