#include "core/muscle/paths.hpp"

namespace hagfish {
namespace {

struct LineEnds {
  Eigen::Vector3d head, tail;  // world, cm
};

LineEnds ends_of(const Kinematics& kin, const Muscle& muscle, const MuscleLine& line) {
  const auto place = [&kin](int body, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return kin.origin.col(body) + kin.rotation[body] * point;
  };
  return {place(muscle.body - 1, line.head), place(muscle.body, line.tail)};
}

}  // namespace

MuscleGroup muscle_group(const Model& model, int first) {
  MuscleGroup group{first, 0};
  const int all = model.muscle_count();
  while (first + group.count < all &&
         model.muscles[first + group.count].body == model.muscles[first].body) {
    ++group.count;
  }
  return group;
}

double muscle_length(const Kinematics& kin, const Muscle& muscle) {
  double length = 0;
  for (const MuscleLine& line : muscle.lines) {
    const LineEnds ends = ends_of(kin, muscle, line);
    length += (ends.tail - ends.head).norm();
  }
  return length;
}

void moment_arms(const Model& model, const Kinematics& kin, const Muscle& muscle,
                 Eigen::Ref<Eigen::VectorXd> arm) {
  const Body& body = model.bodies[muscle.body];
  arm.setZero();
  for (const MuscleLine& line : muscle.lines) {
    const LineEnds ends = ends_of(kin, muscle, line);
    const Eigen::Vector3d pull = (ends.tail - ends.head).stableNormalized();
    const Eigen::Vector3d offset = ends.tail - kin.reference;
    for (int k = 0; k < body.dofs; ++k) {
      const Vector6d axis = kin.axis.col(body.first_dof + k);
      arm[k] -= pull.dot(axis.tail<3>() + axis.head<3>().cross(offset));
    }
  }
}

void muscle_torque(const Model& model, const Kinematics& kin,
                   const Eigen::Ref<const Eigen::VectorXd>& activation, Eigen::VectorXd& torque) {
  torque.setZero(model.nv());
  Eigen::Vector3d arm;  // a joint has three hinges at most
  for (std::size_t m = 0; m < model.muscles.size(); ++m) {
    const Muscle& muscle = model.muscles[m];
    const Body& body = model.bodies[muscle.body];
    moment_arms(model, kin, muscle, arm.head(body.dofs));
    torque.segment(body.first_dof, body.dofs) +=
        activation[static_cast<Eigen::Index>(m)] * muscle.force * arm.head(body.dofs);
  }
}

}  // namespace hagfish
