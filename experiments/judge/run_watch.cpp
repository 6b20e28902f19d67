#include "experiments/judge/run_watch.hpp"

#include "core/input/toml/toml_range.hpp"
#include "core/log/end_of_run.hpp"
#include "core/log/log_writer.hpp"

namespace hagfish {

RunWatch::RunWatch(const Model& model, const Scene& scene, Judge& judge)
    : model_(model), scene_(scene), judge_(judge), means_(model.nv()) {}

void RunWatch::see(const StepRecord& record) {
  const ThigmotaxisRows rows =
      thigmotaxis_rows_of(record.control, record.solution, scene_.time.step);
  if (record.step % frame_stride(scene_.time) == 0) see_frame(record, false);
  // The step that begins at a frame counts to what follows it.
  means_.take(record, rows);
  RunStep step;
  step.worst.take(record);
  step.eq6 = rows.any ? static_cast<int>(rows.met) : -1;
  judge_.see(step);
  clamped_ = record.control.clamp_head;
  any_ = true;
}

void RunWatch::see_end(const Simulation& sim) {
  if (!any_) return;
  const StepRecord end = end_record(model_, time_of(sim, scene_), sim, clamped_);
  const Observation& observation = end.after.observation;
  judge_.see(Worst{observation.penetration, observation.limit_violation, end.head_drift, 0});
  see_frame(end, true);
}

void RunWatch::see_frame(const StepRecord& record, bool at_end) {
  const FrameMeans& mean = means_.close();
  judge_.see(RunFrame{.time = record.time,
                      .phase = record.controller.phase,
                      .clamped = record.control.clamp_head,
                      .at_end = at_end,
                      .span = knot_span(record.controller),
                      .q = record.after.state.q,
                      .tip = record.solution.tip,
                      .active = mean.active_torque,
                      .thigmotaxis = mean.force[RowKind::thigmotaxis],
                      .head = mean.force[RowKind::head],
                      .obstacles = mean.force[RowKind::obstacle],
                      .rows = mean.sum_of_rows,
                      .energy = record.ledger,
                      .momentum = record.momentum});
}

}  // namespace hagfish
