// The part of an audit that rebuilds the rows of Eq. 6: what they gave for what they were asked,
// and with what force.
#pragma once

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "core/control/laws.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/rebuilt.hpp"

namespace hagfish {

/// The tailmost body that rows of Eq. 6 at a contact may load, where the body is as `segments` are.
/// A spline point loads the four bodies about it. At an end of the knot the rows hold over a patch
/// (ControllerSettings::contact_patch). In the middle of a step, to which the body has moved on,
/// this may reach further tailward than the contact that was found at its start.
int last_loaded(const std::vector<SplineSegment>& segments, const Scene& scene,
                const Contact& contact, KnotEnd end);

class ThigmotaxisAudit {
 public:
  /// The log is referred to.
  explicit ThigmotaxisAudit(const LogContents& log);

  /// What the rows of a frame come to.
  struct Rows {
    Eigen::MatrixXd columns;  ///< C' of those at the knot's ends, nv x 4, zero where there is none
    Eigen::VectorXd force;    ///< force of all rows, generalised, nv
    bool others = false;      ///< some are at other contacts
  };
  /// Frames in their order. Datasets go to `rebuilt`; those with a force that pulls to `shape`.
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

}  // namespace hagfish
