#include "experiments/audit/audit_parts.hpp"

#include <algorithm>

#include "core/log/log_frame.hpp"
#include "experiments/audit/row_force.hpp"

namespace hagfish {
namespace {

/// Speeds of rows are met to 1e-8 of the largest in the step, some 10 cm/s (Ipopt).
constexpr double ask_tolerance = 1e-5;  // cm/s
constexpr double cap_tolerance = 1e-6;
/// The knot goes to the tail in this phase: both tangents turn.
bool towards_tail(const Scene& scene, Phase phase) {
  return phase == Phase::reverse ||
         (phase == Phase::release && scene.controller.leave_by == BodyEnd::tail);
}

}  // namespace

int last_loaded(const std::vector<SplineSegment>& segments, const Scene& scene,
                const Contact& contact, KnotEnd end) {
  std::vector<PatchPoint> patch;
  std::vector<int> near;
  if (end != KnotEnd::neither) {
    contact_patch(segments, scene, contact, end == KnotEnd::last, near, patch);
  }
  int last = patch.empty() ? contact.segment_b : 0;
  for (const PatchPoint& point : patch) last = std::max(last, point.contact.segment_b);
  return last + 2;
}

ThigmotaxisAudit::ThigmotaxisAudit(const LogContents& log)
    : log_(log),
      table_(law_of(log.resolved.scene).logs_rows),
      force_(log.h5.rows("/forces/thigmotaxis")) {
  if (!table_) {
    lambda_ = log.h5.rows("/thigmotaxis/lambda");
    command_ = log.h5.rows("/thigmotaxis/command");
    speed_ = log.h5.rows("/thigmotaxis/speed");
    spline_a_ = log.h5.rows("/thigmotaxis/spline_a");
    spline_b_ = log.h5.rows("/thigmotaxis/spline_b");
    cap_ = log.h5.doubles("/thigmotaxis/cap");
    return;
  }
  const auto integers = [&log](const char* name) {
    return log.h5.integers(std::string("/eq6/") + name);
  };
  const auto doubles = [&log](const char* name) {
    return log.h5.doubles(std::string("/eq6/") + name);
  };
  frame_ = integers("frame");
  end_ = integers("end");
  along_ = integers("along");
  towards_ = integers("towards");
  row_a_ = doubles("spline_a");
  row_b_ = doubles("spline_b");
  row_command_ = doubles("command");
  row_cap_ = doubles("cap");
  row_lambda_ = doubles("lambda");
  row_speed_ = doubles("speed");
}

ThigmotaxisAudit::Rows ThigmotaxisAudit::see(const AuditedFrame& frame, Rebuilt& rebuilt,
                                             std::set<std::string>& shape) {
  const Model& model = log_.model;
  const std::vector<LoggedRow> rows = table_ ? rows_of_table(frame, shape) : rows_at_ends(frame);
  see_extent(frame, rows);
  Rows seen{Eigen::MatrixXd::Zero(model.nv(), 4), Eigen::VectorXd::Zero(model.nv())};
  const std::string group = table_ ? "/eq6/" : "/thigmotaxis/";
  for (const LoggedRow& r : rows) {
    const Row row = row_of(frame, r);
    const double speed =
        row_velocity(row, {frame.step_twist, frame.step_centre_velocity}, frame.qdot_step);
    rebuilt.compare(group + "speed", r.speed, speed);
    // A row below its cap is met, with a force exactly.
    if (r.lambda < 0) {
      shape.insert(group + "lambda");
    }
    if (r.lambda < (1 - cap_tolerance) * r.cap) {
      ask_miss_ = worse(ask_miss_, r.lambda > 0 ? std::abs(speed - r.command) : r.command - speed);
    }
    most_ = worse(most_, r.lambda == 0 ? 0 : r.lambda / r.cap);
    const Eigen::VectorXd column = force_of(model, frame.kin, row, 1);
    seen.force += r.lambda * column;
    if (r.end == KnotEnd::neither) {
      seen.others = true;
    } else {
      seen.columns.col(2 * static_cast<int>(r.end) + r.along) = column;
    }
  }
  return seen;
}

Row ThigmotaxisAudit::row_of(const AuditedFrame& frame, const LoggedRow& row) const {
  const Contact contact = contact_of(log_.model, frame.segments, row.spline_a, row.spline_b);
  const BodyEnd towards = row.sense > 0 ? BodyEnd::head : BodyEnd::tail;
  return eq6_rows(log_.model, frame.kin, frame.segments,
                  {contact, {0, 0}, towards, 1, row.end, Eq6Slip::paper},
                  log_.resolved.scene)[static_cast<std::size_t>(row.along)];
}

std::vector<ThigmotaxisAudit::LoggedRow> ThigmotaxisAudit::rows_at_ends(
    const AuditedFrame& frame) const {
  const Eigen::Index f = frame.index;
  const double sense = towards_tail(log_.resolved.scene, frame.phase) ? -1 : 1;
  std::vector<LoggedRow> rows;
  for (const KnotEnd end : {KnotEnd::first, KnotEnd::last}) {
    const auto place = static_cast<Eigen::Index>(end);
    const double a = spline_a_(f, place);
    const double b = spline_b_(f, place);
    for (const int along : {0, 1}) {
      const Eigen::Index k = 2 * place + along;
      if (std::isnan(command_(f, k)) || !on_spline(log_.model, a) || !on_spline(log_.model, b)) {
        continue;
      }
      rows.push_back({end, along, sense, a, b, command_(f, k), cap_[static_cast<std::size_t>(f)],
                      lambda_(f, k), speed_(f, k)});
    }
  }
  return rows;
}

std::vector<ThigmotaxisAudit::LoggedRow> ThigmotaxisAudit::rows_of_table(
    const AuditedFrame& frame, std::set<std::string>& shape) {
  std::vector<LoggedRow> rows;
  for (; next_row_ < frame_.size() && frame_[next_row_] == frame.index; ++next_row_) {
    const std::size_t i = next_row_;
    if (!on_spline(log_.model, row_a_[i]) || !on_spline(log_.model, row_b_[i]) ||
        !std::isfinite(row_command_[i]) || std::abs(towards_[i]) != 1) {
      shape.insert("/eq6");
      continue;
    }
    rows.push_back({static_cast<KnotEnd>(end_[i]), static_cast<int>(along_[i]),
                    static_cast<double>(towards_[i]), row_a_[i], row_b_[i], row_command_[i],
                    row_cap_[i], row_lambda_[i], row_speed_[i]});
  }
  // Rows of frames that come later, or never.
  if (next_row_ < frame_.size() &&
      (frame_[next_row_] < frame.index || frame.index + 1 == log_.begun)) {
    shape.insert("/eq6/frame");
  }
  return rows;
}

void ThigmotaxisAudit::see_extent(const AuditedFrame& frame, const std::vector<LoggedRow>& rows) {
  int last = -1;  // without rows there is no force at all
  for (const LoggedRow& r : rows) {
    const Contact at = contact_of(log_.model, frame.segments, r.spline_a, r.spline_b);
    last = std::max(last, last_loaded(frame.segments, log_.resolved.scene, at, r.end));
  }
  if (last + 1 >= log_.model.body_count()) return;
  const int first_dof = log_.model.bodies[last + 1].first_dof;
  for (const double force : force_.row(frame.index).tail(log_.model.nv() - first_dof)) {
    past_ = worse(past_, std::abs(force));
  }
}

std::vector<Finding> ThigmotaxisAudit::findings() const {
  return {judged_over({"thigmotaxis as asked", ask_miss_, ask_tolerance, "cm/s"},
                      "rows below their cap"),
          judged_over({"thigmotaxis cap", most_, 1 + cap_tolerance, "of the cap of its row"},
                      "largest multiplier"),
          judged_over({"f_thigmo past the knot", past_, 0, "dyn cm"})};
}

}  // namespace hagfish
