#include "experiments/mujoco/obstacle_geoms.hpp"

#include <array>
#include <cmath>

#include "core/contact/obstacles.hpp"

namespace hagfish {
namespace {

using Eigen::Vector3d;
using Rgba = std::array<float, 4>;

constexpr double plate_thickness = 0.5;  // cm
constexpr double strip = 0.05;  // of a plate beside its hole, cm: its rim hides their steps

constexpr Rgba plate_colour{0.72f, 0.76f, 0.80f, 1.0f};
constexpr Rgba pale_plate_colour{0.91f, 0.93f, 0.95f, 1.0f};
constexpr Rgba rim_colour{0.42f, 0.48f, 0.56f, 1.0f};
constexpr Rgba tube_colour{0.60f, 0.69f, 0.79f, 1.0f};

/// A geom in the middle of `at` (cm) whose Y is `side` and whose Z is `axis`.
mjvGeom geom_at(mjtGeom type, const Vector3d& size, const Vector3d& at, const Vector3d& side,
                const Vector3d& axis, const Rgba& colour) {
  Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor> axes;
  // MuJoCo has the axes as columns.
  axes.col(0) = side.cross(axis);
  axes.col(1) = side;
  axes.col(2) = axis;
  mjvGeom geom;
  mjv_initGeom(&geom, type, size.data(), at.data(), axes.data(), colour.data());
  geom.specular = 0;
  return geom;
}

/// The plate behind a square of a plane: one box, or one to each side of its hole and in the
/// corners between them strips.
std::vector<mjvGeom> plate_geoms(const DrawnSquare& square, const Rgba& colour) {
  const auto& [at_middle, normal, half, hole, floor] = square;
  const Vector3d up = std::abs(normal.z()) < 0.9
                          ? (Vector3d::UnitZ() - normal.z() * normal).normalized()
                          : Vector3d::UnitY();
  const Vector3d across = up.cross(normal);
  const Vector3d middle = at_middle - 0.5 * plate_thickness * normal;
  std::vector<mjvGeom> geoms;
  // From `left` to `right` of the middle and `low` to `high`.
  const auto add = [&](double left, double right, double low, double high) {
    const Vector3d halves(0.5 * (right - left), 0.5 * (high - low), 0.5 * plate_thickness);
    const Vector3d at = middle + 0.5 * (left + right) * across + 0.5 * (low + high) * up;
    geoms.push_back(geom_at(mjGEOM_BOX, halves, at, up, square.normal, colour));
  };
  if (hole == 0) {
    add(-half, half, -half, half);
    return geoms;
  }
  add(-half, half, -half, -hole);
  add(-half, half, hole, half);
  add(-half, -hole, -hole, hole);
  add(hole, half, -hole, hole);
  const int strips = static_cast<int>(std::ceil(2 * hole / strip));
  for (int k = 0; k < strips; ++k) {
    const double high = 2 * hole / strips, low = -hole + k * high, at = low + 0.5 * high;
    const double edge = std::sqrt(hole * hole - at * at);
    add(-hole, -edge, low, low + high);
    add(edge, hole, low, low + high);
  }
  return geoms;
}

}  // namespace

mjvGeom plate_geom(bool holds_head) {
  return plate_geoms({Vector3d::Zero(), Vector3d::UnitX(), drawn_plate_half},
                     holds_head ? plate_colour : pale_plate_colour)
      .front();
}

std::vector<mjvGeom> obstacle_geoms(const DrawnObstacle& obstacle, const Vector3d& toward) {
  if (const auto* square = std::get_if<DrawnSquare>(&obstacle)) {
    return plate_geoms(*square, plate_colour);
  }
  const auto& [strand, cut] = std::get<DrawnTube>(obstacle);
  std::vector<mjvGeom> geoms;
  const Eigen::Matrix3Xd curve = strand_curve(strand);
  const Vector3d centre = curve.rowwise().mean();
  for (Eigen::Index k = 0; k + 1 < curve.cols(); ++k) {
    const Vector3d along = curve.col(k + 1) - curve.col(k);
    const Vector3d middle = curve.col(k) + 0.5 * along;
    if (cut && toward.dot(middle - centre) > 0) continue;
    const double half = 0.5 * along.norm();
    const Vector3d axis = along.normalized();
    geoms.push_back(geom_at(mjGEOM_CAPSULE, {strand.radius, strand.radius, half}, middle,
                            axis.unitOrthogonal(), axis, cut ? tube_colour : rim_colour));
  }
  return geoms;
}

}  // namespace hagfish
