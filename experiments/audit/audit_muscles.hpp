// The part of an audit that recomputes what muscles do: the rest shape from the program, the body
// and its past, and the torques towards it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/run/laws.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

class MuscleAudit {
 public:
  /// The log is referred to.
  explicit MuscleAudit(const LogContents& log);
  /// Frames in their order.
  void see(const AuditedFrame& frame);
  std::vector<Finding> findings() const;

 private:
  void see_torque(const AuditedFrame& frame);
  void see_rest_shape(const AuditedFrame& frame);
  /// What the law asks of the hinges besides, added to `torque`, dyn cm, nv.
  void see_law(const AuditedFrame& frame, Eigen::VectorXd& torque);
  LoggedSituation situation(const AuditedFrame& frame) const;
  /// As Law::rest_shape.
  std::optional<Eigen::VectorXd> shape_of_law(const AuditedFrame& frame) const;
  bool has_rest_shape(const AuditedFrame& frame) const;

  const LogContents& log_;
  const Law& law_;
  Hdf5Reader::Rows torque_, q_ref_;
  Hdf5Reader::Rows asked_, asked_rate_;       ///< besides, by a law of the run's own
  std::vector<std::int64_t> has_rest_shape_;  ///< likewise
  std::vector<Hdf5Reader::Rows> numbers_;     ///< of its memory
  Rebuilt rebuilt_;
  std::set<std::string> on_root_;       ///< datasets with an entry there, where nothing holds on
  std::vector<double> tone_deviation_;  ///< of q_ref that follows q, shares of the motion
};

}  // namespace hagfish
