#include "experiments/audit/audit_parts.hpp"

#include <algorithm>
#include <cmath>

#include "core/control/laws.hpp"
#include "core/control/muscle_law.hpp"

namespace hagfish {
namespace {

constexpr double activation_rounding = 1e-9;

/// Activations are found to some 1e-9 from torques of 1e5 dyn cm that machines round otherwise.
constexpr double activation_tolerance = 1e-8;

}  // namespace

ActivationAudit::ActivationAudit(const LogContents& log) : log_(log) {
  if (log.model.muscles.empty()) return;
  torque_ = log.h5.rows("/mean/forces/active") + log.h5.rows("/mean/forces/thigmotaxis");
  activation_ = log.h5.rows("/muscle/activation");
  residual_ = log.h5.rows("/muscle/residual");
  const auto numbers = law_of(log.resolved.scene).numbers;
  if (std::ranges::find(numbers, std::string_view(driven_activations), &LawNumbers::path) !=
      numbers.end()) {
    driven_ = log.h5.rows(driven_activations);
    active_ = log.h5.rows("/forces/active");
  }
}

void ActivationAudit::see(const AuditedFrame& frame) {
  if (log_.model.muscles.empty()) return;
  const Eigen::Index f = frame.index;
  const Eigen::VectorXd activation = activation_.row(f);
  const Eigen::VectorXd residual = residual_.row(f);
  if (driven_.size() > 0 && frame.begins_step) see_driven(frame);
  Eigen::VectorXd torque = torque_.row(f);
  if (f == 0) {  // no means before it
    rebuilt_.compare("/muscle/activation", activation,
                     Eigen::VectorXd::Constant(activation.size(), NAN));
    rebuilt_.compare("/muscle/residual", residual, Eigen::VectorXd::Constant(residual.size(), NAN));
    return;
  }
  torque.head<root_dofs>().setZero();
  const Kinematics& kin = frame.observation.kin;
  solver_.solve(log_.model, kin, torque, effort_);
  rebuilt_.compare("/muscle/activation", activation, effort_.activation, activation_tolerance);
  muscle_torque(log_.model, kin, activation, given_);
  rebuilt_.compare("/muscle/residual", residual, torque - given_,
                   activation_rounding * torque.lpNorm<Eigen::Infinity>());
}

void ActivationAudit::see_driven(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  muscle_torque(log_.model, frame.observation.kin, driven_.row(f).transpose(), given_);
  // In phases without the law there is neither.
  if (driven_.row(f).allFinite())
    rebuilt_.compare("/forces/active", active_.row(f).transpose(), given_);
  if (f == 0) return;
  // e stays between 0 and 1, so that a cannot come nearer to either than by the whole of them.
  const double kept =
      std::exp(-(log_.time[f] - log_.time[f - 1]) / log_.resolved.scene.muscle.activation_time);
  for (Eigen::Index m = 0; m < driven_.cols(); ++m) {
    const double before = driven_(f - 1, m);
    const double way = driven_(f, m) - before;
    beyond_ = worse(beyond_, std::abs(way) - (1 - kept) * (way > 0 ? 1 - before : before));
  }
}

std::vector<Finding> ActivationAudit::findings() const {
  if (log_.model.muscles.empty()) return {};
  std::vector<Finding> findings{
      rebuilt_.finding("activations", "means of u + f_thigmo, q and the specimen's muscles")};
  if (driven_.size() > 0) {
    findings.push_back(judged_over({"activation dynamics", beyond_, activation_rounding, "1"},
                                   "between frames, past the fastest"));
  }
  return findings;
}

}  // namespace hagfish
