#include "experiments/audit/audit_muscles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/log/log_writer.hpp"
#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

/// The rest shape follows q at every step, which is known at frames: a median, as a share of the
/// way that the hinges made between two.
constexpr double tone_tolerance = 0.2;
constexpr std::size_t least_frames = 5;  // for a median

}  // namespace

MuscleAudit::MuscleAudit(const LogContents& log)
    : log_(log),
      law_(law_of(log.resolved.scene)),
      torque_(log.h5.rows("/forces/active")),
      q_ref_(log.h5.rows("/trajectory/q_ref")) {
  if (log.own_law()) {
    asked_ = log.h5.rows("/control/torque");
    asked_rate_ = log.h5.rows("/control/torque_rate");
    has_rest_shape_ = log.h5.integers("/control/has_rest_shape");
  }
  for (const LawNumbers& numbers : law_.numbers) {
    const bool there = numbers.size == nullptr || numbers.size(log.model, log.resolved.scene) > 0;
    numbers_.push_back(there ? log.h5.rows(numbers.path)
                             : Hdf5Reader::Rows(log.qdot.rows(), Eigen::Index{0}));
  }
}

void MuscleAudit::see(const AuditedFrame& frame) {
  see_torque(frame);
  see_rest_shape(frame);
}

void MuscleAudit::see_torque(const AuditedFrame& frame) {
  const Scene& scene = log_.resolved.scene;
  const Eigen::Index f = frame.index;
  const Eigen::VectorXd torque = torque_.row(f);
  // Muscles hold on to nothing outside.
  if (!torque.head<root_dofs>().isZero(0)) on_root_.insert("/forces/active");
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(log_.model.nv());
  const auto add = [&](const ActiveTorque& asked) {
    wanted += asked.value - asked.rate.cwiseProduct(frame.qdot_mean);
  };
  if (has_rest_shape(frame)) {
    add(active_torque(log_.model, scene, frame.state, q_ref_.row(f).transpose()));
  }
  if (log_.own_law()) {
    add({asked_.row(f).transpose(), asked_rate_.row(f).transpose()});
  }
  see_law(frame, wanted);
  rebuilt_.compare("/forces/active", torque, wanted);
}

void MuscleAudit::see_law(const AuditedFrame& frame, Eigen::VectorXd& torque) {
  const bool remembers = law_.remembers == nullptr || law_.remembers(frame.phase);
  const LoggedSituation at = situation(frame);
  for (std::size_t k = 0; k < numbers_.size() && !remembers; ++k) {
    rebuilt_.compare(law_.numbers[k].path, at.numbers[k],
                     Eigen::VectorXd::Constant(at.numbers[k].size(), NAN));
  }
  // Without a contact in the slide a law does nothing and remembers nothing.
  const bool acts =
      remembers && std::ranges::all_of(at.numbers, [](const Eigen::VectorXd& numbers) {
        return numbers.allFinite();
      });
  if (acts && law_.torque != nullptr) torque += law_.torque(at);
}

LoggedSituation MuscleAudit::situation(const AuditedFrame& frame) const {
  LoggedSituation at{log_.model,
                     log_.resolved.scene,
                     frame.observation.kin,
                     frame.state.q,
                     frame.state.qdot,
                     frame.observation.contact,
                     frame.phase,
                     log_.time[static_cast<std::size_t>(frame.index)],
                     {}};
  for (const Hdf5Reader::Rows& rows : numbers_) at.numbers.emplace_back(rows.row(frame.index));
  return at;
}

bool MuscleAudit::has_rest_shape(const AuditedFrame& frame) const {
  if (log_.own_law()) return has_rest_shape_[static_cast<std::size_t>(frame.index)] != 0;
  const auto shape = shape_of_law(frame);
  return shape ? shape->size() > 0
               : log_.resolved.scene.script.kind == ScriptSettings::Kind::curvature;
}

std::optional<Eigen::VectorXd> MuscleAudit::shape_of_law(const AuditedFrame& frame) const {
  return law_.rest_shape == nullptr ? std::nullopt : law_.rest_shape(situation(frame));
}

void MuscleAudit::see_rest_shape(const AuditedFrame& frame) {
  const Scene& scene = log_.resolved.scene;
  const Eigen::Index f = frame.index;
  const double h = scene.time.step;
  const Eigen::VectorXd rest = q_ref_.row(f);
  if (log_.own_law()) {
    if (!rest.head<root_dofs>().isZero(0)) on_root_.insert("/trajectory/q_ref");
    return;
  }
  const auto shape = shape_of_law(frame);
  if (shape && shape->size() > 0) {
    rebuilt_.compare("/trajectory/q_ref", rest, *shape);
    return;
  }
  if (!has_rest_shape(frame)) {
    rebuilt_.compare("/trajectory/q_ref", rest, Eigen::VectorXd::Zero(rest.size()));
    return;
  }
  if (!rest.head<root_dofs>().isZero(0)) on_root_.insert("/trajectory/q_ref");
  if (frame.phase == Phase::form) {
    rebuilt_.compare(
        "/trajectory/q_ref", rest,
        program_shape(log_.model, scene.script.curvature, log_.time[f] + scene.time.reach()));
    return;
  }
  if (f == 0 || static_cast<Phase>(log_.phase[f - 1]) == Phase::form) {
    return;
  }
  const auto relaxes = [&](Eigen::Index frame_index) {
    const auto phase = static_cast<Phase>(log_.phase[frame_index]);
    return phase == Phase::release || phase == Phase::free;
  };
  const Eigen::VectorXd before = q_ref_.row(f - 1);
  const auto steps = static_cast<double>(frame_stride(scene.time));
  if (relaxes(f - 1)) {
    rebuilt_.compare("/trajectory/q_ref", rest,
                     std::exp(-steps * h / scene.active.relax_time) * before);
  } else if (!relaxes(f)) {
    // From step to step e = q_ref - q becomes kept (e - Δq); between frames, as if Δq were even.
    const double kept = std::exp(-h / scene.active.tone_time);
    const double whole = std::pow(kept, steps);
    const Eigen::Index count = rest.size() - root_dofs;
    const Eigen::VectorXd now = log_.q.row(f).tail(count);
    const Eigen::VectorXd way = now - log_.q.row(f - 1).tail(count).transpose();
    const Eigen::VectorXd lag = before.tail(count) - log_.q.row(f - 1).tail(count).transpose();
    const Eigen::VectorXd wanted =
        now + whole * lag - kept * (1 - whole) / (1 - kept) / steps * way;
    tone_deviation_.push_back((rest.tail(count) - wanted).norm() / way.norm());
  }
}

std::vector<Finding> MuscleAudit::findings() const {
  std::vector<Finding> findings{
      rebuilt_.finding("muscles", "the scene's program, q, q_ref and q̇ after the step"),
      judged({"muscles hold on to nothing", static_cast<double>(on_root_.size()), 0, "datasets"},
             on_root_.empty() ? "root entries are 0"
                              : fmt::format("act on the root: {}", fmt::join(on_root_, ", ")))};
  if (tone_deviation_.size() >= least_frames) {
    findings.push_back(judged_over(
        {"muscle tone", median(tone_deviation_), tone_tolerance, "of the way between frames"},
        "median of /trajectory/q_ref against its following q"));
  }
  return findings;
}

}  // namespace hagfish
