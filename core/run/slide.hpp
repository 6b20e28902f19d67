// How a knot slid: by both of its ends, and by the curvature of the body, which knows no contact.
//
// A knot that slides takes up body at its leading end and lets go of body at its trailing end. A
// knot that only grows takes up body alone, and its leading end moves all the same.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/control/controller.hpp"
#include "core/scene/phase.hpp"

namespace hagfish {

/// A moment of a slide.
struct SlideMoment {
  KnotSpan knot;
  Eigen::VectorXd curvature;  ///< curvature_along() of the body
};

/// Total bend of each bending joint over the length of body that it stands for, 1/cm, head to tail.
Eigen::VectorXd curvature_along(const Model& model, const Eigen::VectorXd& q);

/// Ways are towards the end of the body to which the knot slides, cm of arc.
struct Slide {
  static constexpr double none = NAN;
  double from = none;          ///< place of the knot's leading end as the slide begins, cm of arc
  double leading_way = none;   ///< way of the end that goes first: headward, the head end
  double trailing_way = none;  ///< way of its other end
  /// Way of the trailing end of a knot that stays as tight. Such a knot spans as many radii of body
  /// everywhere, so it keeps the integral of ds / r between its ends. On a tapering body this is
  /// not the leading end's way.
  double taper_asks = none;
  /// Way of the body's curvature. The way of the leading end is cut in quarters. From each to the
  /// next, the shift along the body is taken that maximises the correlation of the curvatures.
  /// Shifts are added up. `none` for a leading end that advances by less than least_way.
  double travel = none;
  double correlation = none;  ///< the least of these four, -1 to 1

  /// How far this is a slide of both ends: the lesser of trailing_way / taper_asks and of travel
  /// over the lesser way of the ends. 0 for a knot whose leading end does not advance, or whose
  /// curvature is not that of a quarter before (correlation below least_correlation); nan where
  /// there was none.
  double share() const;
};

/// The slide through `moments`, in the order of time, towards an end of the body.
Slide slide_through(const Model& model, std::span<const SlideMoment> moments, BodyEnd towards);

/// Keeps the moments of a run's slide, and of its way back to the tail.
class SlideWatch {
 public:
  /// `model` is referred to.
  explicit SlideWatch(const Model& model) : model_(&model) {}
  /// A moment, in the order of time: coordinates `q` (nq) and the knot's ends, if it has any. Those
  /// of other phases count for nothing.
  void see(Phase phase, const std::optional<KnotSpan>& knot, const Eigen::VectorXd& q);
  /// Slide and way back by what was seen so far.
  Slide slide() const { return slide_through(*model_, slide_, BodyEnd::head); }
  Slide way_back() const { return slide_through(*model_, way_back_, BodyEnd::tail); }

 private:
  const Model* model_;
  std::vector<SlideMoment> slide_, way_back_;
};

/// Least way of a slide, of the length of the body: of less the shares say nothing.
inline constexpr double least_way = 0.005;
/// Least correlation of curvatures that are laid on each other. Slides have 0.8 to 1.
inline constexpr double least_correlation = 0.5;
/// Least share() of what is called a slide of both ends.
inline constexpr double both_ends_share = 0.7;

/// What a slide is by name. "slides by both ends": it has at least this share. Else "only grows",
/// whose trailing end stays, or "slides and grows", whose trailing end comes by too little; or
/// "keeps its bends in place", whose curvature stays. "does not slide": its leading end stays
/// (least_way). Empty where there was no slide.
std::string slide_name(const Slide& slide);

}  // namespace hagfish
