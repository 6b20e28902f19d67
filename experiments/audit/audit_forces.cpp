#include "experiments/audit/audit_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "experiments/audit/row_force.hpp"

namespace hagfish {
namespace {

/// How far from its limit a joint that bears on it may end a step, rad: the speed of Ipopt's rows
/// is met to 1e-8 of the largest, some rad/s, over a step of some ms.
constexpr double limit_tolerance = 1e-8;
/// Of |H (q̇ - q̇*) - h Σ f| and its scale: both are rounded.
constexpr double balance_tolerance = 1e-9;
/// A cone is followed by tangents, rad: a step's end may be this far inside or past it, and the
/// force that far turned from the bend.
constexpr double cone_tolerance = 2e-5;
constexpr double cone_turn_tolerance = 0.1;
/// Mean f_thigmo is not C' of the mean multipliers exactly, as contacts move along the strands
/// between two frames, and an end of the knot that touches two strands at once goes from one to
/// the other within a frame. A wrong column or sign is off at all frames: so the lowest
/// tenth tells it.
constexpr double mean_tolerance = 0.09;
constexpr double mean_tolerance_growth = 1;     // 1/s
constexpr double largest_mean_tolerance = 0.3;  // beyond it the finding would say nothing
constexpr std::size_t least_means = 5;          // for a median
/// Rows that a step's own path shows change its velocity after its middle has settled: at up to
/// this share of the frames. Seen: 0.15 at 10 ms, 0.5 at 20 ms.
constexpr double unsettled_share = 0.75;

/// |a - b| over the largest of both and of `least_scale`, in infinity norms; infinite where one is
/// no number. Sums of forces that hold each other are nothing but rounding, their parts are not.
double mismatch(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double least_scale = 0) {
  const double off = (a - b).lpNorm<Eigen::Infinity>();
  const double scale =
      std::max({a.lpNorm<Eigen::Infinity>(), b.lpNorm<Eigen::Infinity>(), least_scale});
  return !(a - b).allFinite() ? INFINITY : (off > 0 ? off / scale : 0);
}

/// What a frame's forces of all kinds and torques of muscles add up to, and the largest entry of
/// any of them.
std::pair<Eigen::VectorXd, double> sum_of_kinds(const ByKind<Hdf5Reader::Rows>& forces,
                                                const Hdf5Reader::Rows& active, Eigen::Index f) {
  Eigen::VectorXd sum = active.row(f);
  double largest = sum.lpNorm<Eigen::Infinity>();
  for (const RowKindEntry& kind : row_kind_table) {
    const Eigen::VectorXd force = forces[kind.value].row(f);
    sum += force;
    largest = std::max(largest, force.lpNorm<Eigen::Infinity>());
  }
  return {sum, largest};
}

/// Of at least one value.
double lowest_tenth(std::vector<double> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 10);
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace

ForceAudit::ForceAudit(const LogContents& log)
    : log_(log),
      rows_(log),
      tip_(log.h5.rows("/forces/tip")),
      active_torque_(log.h5.rows("/forces/active")),
      mean_active_(log.h5.rows("/mean/forces/active")),
      mean_net_(log.h5.rows("/mean/forces/net")),
      mean_lambda_(log.h5.rows("/mean/thigmotaxis/lambda")),
      contacts_(logged_contacts(log)),
      remaining_(log.midpoint() ? log.h5.doubles("/steps/remaining") : std::vector<double>{}),
      steps_(log) {
  for (const RowKindEntry& kind : row_kind_table) {
    force_[kind.value] = log.h5.rows(std::string("/forces/") + kind.name);
    mean_[kind.value] = log.h5.rows(std::string("/mean/forces/") + kind.name);
  }
}

void ForceAudit::see(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  if (!frame.begins_step) {
    const Eigen::Index nv = log_.model.nv();
    see_means(frame, {Eigen::MatrixXd::Zero(nv, 4), Eigen::VectorXd::Zero(nv)});
    return;
  }
  const ThigmotaxisAudit::Rows rows = rows_.see(frame, from_rows_, shape_);
  from_rows_.compare("/forces/thigmotaxis", force_[RowKind::thigmotaxis].row(f).transpose(),
                     rows.force);
  see_contacts(frame);
  see_limits(frame);
  see_head(frame);
  see_balance(frame);
  if (frame.index > 0) {
    see_means(frame, rows);
  }
  rows_before_ = rows;
}

void ForceAudit::see_contacts(const AuditedFrame& frame) {
  const Model& model = log_.model;
  Eigen::VectorXd contact = Eigen::VectorXd::Zero(model.nv());
  Eigen::VectorXd wall = contact;
  for (; next_contact_ < contacts_.size() && contacts_[next_contact_].frame == frame.index;
       ++next_contact_) {
    const LoggedContact& one = contacts_[next_contact_];
    if (!is_placed(model, one) || !(one.force > 0)) {
      shape_.insert("/contacts");
      continue;
    }
    const Eigen::Vector3d normal = push_of(log_, frame, one);
    (one.obstacle < 0 ? contact : wall) +=
        force_of(model, frame.kin, motion_row(model, normal, one.a, one.b), one.force);
  }
  from_rows_.compare("/forces/contact", force_[RowKind::contact].row(frame.index).transpose(),
                     contact);
  from_rows_.compare("/forces/wall", force_[RowKind::obstacle].row(frame.index).transpose(), wall);
}

void ForceAudit::see_limits(const AuditedFrame& frame) {
  const Model& model = log_.model;
  const Scene& scene = log_.resolved.scene;
  const double h = scene.time.step;
  const Eigen::VectorXd force = force_[RowKind::limit].row(frame.index);
  if ((force.head(root_dofs).array() != 0).any()) {
    shape_.insert("/forces/limit");
  }
  std::vector<char> of_cone(model.nv(), 0);
  for (const BendingCone& cone : model.cones) {
    of_cone[cone.dof] = of_cone[cone.dof + 1] = 1;
    see_cone(frame, cone, force.segment<2>(cone.dof));
  }
  for (Eigen::Index k = root_dofs; k < model.nv(); ++k) {
    if (force[k] == 0 || of_cone[k] != 0) {
      continue;
    }
    // A row with a force is met exactly: the joint ends at its limit, or as far back as baumgarte
    // says.
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double angle = frame.state.q[k + 1];
    const double gap = force[k] > 0 ? angle - hinge.lower : hinge.upper - angle;
    const double speed = (force[k] > 0 ? 1 : -1) * frame.qdot_step[k];
    const double wanted = gap >= 0 ? -gap / h : -scene.constraints.baumgarte * gap / h;
    limit_miss_ = worse(limit_miss_, std::abs(speed - wanted) * h);
  }
}

void ForceAudit::see_cone(const AuditedFrame& frame, const BendingCone& cone,
                          const Eigen::Vector2d& force) {
  if (force.isZero(0)) {
    return;
  }
  const auto bend_of = [&cone](const Eigen::VectorXd& q) {
    return total_bend(q[cone.dof + 1], q[cone.dof + 2]);
  };
  const double h = log_.resolved.scene.time.step;
  const double left =
      (1 - log_.resolved.scene.constraints.baumgarte) * past_cone(cone, frame.state.q);
  const Bend end = bend_of(advance(frame.state.q, frame.qdot_step, h));
  cone_miss_ = worse(cone_miss_, std::abs(end.angle - cone.limit - left));
  // Every tangent that a step takes pushes back the way the joint bends.
  const double along = -force.dot(end.slope) / (force.norm() * end.slope.norm());
  cone_turn_ = worse(cone_turn_, std::acos(std::min(along, 1.0)));
}

void ForceAudit::see_head(const AuditedFrame& frame) {
  const Eigen::VectorXd force = force_[RowKind::head].row(frame.index);
  const Eigen::Index first_free = frame.clamped ? root_dofs : 0;
  if ((force.tail(force.size() - first_free).array() != 0).any()) {
    shape_.insert("/forces/head");
  }
}

void ForceAudit::see_balance(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  const Model& model = log_.model;
  // H times the mean velocity, which by the midpoint rule is half of the way to the next velocity.
  const TimeSettings& time = log_.resolved.scene.time;
  const double reach = time.reach();
  StepSystem system;
  assemble_step_system(model, frame.state, frame.motion, frame.kin, {tip_.row(f).transpose(), 0},
                       {reach, time.spring_damping()}, system);
  const auto [sum, largest] = sum_of_kinds(force_, active_torque_, f);
  const Eigen::VectorXd given =
      generalised_force(model, frame.kin, system.wrench) + system.joint + reach * sum;
  if (log_.midpoint()) {
    const Eigen::VectorXd off = frame.qdot_step - frame.midway.step_velocity;
    const std::size_t step = steps_.at(f);
    const double left = remaining_[step] * off.lpNorm<Eigen::Infinity>();
    unsettled_ += left <= time.settled ? 0 : 1;
  }
  imbalance_ = worse(
      imbalance_,
      mismatch(given, multiply(model, frame.kin, system.op, frame.qdot_mean), reach * largest));
  momentum_before_ = momentum_;
  momentum_ = given.lpNorm<Eigen::Infinity>() / time.step;
}

void ForceAudit::see_means(const AuditedFrame& frame, const ThigmotaxisAudit::Rows& rows) {
  const Eigen::Index f = frame.index;
  const auto row = [f](const Hdf5Reader::Rows& of) -> Eigen::VectorXd { return of.row(f); };
  const auto [sum, largest] = sum_of_kinds(mean_, mean_active_, f);
  // Forces alone may be nothing but rounding of the momentum.
  mean_imbalance_ =
      worse(mean_imbalance_,
            mismatch(sum, row(mean_net_), std::max({momentum_, momentum_before_, largest})));
  const auto ask = [this](const std::string& path, bool met) {
    if (!met) {
      shape_.insert(path);
    }
  };
  const Eigen::VectorXd wall = row(mean_[RowKind::obstacle]);
  const Eigen::Index hinges = sum.size() - root_dofs;
  ask("/mean/forces/limit", row(mean_[RowKind::limit]).head(root_dofs).isZero(0));
  // Muscles hold on to nothing outside.
  ask("/forces/active", row(active_torque_).head(root_dofs).isZero(0) || !frame.begins_step);
  ask("/mean/forces/active", row(mean_active_).head(root_dofs).isZero(0));
  ask("/mean/forces/head", row(mean_[RowKind::head]).tail(hinges).isZero(0));
  // Action is reaction within the body, not at obstacles. The head plate pushes tailward.
  const auto internal = [](const Eigen::VectorXd& force) {
    return force.head<3>().lpNorm<Eigen::Infinity>() <=
           rebuilt_tolerance * force.lpNorm<Eigen::Infinity>();
  };
  for (const RowKindEntry& kind : row_kind_table) {
    if (kind.from_outside) continue;
    ask(std::string("/mean/forces/") + kind.name, internal(row(mean_[kind.value])));
  }
  ask("/mean/forces/wall", !log_.resolved.scene.obstacles.empty() || wall.isZero(0) || wall[0] > 0);
  // Multipliers of rows at other contacts, which come and go, are not known as means.
  if (rows.others || rows_before_.others) {
    return;
  }
  const Eigen::MatrixXd& columns = rows.columns;
  const Eigen::MatrixXd& before = rows_before_.columns;
  const Eigen::VectorXd expected = 0.5 * (columns + before) * mean_lambda_.row(f).transpose();
  if ((columns.array() != 0).any() && (before.array() != 0).any()) {
    mean_deviation_.push_back(mismatch(row(mean_[RowKind::thigmotaxis]), expected));
  }
}

std::vector<Finding> ForceAudit::findings() const {
  std::vector<Finding> findings{
      from_rows_.finding("forces of rows", "q, spline parameters and multipliers")};
  findings.push_back(judged_over({"limits bear at limits", limit_miss_, limit_tolerance,
                                  "rad from the limit at the step's end"},
                                 "/forces/limit"));
  if (!log_.model.cones.empty()) {
    findings.push_back(judged_over(
        {"cones bear at cones", cone_miss_, cone_tolerance, "rad from the cone at the step's end"},
        "/forces/limit"));
    findings.push_back(judged_over(
        {"cones push back", cone_turn_, cone_turn_tolerance, "rad from the way the joint bends"},
        "/forces/limit"));
  }
  for (const Finding& finding : rows_.findings()) {
    findings.push_back(finding);
  }
  std::set<std::string> shape = shape_;
  if (next_contact_ != contacts_.size()) shape.insert("/contacts/frame");
  findings.push_back(judged(
      {"shape of forces", static_cast<double>(shape.size()), 0, "datasets"},
      shape.empty() ? "each kind acts where it can, contacts push"
                    : fmt::format("act where they cannot, or pull: {}", fmt::join(shape, ", "))));
  findings.push_back(judged_over({"force balance", imbalance_, balance_tolerance, "of scale"},
                                 "H(q̇ - q̇*) - h Σ f recomputed at every frame"));
  if (log_.midpoint()) {
    const double share = unsettled_ / static_cast<double>(log_.q.rows());
    findings.push_back(judged_over({"middle of steps", share, unsettled_share, "of the frames"},
                                   "further from where /midway/qdot leads than time.settled"));
  }
  findings.push_back(
      judged_over({"balance of means", mean_imbalance_, balance_tolerance, "of scale"},
                  "Σ /mean/forces against /mean/forces/net at every frame"));
  const double tolerance =
      mean_tolerance + mean_tolerance_growth * log_.resolved.scene.time.frame_interval;
  if (mean_deviation_.size() >= least_means && tolerance <= largest_mean_tolerance) {
    findings.push_back(
        judged_over({"means of f_thigmo", lowest_tenth(mean_deviation_), tolerance, "of scale"},
                    "lowest tenth of frames, against C' of the mean multipliers"));
  }
  return findings;
}

}  // namespace hagfish
