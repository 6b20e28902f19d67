// The part of an audit that recomputes the forces of flesh from q and q̇ by their law, and the
// energy that it stores, its deepest overlap and its largest pressure by a search of its own.
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
  /// Of one frame: energy stored, erg; deepest overlap, cm; largest pressure, dyn/cm².
  struct Pressed {
    double energy = 0, overlap = 0, pressure = 0;
  };
  /// Adds a point of a length (cm) and its curvature, 1/r of both skins, 1/cm; none of a gap > 0.
  void press(double gap, double weight, double curvature, Pressed& pressed) const;
  void press_strands(const std::vector<SplineSegment>& segments, Pressed& pressed) const;
  void press_planes(const Kinematics& kin, Pressed& pressed) const;
  double weight_of(const AuditedFrame& frame, const LoggedContact& contact) const;

  const LogContents& log_;
  std::vector<LoggedContact> contacts_;
  std::vector<double> energy_, overlap_, pressure_;  ///< of frames; the last two x bodies
  std::size_t next_contact_ = 0;                     ///< first one of frames not seen yet
  Rebuilt rebuilt_;
};

}  // namespace hagfish
