#include <fmt/format.h>

#include <string>
#include <utility>

#include "core/chain/dynamics.hpp"
#include "core/log/ledger_columns.hpp"
#include "core/step/rows/row_kind.hpp"
#include "experiments/export/export_tables.hpp"

namespace hagfish {
namespace {

using namespace figure_unit;

const std::string mean = "; mean since the frame before";

std::string of(const RowKindEntry& kind) { return std::string("of: ") + kind.description; }

/// Forces of /mean/forces that act on hinges, and the column of each: all but the clamp's, on the
/// root.
std::vector<std::pair<std::string, std::string>> torque_kinds() {
  std::vector<std::pair<std::string, std::string>> kinds{{"active", "of the animal's muscles"}};
  for (const RowKindEntry& kind : row_kind_table) {
    if (kind.value != RowKind::head) kinds.emplace_back(kind.name, of(kind));
  }
  return kinds;
}

ExportTable torque_table(const LogContents& log, bool si) {
  std::vector<ExportColumn> columns{
      frame_column,
      time_column,
      {"joint", none, "by the body behind it"},
      {"axis", none,
       "bend_y, bend_z or twist, about Y, Z or X: of the body before for a joint's first row, of "
       "the body behind for its last one; joints take turns in which axis comes first"},
      {"s", centimetre, "arc length of the joint from the head's end at rest"},
      {"angle", radian, "of the hinge at the frame"},
      {"spring", torque, "of the body's own stiffness, at the frame"}};
  for (const auto& [kind, meaning] : torque_kinds()) {
    columns.push_back({kind, torque, meaning + mean});
  }
  ExportTable table("torques.csv", columns, si);
  std::vector<Hdf5Reader::Rows> kinds;
  for (const auto& [kind, meaning] : torque_kinds()) {
    kinds.push_back(log.h5.rows("/mean/forces/" + kind));
  }
  constexpr const char* axes[] = {"twist", "bend_y", "bend_z"};
  const double length = log.model.length() / log.model.body_count();
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    const Eigen::VectorXd q = log.q.row(f);
    const Eigen::VectorXd spring = stiffness_force(log.model, q);
    for (std::size_t k = 0; k < log.model.hinges.size(); ++k) {
      const Hinge& hinge = log.model.hinges[k];
      const auto dof = root_dofs + static_cast<Eigen::Index>(k);
      std::vector<ExportTable::Cell> row{std::int64_t{f},
                                         log.time[f],
                                         std::int64_t{hinge.body},
                                         std::string(axes[static_cast<int>(hinge.axis)]),
                                         hinge.body * length,
                                         q[dof + 1],
                                         spring[dof]};
      for (const Hdf5Reader::Rows& rows : kinds) row.emplace_back(rows(f, dof));
      table.add(row);
    }
  }
  return table;
}

/// What the same forces do about each joint as vectors, which unlike hinges' torques are the
/// body's.
ExportTable moment_table(const LogContents& log, bool si) {
  std::vector<ExportColumn> columns{
      frame_column,
      time_column,
      {"joint", none, "by the body behind it"},
      {"s", centimetre, "arc length of the joint from the head's end at rest"}};
  std::vector<Hdf5Reader::Rows> vectors{log.h5.rows("/trajectory/curvature")};
  const auto add = [&](const std::string& name, const auto& unit, const std::string& meaning) {
    columns.push_back({name + "_x", unit,
                       fmt::format("{}, about the X axis halfway through the joint", meaning)});
    for (const char* axis : {"_y", "_z"}) columns.push_back({name + axis, unit, "the same"});
  };
  add("turn", per_length, "turn of the joint over the body that it stands for, at the frame");
  for (const auto& [kind, meaning] : torque_kinds()) {
    add(kind, torque, "moment " + meaning + mean);
    vectors.push_back(log.h5.rows("/mean/moments/" + kind));
  }
  ExportTable table("moments.csv", columns, si);
  const double length = log.model.length() / log.model.body_count();
  for (Eigen::Index f = 0; f < log.q.rows(); ++f) {
    for (Eigen::Index joint = 1; joint < log.model.body_count(); ++joint) {
      std::vector<ExportTable::Cell> row{std::int64_t{f}, log.time[f], std::int64_t{joint},
                                         static_cast<double>(joint) * length};
      for (const Hdf5Reader::Rows& rows : vectors) {
        for (Eigen::Index k = 3 * joint; k < 3 * joint + 3; ++k) row.emplace_back(rows(f, k));
      }
      table.add(row);
    }
  }
  return table;
}

/// A column a hinge, for those who think in tables of time by place.
ExportTable joint_table(const LogContents& log, bool si) {
  std::vector<ExportColumn> columns{frame_column, time_column};
  for (int dof = root_dofs; dof < log.model.nv(); ++dof) {
    columns.push_back({dof_name(log.model, dof), torque,
                       "what the animal makes at this hinge: u + f_thigmo" + mean});
  }
  ExportTable table("joints.csv", columns, si);
  const Hdf5Reader::Rows made =
      log.h5.rows("/mean/forces/active") + log.h5.rows("/mean/forces/thigmotaxis");
  for (Eigen::Index f = 0; f < made.rows(); ++f) {
    std::vector<ExportTable::Cell> row{std::int64_t{f}, log.time[f]};
    for (int dof = root_dofs; dof < log.model.nv(); ++dof) row.emplace_back(made(f, dof));
    table.add(row);
  }
  return table;
}

ExportTable muscle_table(const LogContents& log, bool si) {
  ExportTable table("muscles.csv",
                    {frame_column,
                     time_column,
                     {"muscle", none, "its joint, by the body behind it, and place"},
                     {"s", centimetre, "arc length of the joint from the head's end at rest"},
                     {"activation", none,
                      "0 to 1, the least for the mean of u + f_thigmo since the frame before"},
                     {"force", force, "of all its lines together"},
                     {"shortfall", torque,
                      "what the muscles of its joint lack of that mean, at the hinge that lacks "
                      "most"}},
                    si);
  const Hdf5Reader::Rows activation = log.h5.rows("/muscle/activation");
  const Hdf5Reader::Rows residual = log.h5.rows("/muscle/residual");
  const std::vector<double> most = log.h5.doubles("/model/muscle_force");
  const double length = log.model.length() / log.model.body_count();
  for (Eigen::Index f = 0; f < activation.rows(); ++f) {
    for (std::size_t m = 0; m < log.model.muscles.size(); ++m) {
      const Muscle& muscle = log.model.muscles[m];
      const double a = activation(f, static_cast<Eigen::Index>(m));
      const Body& body = log.model.bodies[muscle.body];
      const double lacks = residual.row(f)
                               .segment(body.first_dof, body.dofs)
                               .cwiseAbs()
                               .maxCoeff<Eigen::PropagateNaN>();
      table.add(
          {std::int64_t{f}, log.time[f], muscle.name, muscle.body * length, a, a * most[m], lacks});
    }
  }
  return table;
}

ExportTable eq6_table(const LogContents& log, bool si) {
  ExportTable table(
      "eq6.csv",
      {frame_column,
       time_column,
       {"contact", none, "first or last along the body, counted from the head"},
       {"strand", none, "a nearer the head, b nearer the tail"},
       {"command", speed, "right side of Eq. 6 at the frame; empty where it asks for nothing"},
       {"speed", speed, "left side of Eq. 6" + mean},
       {"shortfall", speed, "of the command" + mean},
       {"multiplier", force, "lambda / h" + mean}},
      si);
  const Hdf5Reader::Rows command = log.h5.rows("/thigmotaxis/command");
  const Hdf5Reader::Rows speeds = log.h5.rows("/mean/thigmotaxis/speed");
  const Hdf5Reader::Rows slack = log.h5.rows("/mean/thigmotaxis/slack");
  const Hdf5Reader::Rows lambda = log.h5.rows("/mean/thigmotaxis/lambda");
  for (Eigen::Index f = 0; f < command.rows(); ++f) {
    for (int k = 0; k < 4; ++k) {
      table.add({std::int64_t{f}, log.time[f], std::string(k < 2 ? "first" : "last"),
                 std::string(k % 2 == 0 ? "a" : "b"), command(f, k), speeds(f, k), slack(f, k),
                 lambda(f, k)});
    }
  }
  return table;
}

ExportTable head_table(const LogContents& log, bool si) {
  ExportTable table(
      "head.csv",
      {frame_column,
       time_column,
       {"force_x", force, "of what clamps the head, on the animal, world" + mean},
       {"force_y", force, "the same along y"},
       {"force_z", force, "the same along z"},
       {"torque_x", torque,
        "of what clamps the head, on the animal, about the head's end, its axes" + mean},
       {"torque_y", torque, "the same about y"},
       {"torque_z", torque, "the same about z"},
       {"plate_force_x", force,
        "of the head plate, on the animal, along x: what the knot pushes against" + mean}},
      si);
  const Hdf5Reader::Rows head = log.h5.rows("/mean/forces/head");
  const Hdf5Reader::Rows wall = log.h5.rows("/mean/forces/wall");
  for (Eigen::Index f = 0; f < head.rows(); ++f) {
    table.add({std::int64_t{f}, log.time[f], head(f, 0), head(f, 1), head(f, 2), head(f, 3),
               head(f, 4), head(f, 5), wall(f, 0)});
  }
  return table;
}

ExportTable energy_table(const LogContents& log, bool si) {
  std::vector<std::pair<std::string, std::string>> terms{
      {"kinetic_energy", "at the frame"},
      {"elastic_energy", "in the joint springs, at the frame"},
      {"gravity_energy", "at the frame, 0 at the world's origin"},
      {"work_tip", "of the scripted force on the tail, so far"},
      {"work_active", "of the muscles, so far"}};
  for (const RowKindEntry& kind : row_kind_table) {
    terms.emplace_back(std::string("work_") + kind.name, of(kind) + ", so far");
  }
  for (const EnergyColumn& loss : energy_losses) {
    const bool logged =
        log.h5.has(std::string("/diagnostics/") + loss.name);  // earlier logs differ
    if (logged) terms.emplace_back(loss.name, loss.description);
  }
  terms.emplace_back("integrator_error", "gained by the integrator itself, so far");
  std::vector<ExportColumn> columns{frame_column, time_column};
  std::vector<std::vector<double>> values;
  for (const auto& [name, meaning] : terms) {
    columns.push_back({name, energy, meaning});
    values.push_back(log.h5.doubles("/diagnostics/" + name));
  }
  ExportTable table("energy.csv", columns, si);
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    std::vector<ExportTable::Cell> row{static_cast<std::int64_t>(f), log.time[f]};
    for (const std::vector<double>& term : values) row.emplace_back(term[f]);
    table.add(row);
  }
  return table;
}

}  // namespace

std::vector<ExportTable> force_tables(const LogContents& log, bool si) {
  std::vector<ExportTable> tables{torque_table(log, si), joint_table(log, si), eq6_table(log, si),
                                  head_table(log, si), energy_table(log, si)};
  if (log.h5.has("/mean/moments/active"))
    tables.push_back(moment_table(log, si));  // not in earlier logs
  if (!log.model.muscles.empty()) tables.push_back(muscle_table(log, si));
  return tables;
}

}  // namespace hagfish
