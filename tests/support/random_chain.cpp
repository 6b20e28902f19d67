#include "tests/support/random_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "core/input/files/scene_reader.hpp"

namespace hagfish {

double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 0x1p32;
}

Eigen::Vector3d random_vector(Random& random, double size) {
  return random_entries(random, 3, size);
}

Eigen::VectorXd random_entries(Random& random, Eigen::Index count, double size) {
  Eigen::VectorXd entries(count);
  for (double& entry : entries) {
    entry = uniform(random, -size, size);
  }
  return entries;
}

Eigen::Quaterniond random_rotation(Random& random) {
  // Points of the cube inside the unit ball are even over all directions.
  for (;;) {
    const Eigen::Vector4d x = random_entries(random, 4);
    if (x.norm() < 1 && x.norm() > 0.1) {
      return Eigen::Quaterniond(x.normalized());
    }
  }
}

Specimen table1_specimen() {
  static const Specimen read = read_specimen(HAGFISH_DATA_DIR "/specimens/pacific_hagfish.toml");
  return read;
}

Scene table1_scene(int bodies) {
  Scene scene;
  scene.model.bodies = bodies;
  scene.model.bending_stiffness = 424;
  scene.model.twist_stiffness = 424;
  scene.drag = {9.434, 2.358};
  scene.controller.tighten_tail = {0.5, 2};
  scene.controller.slide_head = {2, 2};
  scene.controller.slide_tail = {2, 2};
  return scene;
}

Model table1_hagfish(int bodies) { return make_hagfish(table1_specimen(), table1_scene(bodies)); }

Model cone_hagfish(int bodies) {
  Scene scene = table1_scene(bodies);
  scene.model.bending_limit = BendingLimit::cone;
  return make_hagfish(table1_specimen(), scene);
}

Model muscled_hagfish(int bodies) {
  Scene scene = table1_scene(bodies);
  scene.muscle.present = true;
  return make_hagfish(table1_specimen(), scene);
}

State within_cones(const Model& model, State state, double share) {
  for (const BendingCone& cone : model.cones) {
    auto angles = state.q.segment<2>(cone.dof + 1);
    if (total_bend(angles[0], angles[1]).angle > share * cone.limit) {
      angles = bend_to(angles[0], angles[1], share * cone.limit);
    }
  }
  return state;
}

Model random_chain(Random& random, int bodies) {
  Model model;
  model.drag = {uniform(random, 1, 10), uniform(random, 1, 10)};
  model.gravity = random_vector(random, 980);
  for (int b = 0; b < bodies; ++b) {
    Body body;
    body.mass = uniform(random, 0.5, 2);
    body.length = uniform(random, 0.3, 1);
    body.radius = uniform(random, 0.3, 0.9);
    body.inertia = cylinder_inertia(body.mass, body.length, body.radius);
    body.inertia.z() *= uniform(random, 0.8, 1.2);  // so that Y and Z differ
    std::array<Axis, 3> axes = {Axis::x, Axis::y, Axis::z};
    std::swap(axes[0], axes[random() % 3]);
    std::swap(axes[1], axes[1 + random() % 2]);
    const auto count = static_cast<std::ptrdiff_t>(b == 0 ? 0 : random() % 4);
    append_body(model, body, {axes.begin(), axes.begin() + count});
  }
  for (Hinge& hinge : model.hinges) {
    hinge.lower = -uniform(random, 0.2, 1);
    hinge.upper = uniform(random, 0.2, 1);
    hinge.stiffness = uniform(random, 0, 500);
    hinge.damping = uniform(random, 0, 20);
  }
  return model;
}

State random_state(Random& random, const Model& model, double angle, double speed) {
  State state = rest_state(model);
  state.q.head<3>() = random_vector(random, 5);
  const Eigen::Quaterniond turn = random_rotation(random);
  state.q.segment<4>(3) << turn.w(), turn.x(), turn.y(), turn.z();
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    state.q[k + 1] = uniform(random, std::max(-angle, hinge.lower), std::min(angle, hinge.upper));
  }
  state.qdot = random_entries(random, model.nv(), speed);
  return state;
}

State bent_state(const Model& model, double bend_y, double bend_z, double twist) {
  State state = rest_state(model);
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double rate = hinge.axis == Axis::x ? twist : hinge.axis == Axis::y ? bend_y : bend_z;
    state.q[k + 1] = rate * hinge_span(model, hinge.body);
  }
  return state;
}

Eigen::Vector3d trefoil_point(double share, double height) {
  // Cut where it is outermost, so that both ends are free of the knot. 1.65 makes it 42 cm long.
  if (share > 1) {
    const Eigen::Vector3d end = trefoil_point(1, height);
    return end + (share - 1) / 0.01 * (end - trefoil_point(0.99, height));
  }
  const double t = std::numbers::pi * (1.06 + 1.88 * share);
  return {1.65 * (std::sin(t) + 2 * std::sin(2 * t)), 1.65 * (std::cos(t) - 2 * std::cos(2 * t)),
          -0.5 * height * std::sin(3 * t)};
}

State knotted_state(Random& random, const Model& model, double height, double noise) {
  State state = rest_state(model);
  const auto ahead = [&](double& share, const Eigen::Vector3d& from, double reach) {
    while (share < 2 && (trefoil_point(share, height) - from).norm() < reach) share += 1e-4;
    return (trefoil_point(share, height) - from).normalized().eval();
  };
  double share = 0;
  Eigen::Vector3d at = trefoil_point(0, height);
  const Eigen::Vector3d first = ahead(share, at, model.bodies[0].length);
  const Eigen::Quaterniond start =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), first);
  Eigen::Matrix3d frame = start.toRotationMatrix();
  at += model.bodies[0].length * frame.col(0);
  for (int b = 1; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    if (body.dofs == 2) {  // turns that bring X into the wanted direction; two bodies follow it
      const Eigen::Vector3d d = frame.transpose() * ahead(share, at, 2 * body.length);
      const Eigen::Vector3d to_y = Eigen::Vector3d::UnitY(), to_z = Eigen::Vector3d::UnitZ();
      if (model.hinges[body.first_dof - root_dofs].axis == Axis::y) {
        const double y = std::atan2(-d.z(), d.x()), z = std::asin(d.y());
        state.q.segment<2>(body.first_dof + 1) << y, z;
        frame = frame * Eigen::AngleAxisd(y, to_y) * Eigen::AngleAxisd(z, to_z);
      } else {
        const double z = std::atan2(d.y(), d.x()), y = -std::asin(d.z());
        state.q.segment<2>(body.first_dof + 1) << z, y;
        frame = frame * Eigen::AngleAxisd(z, to_z) * Eigen::AngleAxisd(y, to_y);
      }
    }
    at += body.length * frame.col(0);
  }
  const Eigen::Index hinges = model.nv() - root_dofs;
  state.q.tail(hinges) += random_entries(random, hinges, noise);
  return state;
}

StepOperator random_operator(Random& random, const Model& model, const Kinematics& kin) {
  StepOperator op;
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Matrix3d turn = random_rotation(random).toRotationMatrix();
    const auto positive = [&](double size) -> Eigen::Matrix3d {
      const Eigen::Vector3d diagonal =
          size * (Eigen::Vector3d::Ones() + 0.5 * random_vector(random));
      return turn * diagonal.asDiagonal() * turn.transpose();
    };
    const Body& body = model.bodies[b];
    op.inertia.emplace_back(point_operator(positive(body.inertia.maxCoeff()), positive(body.mass),
                                           kin.centre_offset(b)));
  }
  op.diagonal = random_entries(random, model.nv(), 0.01).cwiseAbs();
  return op;
}

double relative_error(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  const double scale = y.size() > 0 ? y.lpNorm<Eigen::Infinity>() : 0;
  const double error = x.size() > 0 ? (x - y).lpNorm<Eigen::Infinity>() : 0;
  return scale > 0 ? error / scale : error;
}

}  // namespace hagfish
