// The part of an audit that recomputes /muscle: what activations make of the logged shape.
#pragma once

#include <vector>

#include "core/muscle/activation.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

class ActivationAudit {
 public:
  /// The log is referred to.
  explicit ActivationAudit(const LogContents& log);
  /// Frames in their order.
  void see(const AuditedFrame& frame);
  /// None of a scene without muscles.
  std::vector<Finding> findings() const;

 private:
  void see_driven(const AuditedFrame& frame);

  const LogContents& log_;
  Hdf5Reader::Rows torque_;  ///< mean of u + f_thigmo
  Hdf5Reader::Rows activation_, residual_, driven_, active_;
  ActivationSolver solver_;
  MuscleEffort effort_;    ///< storage
  Eigen::VectorXd given_;  ///< R a F_max, storage
  Rebuilt rebuilt_;
  double beyond_ = 0;  ///< way of an activation between two frames, past what the dynamics permit
};

}  // namespace hagfish
