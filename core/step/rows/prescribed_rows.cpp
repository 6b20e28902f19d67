#include "core/step/rows/prescribed_rows.hpp"

namespace hagfish {
namespace {

bool probably_binds(const Row& row, const WarmStart& warm) {
  if (row.kind == RowKind::head) return true;
  return row.kind == RowKind::limit && row.unit() && warm.multiplier(row.id) > 0;
}

template <class Condition>
bool release_where(StepSolution& step, Condition condition) {
  bool any = false;
  for (Eigen::Index i = 0; i < step.prescribed; ++i) {
    if (condition(i)) {
      step.rows[i].prescribed = false;
      any = true;
    }
  }
  return any;
}

}  // namespace

void prescribe_rows(const WarmStart& warm, std::vector<Row>& rows) {
  int last = -1;  // at most one of a joint's two limits, which follow each other
  for (Row& row : rows) {
    row.prescribed = probably_binds(row, warm) && row.joint()->dof != last;
    last = row.prescribed ? row.joint()->dof : last;
  }
}

void prescribed_velocities(const StepSolution& step, std::vector<PrescribedVelocity>& velocities) {
  velocities.clear();
  for (Eigen::Index i = 0; i < step.prescribed; ++i) {
    const OnJoint& joint = *step.rows[i].joint();
    velocities.push_back({joint.dof, joint.sign * step.rows[i].rhs});
  }
}

bool release_all(StepSolution& step) {
  return release_where(step, [](Eigen::Index) { return true; });
}

bool release_pulling(StepSolution& step) {
  return release_where(step,
                       [&](Eigen::Index i) { return step.multipliers[i] < step.rows[i].lower; });
}

}  // namespace hagfish
