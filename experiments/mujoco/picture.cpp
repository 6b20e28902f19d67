#include "experiments/mujoco/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/contact/contact.hpp"
#include "core/scene/interpolation.hpp"

namespace hagfish {
namespace {

using Eigen::Vector3d;
using Rgb = std::array<unsigned char, 3>;

constexpr double own_scale = 80;      // px/cm; Figure 7 prints 40 px/cm
constexpr double margin = 4;          // of the window around what it shows, px
constexpr int rings_per_segment = 6;  // 0.07 cm apart, so that the dark rings have sharp edges
constexpr int cap_rings = 6;          // of each round end
constexpr double ring_width = 0.26;   // cm
constexpr double ring_shade = 0.5;    // of the colour beside it

constexpr Rgb skin_colour{184, 138, 130};
constexpr float skin_specular = 0.35f;

/// Viridis, told apart with any colour vision, at every sixteenth.
constexpr std::array<Rgb, 17> viridis = {{{68, 1, 84},
                                          {72, 24, 106},
                                          {71, 45, 123},
                                          {66, 64, 134},
                                          {59, 82, 139},
                                          {51, 99, 141},
                                          {44, 114, 142},
                                          {38, 130, 142},
                                          {33, 145, 140},
                                          {31, 160, 136},
                                          {40, 174, 128},
                                          {63, 188, 115},
                                          {94, 201, 98},
                                          {132, 212, 75},
                                          {173, 220, 48},
                                          {216, 226, 25},
                                          {253, 231, 37}}};

/// A ring: where on the spline, and how it closes the ends.
struct Ring {
  int segment = 0;
  double t = 0;
  double turn = 0;  ///< of the round end, -90° at the head's tip to 90° at the tail's, rad
};

Ring ring_at(int ring, int segments) {
  const int along = segments * rings_per_segment;  // the last ring along the body
  const int place = std::clamp(ring - cap_rings, 0, along);
  const int segment = std::min(place / rings_per_segment, segments - 1);
  const int beyond = ring - cap_rings - place;  // below 0 at the head
  return {segment, static_cast<double>(place) / rings_per_segment - segment,
          beyond * std::numbers::pi / 2 / cap_rings};
}

bool is_measured(const Specimen& specimen, double length, double arc) {
  return std::ranges::any_of(specimen.station, [&](double station) {
    return std::abs(arc - station * length) < 0.5 * ring_width;
  });
}

Rgb shaded(const Rgb& colour, bool dark) {
  if (!dark) return colour;
  Rgb out{};
  std::ranges::transform(colour, out.begin(), [](unsigned char c) {
    return static_cast<unsigned char>(ring_shade * c);
  });
  return out;
}

Rgb colour_of(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double rest = place - static_cast<double>(below);
  Rgb out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = static_cast<unsigned char>(
        std::lround((1 - rest) * viridis[below][i] + rest * viridis[below + 1][i]));
  }
  return out;
}

}  // namespace

int skin_rings(const Model& model) {
  return (model.body_count() - 1) * rings_per_segment + 1 + 2 * cap_rings;
}

Skin skin_of(const Model& model, const Specimen& specimen, const Eigen::Matrix3Xd& centre) {
  const std::vector<SplineSegment> segments = spline(model, centre);
  const double length = model.length();
  Skin skin;
  skin.sides = skin_sides;
  skin.specular = skin_specular;
  const int rings = skin_rings(model);
  skin.point.resize(3, static_cast<Eigen::Index>(rings) * skin_sides);
  skin.normal.resize(3, skin.point.cols());
  Vector3d across = segments.front().slope(0).unitOrthogonal();
  Eigen::Index at = 0;
  for (int k = 0; k < rings; ++k) {
    const Ring ring = ring_at(k, static_cast<int>(segments.size()));
    const SplineSegment& segment = segments[ring.segment];
    const Vector3d along = segment.slope(ring.t).normalized();
    // Carried along without turning about the body.
    across -= across.dot(along) * along;
    across = across.norm() > 1e-6 ? across.normalized().eval() : along.unitOrthogonal();
    const Vector3d third = along.cross(across);
    const double radius = segment.radius(ring.t);
    for (int s = 0; s < skin_sides; ++s, ++at) {
      const double turn = 2 * std::numbers::pi * s / skin_sides;
      const Vector3d out =
          std::cos(ring.turn) * (std::cos(turn) * across + std::sin(turn) * third) +
          std::sin(ring.turn) * along;
      skin.normal.col(at) = out.cast<float>();
      skin.point.col(at) = (segment.point(ring.t) + radius * out).cast<float>();
    }
    skin.colour.push_back(shaded(skin_colour, is_measured(specimen, length, segment.arc(ring.t))));
  }
  return skin;
}

void paint(const Model& model, const Specimen& specimen, const std::vector<double>& arc,
           const Eigen::VectorXd& value, double scale, Skin& skin) {
  const double length = model.length();
  const double own = length / model.body_count();
  for (int k = 0; k < skin.rings(); ++k) {
    const Ring ring = ring_at(k, model.body_count() - 1);
    const double place = (ring.segment + ring.t + 0.5) * own;
    const double here = value_at(
        bracket_of(arc, place), [&](std::size_t j) { return value[static_cast<Eigen::Index>(j)]; });
    skin.colour[k] =
        shaded(colour_of(scale > 0 ? here / scale : 0), is_measured(specimen, length, place));
  }
}

std::vector<std::array<unsigned char, 3>> colour_steps() {
  constexpr int steps = 256;
  std::vector<Rgb> colours;
  for (int k = 0; k < steps; ++k) colours.push_back(colour_of(k / (steps - 1.0)));
  return colours;
}

View turned_view(double pitch, double yaw) {
  const double p = pitch * std::numbers::pi / 180, y = yaw * std::numbers::pi / 180;
  View view;
  view.up = {0, std::cos(p), -std::sin(p)};
  const Vector3d toward(std::sin(y), std::cos(y) * std::sin(p), std::cos(y) * std::cos(p));
  view.right = view.up.cross(toward);
  return view;
}

void Shown::add(const View& view, const Skin& skin) {
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3f along = (i == 0 ? view.right : view.up).cast<float>();
    const Eigen::VectorXf place = skin.point.transpose() * along;
    low[i] = std::min<double>(low[i], place.minCoeff());
    high[i] = std::max<double>(high[i], place.maxCoeff());
  }
}

void Shown::add(const View& view, const mjvGeom& box) {
  const Vector3d position = Eigen::Map<const Eigen::Vector3f>(box.pos).cast<double>();
  const Eigen::Array3d size = Eigen::Map<const Eigen::Array3f>(box.size).cast<double>();
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> axes(box.mat);
  for (int i = 0; i < 2; ++i) {
    const Vector3d along = i == 0 ? view.right : view.up;
    const Eigen::Array3d share = (axes.cast<double>().transpose() * along).array().abs();
    low[i] = std::min(low[i], position.dot(along) - (share * size).sum());
    high[i] = std::max(high[i], position.dot(along) + (share * size).sum());
  }
}

void fit(const Shown& shown, View& view) {
  view.scale = own_scale;
  // What is nearer by half a length looks larger by a hundredth: see lens in offscreen.cpp.
  const Eigen::Array2d room = margin + 0.005 * own_scale * (shown.high - shown.low);
  const Eigen::Array2d corner = (shown.low * own_scale - room).floor();
  const Eigen::Array2i size = ((shown.high * own_scale + room).ceil() - corner).cast<int>();
  view.low = corner / own_scale;
  view.width = size.x();
  view.height = size.y();
}

void add_room(int room, View& view) {
  view.low.y() -= room / view.scale;
  view.height += room;
}

void fit(const Shown& shown, int width, int height, View& view) {
  const Eigen::Array2d size(width, height);
  view.scale = ((size - 2 * margin) / (shown.high - shown.low)).minCoeff();
  view.low = 0.5 * (shown.low + shown.high) - 0.5 * size / view.scale;
  view.width = width;
  view.height = height;
}

}  // namespace hagfish
