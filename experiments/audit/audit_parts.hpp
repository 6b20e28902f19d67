// The parts of an audit. Each sees the frames of a log, to which it refers, in their order, and
// then has findings.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/control/laws.hpp"
#include "core/muscle/activation.hpp"
#include "experiments/audit/audit.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/logged_contacts.hpp"
#include "experiments/audit/rebuilt.hpp"
#include "experiments/judge/expectations.hpp"

namespace hagfish {

/// Follows the body from frame to frame: its contacts, and that it goes where its velocities take
/// it.
class FrameAudit {
 public:
  explicit FrameAudit(const LogContents& log);
  void see(const AuditedFrame& frame);
  std::vector<Finding> findings() const;

 private:
  void see_ends(const AuditedFrame& frame);
  void see_contacts(const AuditedFrame& frame);
  void see_motion(const AuditedFrame& frame);

  const LogContents& log_;
  Steps steps_;
  std::vector<std::int64_t> contacts_;
  std::vector<LoggedContact> bearing_;
  std::vector<double> left_out_;
  Hdf5Reader::Rows spline_a_, spline_b_;
  std::int64_t frames_ = 0, contacts_off_ = 0, contacts_off_by_ = 0, followed_ = 0, late_ = 0;
  /// The centre of mass at the frame before, cm, its velocity there, cm/s, and the
  /// furthest that it was off since, of what is allowed.
  Eigen::Vector3d centre_before_ = Eigen::Vector3d::Zero(), left_with_ = centre_before_;
  double off_way_ = 0;
};

/// The tailmost body that rows of Eq. 6 at a contact may load, where the body is as `segments` are.
/// A spline point loads the four bodies about it. At an end of the knot the rows hold over a patch
/// (ControllerSettings::contact_patch). In the middle of a step, to which the body has moved on,
/// this may reach further tailward than the contact that was found at its start.
int last_loaded(const std::vector<SplineSegment>& segments, const Scene& scene,
                const Contact& contact, KnotEnd end);

/// Rebuilds the rows of Eq. 6: what they gave for what they were asked, and with what force.
class ThigmotaxisAudit {
 public:
  explicit ThigmotaxisAudit(const LogContents& log);

  /// What the rows of a frame come to.
  struct Rows {
    Eigen::MatrixXd columns;  ///< C' of those at the knot's ends, nv x 4, zero where there is none
    Eigen::VectorXd force;    ///< force of all rows, generalised, nv
    bool others = false;      ///< some are at other contacts
  };
  /// Datasets go to `rebuilt`; those with a force that pulls to `shape`.
  Rows see(const AuditedFrame& frame, Rebuilt& rebuilt, std::set<std::string>& shape);

  /// "thigmotaxis as asked", "thigmotaxis cap" and "f_thigmo past the knot".
  std::vector<Finding> findings() const;

 private:
  /// A row of Eq. 6 as the log has it.
  struct LoggedRow {
    KnotEnd end = KnotEnd::neither;
    int along = 0;     ///< 0 t_a, 1 t_b
    double sense = 1;  ///< sign of both tangents
    double spline_a = 0, spline_b = 0, command = 0, cap = 0, lambda = 0, speed = 0;
  };
  /// The rows of a frame, from /thigmotaxis by the paper's law, else from /eq6.
  std::vector<LoggedRow> rows_at_ends(const AuditedFrame& frame) const;
  std::vector<LoggedRow> rows_of_table(const AuditedFrame& frame, std::set<std::string>& shape);
  Row row_of(const AuditedFrame& frame, const LoggedRow& row) const;
  /// The force against the reach of the rows.
  void see_extent(const AuditedFrame& frame, const std::vector<LoggedRow>& rows);

  const LogContents& log_;
  bool table_;  ///< the rows are those of /eq6
  Hdf5Reader::Rows force_;
  Hdf5Reader::Rows lambda_, command_, speed_, spline_a_, spline_b_;  ///< /thigmotaxis
  std::vector<double> cap_;
  std::vector<std::int64_t> frame_, end_, along_, towards_;  ///< /eq6
  std::vector<double> row_a_, row_b_, row_command_, row_cap_, row_lambda_, row_speed_;
  std::size_t next_row_ = 0;  ///< first one of frames not seen yet
  double ask_miss_ = 0, most_ = 0, past_ = 0;
};

/// Recomputes every force from q, q̇, the contacts' spline parameters and the multipliers, and holds
/// their sum against the motion.
class ForceAudit {
 public:
  explicit ForceAudit(const LogContents& log);
  void see(const AuditedFrame& frame);
  std::vector<Finding> findings() const;

 private:
  void see_contacts(const AuditedFrame& frame);
  void see_limits(const AuditedFrame& frame);
  /// `force` on the two hinges of a cone's joint, dyn cm.
  void see_cone(const AuditedFrame& frame, const BendingCone& cone, const Eigen::Vector2d& force);
  void see_head(const AuditedFrame& frame);
  void see_balance(const AuditedFrame& frame);
  void see_means(const AuditedFrame& frame, const ThigmotaxisAudit::Rows& rows);

  const LogContents& log_;
  ThigmotaxisAudit rows_;
  ByKind<Hdf5Reader::Rows> force_, mean_;
  Hdf5Reader::Rows tip_, active_torque_, mean_active_, mean_net_, mean_lambda_;
  std::vector<LoggedContact> contacts_;
  std::vector<double> remaining_;  ///< StepMiddle::remaining of each step, by the midpoint rule
  Steps steps_;
  std::size_t next_contact_ = 0;  ///< first one of frames not seen yet
  Rebuilt from_rows_;
  double imbalance_ = 0, unsettled_ = 0, mean_imbalance_ = 0, limit_miss_ = 0, cone_miss_ = 0,
         cone_turn_ = 0;
  double momentum_ = 0, momentum_before_ = 0;  ///< largest over h, at this frame and the one before
  std::set<std::string> shape_;                ///< datasets with a force where there can be none
  ThigmotaxisAudit::Rows rows_before_;         ///< rows of the frame before
  std::vector<double> mean_deviation_;         ///< how far mean f_thigmo is off C' mean λ, shares
};

/// Recomputes the forces of flesh from q and q̇ by their law, and the energy that it stores, its
/// deepest overlap and its largest pressure by a search of its own.
class FleshAudit {
 public:
  explicit FleshAudit(const LogContents& log);
  void see(const AuditedFrame& frame);
  /// None of a scene with hard contact.
  std::vector<Finding> findings() const;

 private:
  /// Of one frame: energy stored, erg; deepest overlap, cm; largest pressure, dyn/cm².
  struct Pressed {
    double energy = 0, overlap = 0, pressure = 0;
  };
  /// Adds a point of a length (cm) and its curvature, 1/r of both skins, 1/cm; none of a gap > 0.
  void press(double gap, double weight, double curvature, Pressed& pressed) const;
  void press_strands(const std::vector<SplineSegment>& segments, Pressed& pressed) const;
  void press_planes(const Kinematics& kin, Pressed& pressed) const;
  double weight_of(const AuditedFrame& frame, const LoggedContact& contact) const;

  const LogContents& log_;
  std::vector<LoggedContact> contacts_;
  std::vector<double> energy_, overlap_, pressure_;  ///< of frames; the last two x bodies
  std::size_t next_contact_ = 0;                     ///< first one of frames not seen yet
  Rebuilt rebuilt_;
};

/// Recomputes /muscle: what activations make of the logged shape.
class ActivationAudit {
 public:
  explicit ActivationAudit(const LogContents& log);
  void see(const AuditedFrame& frame);
  /// None of a scene without muscles.
  std::vector<Finding> findings() const;

 private:
  void see_driven(const AuditedFrame& frame);

  const LogContents& log_;
  Hdf5Reader::Rows torque_;  ///< mean of u + f_thigmo
  Hdf5Reader::Rows activation_, residual_, driven_, active_;
  ActivationSolver solver_;
  MuscleEffort effort_;    ///< storage
  Eigen::VectorXd given_;  ///< R a F_max, storage
  Rebuilt rebuilt_;
  double beyond_ = 0;  ///< way of an activation between two frames, past what the dynamics permit
};

/// Asks MuJoCo whether the logged forces make the logged motion there too. Each frame's forces are
/// put back as applied forces in the log's own MuJoCo model, with its contacts and limits off: one
/// step must end at the logged q̇, or, by the midpoint rule, half a step at the mean of the
/// velocities before and after. Drag is the core's, at that velocity. Not judged, and so told,
/// where the program is built without MuJoCo.
class ForwardInverseAudit {
 public:
  /// Throws FileError where /mjcf is not the scene's model.
  explicit ForwardInverseAudit(const LogContents& log);
  ~ForwardInverseAudit();
  void see(const AuditedFrame& frame);
  Finding finding() const;

 private:
  struct Driven;
  std::unique_ptr<Driven> driven_;
};

}  // namespace hagfish
