#include "core/run/slide.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/chain/bending.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {
namespace {

constexpr int quarters = 4;
/// Curvature is compared at so many places along the body, between which it is linear.
constexpr int places = 400;
/// Largest shift of curvature from one quarter to the next, of the length of the body.
constexpr double largest_shift = 0.1;

/// Places of the bending joints, from the head, cm of arc.
std::vector<double> joint_places(const Model& model) {
  std::vector<double> found;
  double arc = 0;
  for (const Body& body : model.bodies) {
    if (bends(body)) found.push_back(arc);
    arc += body.length;
  }
  return found;
}

/// Radii of body up to places on a fine grid: the integral of ds / r from the head.
struct Radii {
  std::vector<double> arc{0}, sum{0};  ///< cm, 1
};

Radii radii_along(const Model& model) {
  std::vector<double> middle, radius;
  double length = 0;
  for (const Body& body : model.bodies) {
    middle.push_back(length + 0.5 * body.length);
    radius.push_back(body.radius);
    length += body.length;
  }
  Radii radii;
  const double ds = length / places;
  for (int i = 1; i <= places; ++i) {
    radii.arc.push_back(i * ds);
    radii.sum.push_back(radii.sum.back() + ds / profile(middle, radius, (i - 0.5) * ds));
  }
  return radii;
}

double correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::ArrayXd a = x.array() - x.mean(), b = y.array() - y.mean();
  const double size = std::sqrt(a.square().sum() * b.square().sum());
  return size > 0 ? (a * b).sum() / size : 0;
}

/// The shift (cm, headward) that best lays curvature `now` on curvature `before`, and their
/// correlation there.
std::pair<double, double> best_shift(const Model& model, const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& now) {
  const double length = model.length();
  const std::vector<double> joints = joint_places(model);
  const Eigen::VectorXd grid = Eigen::VectorXd::LinSpaced(places, 0, length);
  const auto on_grid = [&](const Eigen::VectorXd& curvature) -> Eigen::VectorXd {
    const std::vector<double> values(curvature.begin(), curvature.end());
    return grid.unaryExpr([&](double s) { return profile(joints, values, s); });
  };
  const Eigen::VectorXd old = on_grid(before), shown = on_grid(now);
  const int most = static_cast<int>(largest_shift * places);
  Eigen::VectorXd likeness(2 * most + 1);
  for (int k = -most; k <= most; ++k) {
    // now(s) = before(s + shift)
    const int overlap = places - std::abs(k);
    likeness[k + most] =
        correlation(old.segment(std::max(k, 0), overlap), shown.segment(std::max(-k, 0), overlap));
  }
  Eigen::Index best = 0;
  const double most_alike = likeness.maxCoeff(&best);
  double between = 0;  // the top of a parabola
  if (best > 0 && best + 1 < likeness.size()) {
    const double left = likeness[best - 1], right = likeness[best + 1];
    const double bend = left - 2 * most_alike + right;
    if (bend < 0) between = 0.5 * (left - right) / bend;
  }
  return {(static_cast<double>(best) - most + between) * length / (places - 1), most_alike};
}

}  // namespace

Eigen::VectorXd curvature_along(const Model& model, const Eigen::VectorXd& q) {
  std::vector<double> found;
  for (int b = 1; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    if (!bends(body)) continue;
    const double angle = total_bend(q[body.first_dof + 1], q[body.first_dof + 2]).angle;
    found.push_back(angle / hinge_span(model, b));
  }
  return Eigen::VectorXd::Map(found.data(), std::ssize(found));
}

double Slide::share() const {
  if (std::isnan(leading_way)) return none;
  if (!(correlation >= least_correlation && trailing_way > 0)) return 0;
  return std::min(trailing_way / taper_asks, travel / std::min(leading_way, trailing_way));
}

Slide slide_through(const Model& model, std::span<const SlideMoment> moments, BodyEnd towards) {
  Slide slide;
  if (moments.empty()) return slide;
  const bool headward = towards == BodyEnd::head;
  const double sense = headward ? 1 : -1;
  const auto lead = [headward](const SlideMoment& m) {
    return headward ? m.knot.head_end : m.knot.tail_end;
  };
  const auto trail = [headward](const SlideMoment& m) {
    return headward ? m.knot.tail_end : m.knot.head_end;
  };
  const SlideMoment &first = moments.front(), &last = moments.back();
  slide.from = lead(first);
  slide.leading_way = sense * (lead(first) - lead(last));
  slide.trailing_way = sense * (trail(first) - trail(last));
  const auto [arc, sum] = radii_along(model);
  const auto radii = [&arc = arc, &sum = sum](double at) { return profile(arc, sum, at); };
  const double kept = radii(lead(last)) + radii(trail(first)) - radii(lead(first));
  slide.taper_asks = sense * (trail(first) - profile(sum, arc, kept));
  if (!(slide.leading_way >= least_way * model.length())) return slide;
  slide.travel = 0;
  slide.correlation = 1;
  const SlideMoment* before = &first;
  for (int k = 1; k <= quarters; ++k) {
    const double way = slide.leading_way * k / quarters;
    const auto there = std::ranges::find_if(
        moments, [&](const SlideMoment& m) { return sense * (lead(first) - lead(m)) >= way; });
    const SlideMoment& now = there == moments.end() ? last : *there;
    const auto [shift, alike] = best_shift(model, before->curvature, now.curvature);
    slide.travel += sense * shift;
    slide.correlation = std::min(slide.correlation, alike);
    before = &now;
  }
  return slide;
}

void SlideWatch::see(Phase phase, const std::optional<KnotSpan>& knot, const Eigen::VectorXd& q) {
  if (!knot || (phase != Phase::slide && phase != Phase::reverse)) return;
  (phase == Phase::slide ? slide_ : way_back_).push_back({*knot, curvature_along(*model_, q)});
}

std::string slide_name(const Slide& slide) {
  if (std::isnan(slide.leading_way)) return "";
  if (std::isnan(slide.travel)) return "does not slide";
  if (slide.share() >= both_ends_share) return "slides by both ends";
  const double trails = slide.trailing_way / slide.taper_asks;
  return trails >= both_ends_share       ? "keeps its bends in place"
         : trails >= 1 - both_ends_share ? "slides and grows"
                                         : "only grows";
}

}  // namespace hagfish
