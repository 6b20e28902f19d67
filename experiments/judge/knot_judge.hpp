// The knot through a run: its type, its hand, how it slid, and whether it pulled the head out.
#pragma once

#include <string>
#include <vector>

#include "core/run/slide.hpp"
#include "experiments/judge/expectations.hpp"
#include "experiments/judge/run_frame.hpp"

namespace hagfish {

class KnotJudge {
 public:
  /// Model and scene are referred to. A branch begins later than its run, of which it shows a part.
  KnotJudge(const Model& model, const Scene& scene, bool branch);
  /// A frame, whose body is as `kin`.
  void see(const RunFrame& frame, const Kinematics& kin);

  /// The frames of one phase.
  struct Stretch {
    double from = NAN, to = NAN;  ///< times of the first and the last, s; nan where it has none
  };
  Stretch stretch(Phase phase) const;
  const SlideWatch& slides() const { return slides_; }
  /// The type as tightening or the slide begins, or at the end where it comes to neither.
  const std::string& type() const;
  /// The log or run shows the slide or some of it.
  bool shows_slide() const { return shows(Phase::slide); }
  /// Largest skin_fold() while the knot is held, 0 where it never is.
  double skin_fold() const { return largest_fold_; }
  Finding skin() const;
  /// Against the scene's [expect]; none where it expects no knot. What a run that stops early
  /// (time.until) does not reach is not judged.
  std::vector<Finding> findings() const;

 private:
  struct Seen {
    double time = 0;  ///< s
    Phase phase = Phase::form;
    std::string type;   ///< empty of a body past having one: it touches itself, or is too tangled
    double before = 0;  ///< way of the head's end in front of the plane expect.out_of, cm
  };
  Phase first_phase() const { return branch_ ? frames_.front().phase : scene_.start.phase; }
  bool reaches(Phase phase) const;
  bool shows(Phase phase) const;
  /// Whether a branch does not show a phase from its beginning.
  bool begins_within(Phase phase) const { return branch_ && first_phase() == phase; }
  double clock_of(const RunTime& time) const;
  std::string never_held() const;
  Finding held() const;
  std::vector<Finding> types_through_time() const;
  Finding hand() const;
  bool let_go(std::size_t before) const;
  Finding head_out() const;

  const Model& model_;
  const Scene& scene_;
  bool branch_;
  const Plane* out_of_ = nullptr;
  std::vector<Seen> frames_;
  SlideWatch slides_;
  double first_writhe_ = NAN;         ///< writhe of the first frame that holds the knot
  Eigen::Matrix3Xd held_centreline_;  ///< centreline of the last one
  double largest_fold_ = 0;
  std::int64_t held_ = 0, folded_ = 0;  ///< frames
};

}  // namespace hagfish
