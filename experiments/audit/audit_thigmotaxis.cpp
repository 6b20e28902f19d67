#include "experiments/audit/audit_thigmotaxis.hpp"

#include <algorithm>
#include <optional>

#include "core/log/frame_rows.hpp"
#include "experiments/audit/row_force.hpp"

namespace hagfish {
namespace {

/// Speeds of rows are met to 1e-8 of the largest in the step, some 10 cm/s (Ipopt).
constexpr double ask_tolerance = 1e-5;  // cm/s
constexpr double cap_tolerance = 1e-6;
/// A slack of nothing but rounding has no scale of its own, cm/s.
constexpr double eq6_slack_tolerance = 1e-9;

/// The knot goes to the tail in this phase: both tangents turn.
bool towards_tail(const Scene& scene, Phase phase) {
  return phase == Phase::reverse ||
         (phase == Phase::release && scene.controller.leave_by == BodyEnd::tail);
}

/// Commanded speeds of a phase: first strand a, b, last a, b, cm/s; nan without rows.
Eigen::Vector4d commands(const Scene& scene, Phase phase) {
  const ControllerSettings& c = scene.controller;
  const auto four = [](const ThigmotaxisSpeeds& first, const ThigmotaxisSpeeds& last) {
    return Eigen::Vector4d(first.a, first.b, last.a, last.b);
  };
  if (phase == Phase::form || phase == Phase::free) {
    return Eigen::Vector4d::Constant(NAN);
  }
  if (phase == Phase::tighten) {
    return four(c.tighten_head, c.tighten_tail);
  }
  return towards_tail(scene, phase) ? four(c.reverse_head, c.reverse_tail)
                                    : four(c.slide_head, c.slide_tail);
}

}  // namespace

double nearest_body(double place, double logged) {
  constexpr double rounding = 1e-13;  // of places up to some hundred
  return std::abs(place - logged) <= 0.5 + rounding ? logged : std::floor(place + 0.5);
}

int last_loaded(const std::vector<SplineSegment>& segments, const Scene& scene,
                const Contact& contact, KnotEnd end) {
  std::vector<PatchPoint> patch;
  if (end != KnotEnd::neither) {
    contact_patch(segments, scene, contact, end == KnotEnd::last, patch);
  }
  int last = patch.empty() ? contact.segment_b : 0;
  for (const PatchPoint& point : patch) last = std::max(last, point.contact.segment_b);
  return last + 2;
}

ThigmotaxisAudit::ThigmotaxisAudit(const LogContents& log)
    : log_(log),
      law_(law_of(log.resolved.scene)),
      table_(law_.logs_rows),
      force_(log.h5.rows("/forces/thigmotaxis")),
      lambda_(log.h5.rows("/thigmotaxis/lambda")),
      command_(log.h5.rows("/thigmotaxis/command")),
      speed_(log.h5.rows("/thigmotaxis/speed")),
      spline_a_(log.h5.rows("/thigmotaxis/spline_a")),
      spline_b_(log.h5.rows("/thigmotaxis/spline_b")),
      body_a_(log.h5.rows("/thigmotaxis/body_a")),
      body_b_(log.h5.rows("/thigmotaxis/body_b")),
      cap_(log.h5.doubles("/thigmotaxis/cap")) {
  if (!table_) {
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
  row_slack_ = doubles("slack");
}

ThigmotaxisAudit::Rows ThigmotaxisAudit::see(const AuditedFrame& frame, Rebuilt& rebuilt,
                                             std::set<std::string>& shape) {
  const Model& model = log_.model;
  const double cap_of_rows = cap_of_scene(frame, cap_[frame.index]);
  std::vector<LoggedRow> rows;
  if (table_) {
    rows = rows_of_table(frame, rebuilt, shape);
    see_commands(frame, rows, cap_of_rows, rebuilt);
    see_ends(frame, rows, rebuilt);
  } else {
    rows = rows_at_ends(frame, rebuilt);
    rebuilt.compare("/thigmotaxis/cap", cap_[frame.index], rows.empty() ? NAN : cap_of_rows);
  }
  see_extent(frame, rows);
  Rows seen{Eigen::MatrixXd::Zero(model.nv(), 4), Eigen::VectorXd::Zero(model.nv())};
  const std::string group = table_ ? "/eq6/" : "/thigmotaxis/";
  for (const LoggedRow& r : rows) {
    const Row row = rows_of(frame, r, {0, 0}, Eq6Slip::paper)[static_cast<std::size_t>(r.along)];
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
    seen.bearing += r.lambda != 0 ? 1 : 0;
    if (r.end == KnotEnd::neither) {
      seen.others = true;
    } else {
      seen.columns.col(r.place()) = column;
    }
  }
  return seen;
}

std::array<Row, 2> ThigmotaxisAudit::rows_of(const AuditedFrame& frame, const LoggedRow& row,
                                             const Eigen::Vector2d& speed, Eq6Slip slip) const {
  const Contact contact = contact_of(log_.model, frame.segments, row.spline_a, row.spline_b);
  const BodyEnd towards = row.sense > 0 ? BodyEnd::head : BodyEnd::tail;
  return eq6_rows(log_.model, frame.kin, frame.segments,
                  {contact, {speed[0], speed[1]}, towards, 1, row.end, slip}, log_.resolved.scene);
}

Eigen::Vector2d ThigmotaxisAudit::asked(const AuditedFrame& frame, const LoggedRow& row,
                                        const Eigen::Vector2d& speed, Eq6Slip slip) const {
  const std::array<Row, 2> rows = rows_of(frame, row, speed, slip);
  return {rows[0].rhs, rows[1].rhs};
}

std::vector<ThigmotaxisAudit::LoggedRow> ThigmotaxisAudit::rows_at_ends(const AuditedFrame& frame,
                                                                        Rebuilt& rebuilt) const {
  const Eigen::Index f = frame.index;
  const Scene& scene = log_.resolved.scene;
  const Eigen::Vector4d commanded = commands(scene, frame.phase);
  std::vector<LoggedRow> rows;
  for (const KnotEnd end : {KnotEnd::first, KnotEnd::last}) {
    const auto place = static_cast<Eigen::Index>(end);
    const double a = spline_a_(f, place);
    const double b = spline_b_(f, place);
    const bool there =
        on_spline(log_.model, a) && on_spline(log_.model, b) && !std::isnan(commanded[0]);
    see_bodies(f, place, there ? a : NAN, there ? b : NAN, rebuilt);
    const Eigen::Vector2d wanted =
        there ? asked(frame, {.end = end, .spline_a = a, .spline_b = b},
                      commanded.segment<2>(2 * place), scene.controller.eq6_slip)
              : Eigen::Vector2d::Constant(NAN);
    for (const int along : {0, 1}) {
      const Eigen::Index k = 2 * place + along;
      rebuilt.compare("/thigmotaxis/command", command_(f, k), wanted[along]);
      if (!there) {
        rebuilt.compare("/thigmotaxis/speed", speed_(f, k), NAN);
        rebuilt.compare("/thigmotaxis/lambda", lambda_(f, k), 0);
        continue;
      }
      rows.push_back({end, along, towards_tail(scene, frame.phase) ? -1.0 : 1.0, a, b,
                      wanted[along], cap_[f], lambda_(f, k), speed_(f, k)});
    }
  }
  return rows;
}

std::vector<ThigmotaxisAudit::LoggedRow> ThigmotaxisAudit::rows_of_table(
    const AuditedFrame& frame, Rebuilt& rebuilt, std::set<std::string>& shape) {
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
    rebuilt.compare("/eq6/slack", row_slack_[i], std::max(0.0, row_command_[i] - row_speed_[i]),
                    eq6_slack_tolerance);
  }
  // Rows of frames that come later, or never.
  if (next_row_ < frame_.size() &&
      (frame_[next_row_] < frame.index || frame.index + 1 == log_.begun)) {
    shape.insert("/eq6/frame");
  }
  return rows;
}

void ThigmotaxisAudit::see_commands(const AuditedFrame& frame, const std::vector<LoggedRow>& rows,
                                    double cap, Rebuilt& rebuilt) const {
  const Scene& scene = log_.resolved.scene;
  if (log_.own_law()) return;
  const AskedRows scaled = asked_rows(frame.phase);
  const Eigen::Vector4d commanded = commands(scene, frame.phase);
  std::optional<double> scale;  // the same of all rows
  for (const LoggedRow& r : rows) {
    const bool other = r.end == KnotEnd::neither;
    double wanted = asked(frame, r, commanded.segment<2>(other ? 0 : r.place() - r.along),
                          other ? Eq6Slip::shape : scene.controller.eq6_slip)[r.along];
    if (scaled.least_scale < scaled.most_scale && wanted != 0) {
      scale = scale.value_or(std::clamp(r.command / wanted, scaled.least_scale, scaled.most_scale));
      wanted *= *scale;
    }
    rebuilt.compare("/eq6/command", r.command, wanted);
    rebuilt.compare("/eq6/cap", r.cap, cap);
    rebuilt.compare_exactly("/eq6/towards", std::llround(r.sense),
                            towards_tail(scene, frame.phase) ? -1 : 1);
  }
}

void ThigmotaxisAudit::see_bodies(Eigen::Index frame, Eigen::Index end, double a, double b,
                                  Rebuilt& rebuilt) const {
  const auto see = [&](const char* path, double logged, double place) {
    rebuilt.compare(path, logged, std::isnan(place) ? -1 : nearest_body(place, logged));
  };
  see("/thigmotaxis/body_a", body_a_(frame, end), a);
  see("/thigmotaxis/body_b", body_b_(frame, end), b);
}

void ThigmotaxisAudit::see_ends(const AuditedFrame& frame, const std::vector<LoggedRow>& rows,
                                Rebuilt& rebuilt) const {
  const Eigen::Index f = frame.index;
  const bool commanded =
      asked_rows(frame.phase).any && !std::isnan(commands(log_.resolved.scene, frame.phase)[0]);
  double cap = NAN;
  for (const LoggedRow& r : rows) {
    cap = r.end == KnotEnd::neither ? cap : r.cap;
  }
  rebuilt.compare("/thigmotaxis/cap", cap_[f], cap);
  for (Eigen::Index k = 0; k < 4; ++k) {
    const auto row = std::ranges::find_if(
        rows, [k](const LoggedRow& r) { return r.end != KnotEnd::neither && r.place() == k; });
    const bool there = row != rows.end();
    see_bodies(f, k / 2, there ? row->spline_a : NAN, there ? row->spline_b : NAN, rebuilt);
    rebuilt.compare("/thigmotaxis/command", command_(f, k), there ? row->command : NAN);
    rebuilt.compare("/thigmotaxis/speed", speed_(f, k), there ? row->speed : NAN);
    rebuilt.compare("/thigmotaxis/lambda", lambda_(f, k), there ? row->lambda : 0);
    if (!log_.own_law()) {
      const bool wanted = commanded && on_spline(log_.model, spline_a_(f, k / 2));
      rebuilt.compare_exactly("/eq6/end", there ? 1 : 0, wanted ? 1 : 0);
    }
  }
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

AskedRows ThigmotaxisAudit::asked_rows(Phase phase) const {
  return law_.rows == nullptr ? AskedRows{} : law_.rows(log_.resolved.scene, phase);
}

double ThigmotaxisAudit::cap_of_scene(const AuditedFrame& frame, double logged) {
  const Scene& scene = log_.resolved.scene;
  if (frame.phase != Phase::pull) {
    pull_from_ = log_.time[frame.index];
    return asked_rows(frame.phase).effort * scene.controller.cap;
  }
  // The pull began after the last frame before it; of a log that begins with it, at any time.
  const Ramp& cap = scene.food.cap;
  const double frame_time = scene.time.frame_interval;
  const bool known = !std::isnan(pull_from_);
  const double since = known ? log_.time[frame.index] - pull_from_ : INFINITY;
  return std::clamp(logged, cap.at(known ? since - frame_time : 0), cap.at(since));
}

std::vector<Finding> ThigmotaxisAudit::findings() const {
  return {judged_over({"thigmotaxis as asked", ask_miss_, ask_tolerance, "cm/s"},
                      "rows below their cap"),
          judged_over({"thigmotaxis cap", most_, 1 + cap_tolerance, "of controller.cap"},
                      "largest multiplier"),
          judged_over({"f_thigmo past the knot", past_, 0, "dyn cm"})};
}

}  // namespace hagfish
