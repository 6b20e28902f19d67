#include "experiments/program/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/spline.hpp"

namespace hagfish {
namespace {

using Eigen::Vector3d;

constexpr double scale = 80;               // px/cm; Figure 7 prints 40 px/cm
constexpr double margin = 4;               // of the window around what it shows, px
constexpr double sphere_spacing = 0.066;   // of the radius; at 0.1 ripples show
constexpr double ring_width = 0.26;        // cm
const Vector3d plate_size(0.5, 5.2, 5.2);  // cm

struct Colour {
  float red, green, blue, specular;
};
constexpr Colour skin_colour{0.72f, 0.54f, 0.51f, 0.35f};
constexpr Colour ring_colour{0.36f, 0.25f, 0.25f, 0.35f};
constexpr Colour plate_colour{0.72f, 0.76f, 0.80f, 0};
constexpr Colour pale_plate_colour{0.91f, 0.93f, 0.95f, 0};

/// A geom whose Z axis points along `axis` (unit).
mjvGeom make_geom(mjtGeom type, const Vector3d& size, const Vector3d& position,
                  const Vector3d& axis, const Colour& colour) {
  const Vector3d side = axis.unitOrthogonal();
  Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor> axes;
  axes << side, axis.cross(side), axis;
  const float rgba[] = {colour.red, colour.green, colour.blue, 1};
  mjvGeom geom;
  mjv_initGeom(&geom, type, size.data(), position.data(), axes.data(), rgba);
  geom.specular = colour.specular;
  geom.shininess = 0.35f;
  return geom;
}

}  // namespace

std::vector<mjvGeom> skin_geoms(const Model& model, const Specimen& specimen,
                                const Eigen::Matrix3Xd& centre) {
  const double length = model.length();
  std::vector<mjvGeom> geoms;
  const std::vector<SplineSegment> segments = spline(model, centre);
  for (const SplineSegment& segment : segments) {
    const int count =
        static_cast<int>(std::ceil(segment.s1 / (sphere_spacing * segment.radius(0.5))));
    for (int k = 0; k < count; ++k) {
      const double t = (k + 0.5) / count;
      const bool ring = std::ranges::any_of(specimen.station, [&](double station) {
        return std::abs(segment.arc(t) - station * length) < 0.5 * ring_width;
      });
      geoms.push_back(make_geom(mjGEOM_SPHERE, Vector3d::Constant(segment.radius(t)),
                                segment.point(t), segment.slope(t).normalized(),
                                ring ? ring_colour : skin_colour));
    }
  }
  return geoms;
}

mjvGeom plate_geom(bool holds_head) {
  const Vector3d half = 0.5 * plate_size;
  // Of the geom's axes Z is the world's X.
  return make_geom(mjGEOM_BOX, {half.z(), half.y(), half.x()}, -half.x() * Vector3d::UnitX(),
                   Vector3d::UnitX(), holds_head ? plate_colour : pale_plate_colour);
}

View view_of(const std::vector<mjvGeom>& geoms, double pitch, double yaw) {
  const double p = pitch * std::numbers::pi / 180, y = yaw * std::numbers::pi / 180;
  View view;
  view.up = {0, std::cos(p), -std::sin(p)};
  const Vector3d toward(std::sin(y), std::cos(y) * std::sin(p), std::cos(y) * std::cos(p));
  view.right = view.up.cross(toward);
  view.scale = scale;

  Eigen::Array2d low = Eigen::Array2d::Constant(INFINITY), high = -low;
  for (const mjvGeom& geom : geoms) {
    const Vector3d position = Eigen::Map<const Eigen::Vector3f>(geom.pos).cast<double>();
    const Eigen::Array3d size = Eigen::Map<const Eigen::Array3f>(geom.size).cast<double>();
    const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> axes(geom.mat);
    for (int i = 0; i < 2; ++i) {
      const Vector3d along = i == 0 ? view.right : view.up;
      const Eigen::Array3d share = (axes.cast<double>().transpose() * along).array().abs();
      const double half = geom.type == mjGEOM_BOX ? (share * size).sum() : size.x();
      low[i] = std::min(low[i], position.dot(along) - half);
      high[i] = std::max(high[i], position.dot(along) + half);
    }
  }
  const Eigen::Array2d corner = (low * scale - margin).floor();
  const Eigen::Array2i size = ((high * scale + margin).ceil() - corner).cast<int>();
  view.low = corner / scale;
  view.width = size.x();
  view.height = size.y();
  return view;
}

}  // namespace hagfish
