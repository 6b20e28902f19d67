// The part of an audit that needs MuJoCo: do the logged forces make the logged motion there too?
#pragma once

#include <memory>

#include "experiments/audit/audit.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {

/// Each frame's forces put back as applied forces in the log's own MuJoCo model, with its contacts
/// and limits off: one step must end at the logged q̇, or, by the midpoint rule, half a step at the
/// mean of the velocities before and after. Drag is the core's, at that velocity. Not judged, and
/// so told, where the program is built without MuJoCo.
class ForwardInverseAudit {
 public:
  /// Throws FileError where /mjcf is not the scene's model.
  explicit ForwardInverseAudit(const LogContents& log);
  ~ForwardInverseAudit();
  void see(const AuditedFrame& frame);
  Finding finding() const;

 private:
  struct Driven;
  std::unique_ptr<Driven> driven_;
};

}  // namespace hagfish
