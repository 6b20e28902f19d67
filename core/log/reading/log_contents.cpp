#include "core/log/reading/log_contents.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/control/controller.hpp"
#include "core/log/axis_labels.hpp"
#include "core/log/log_header.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/reading/log_schema.hpp"
#include "core/log/reading/logged_run.hpp"

namespace hagfish {

LogContents::LogContents(const std::string& file, LogLevel least) : h5(file) {
  require_log(h5);
  require_level(h5, least);
  resolved = logged_scene(h5);
  check_schema(h5, model, resolved.scene);
  time = h5.doubles("/trajectory/time");
  phase = h5.integers("/trajectory/phase");
  begun = std::ssize(time) - (ends_with_end_frame(h5) ? 1 : 0);
  const LogLevel level = level_of(h5);
  if (level >= LogLevel::frames) q = h5.rows("/trajectory/q");
  if (level == LogLevel::full) {
    qdot = h5.rows("/trajectory/qdot");
    qdot_next = h5.rows("/trajectory/qdot_next");
  }
  if (level == LogLevel::full && midpoint()) {
    middle_step_velocity = h5.rows("/midway/moved");
    middle_mean_velocity = h5.rows("/midway/felt");
    qdot_step = h5.rows("/midway/qdot");
    passes = h5.integers("/steps/passes");
  }
  if (own_law()) clamp_head = h5.integers("/control/clamp_head");
  check_model();
}

bool LogContents::clamped(Eigen::Index frame) const {
  const auto f = static_cast<std::size_t>(frame);
  return own_law() ? clamp_head[f] != 0 : clamps_head(resolved.scene, static_cast<Phase>(phase[f]));
}

bool LogContents::balanced(Eigen::Index frame) const {
  const TimeSettings& settings = resolved.scene.time;
  return passes[static_cast<std::size_t>(frame * frame_stride(settings))] <= settings.passes;
}

void LogContents::check_model() const {
  const auto check = [this](const std::string& name, const std::string& of, std::size_t first,
                            std::size_t count, const auto& wanted) {
    const std::vector<double> found = h5.doubles("/model/" + name);
    if (found.size() != first + count) {
      throw FileError(fmt::format("{}: /model/{} holds {} values, but its scene makes {}",
                                  h5.file(), name, found.size(), first + count));
    }
    for (std::size_t i = 0; i < count; ++i) {
      // Another machine's compiler may round otherwise.
      const bool same = found[first + i] == wanted(i) ||
                        (std::isfinite(wanted(i)) &&
                         std::abs(found[first + i] - wanted(i)) <= 1e-12 * std::abs(wanted(i)));
      if (!same) {
        throw FileError(
            fmt::format("{}: /model/{} of {} {} is {:.17g}, but its scene makes {:.17g}", h5.file(),
                        name, of, i, found[first + i], wanted(i)));
      }
    }
  };
  const std::vector<Body>& bodies = model.bodies;
  const std::size_t hinges = model.hinges.size();
  const Eigen::Matrix2Xd ranges = hinge_ranges(model);
  check("mass", "body", 0, bodies.size(), [&](std::size_t b) { return bodies[b].mass; });
  check("length", "body", 0, bodies.size(), [&](std::size_t b) { return bodies[b].length; });
  check("radius", "body", 0, bodies.size(), [&](std::size_t b) { return bodies[b].radius; });
  check("limit_lower", "hinge", root_dofs, hinges,
        [&](std::size_t k) { return ranges(0, static_cast<Eigen::Index>(k)); });
  check("limit_upper", "hinge", root_dofs, hinges,
        [&](std::size_t k) { return ranges(1, static_cast<Eigen::Index>(k)); });
  if (!model.muscles.empty()) {
    check("muscle_force", "muscle", 0, model.muscles.size(), [&](std::size_t m) {
      return model.muscles[m].force * static_cast<double>(model.muscles[m].lines.size());
    });
  }
  if (h5.has(body_labels)) {  // older logs label no axes
    const Eigen::VectorXd arcs = body_arcs(model);
    check("arc", "body", 0, bodies.size(),
          [&](std::size_t b) { return arcs[static_cast<Eigen::Index>(b)]; });
  }
  if (h5.has("/model/bending_limit")) {  // logs older than cones say nothing of them
    const Eigen::VectorXd limits = bending_limits(model);
    check("bending_limit", "joint", 0, bodies.size(),
          [&](std::size_t b) { return limits[static_cast<Eigen::Index>(b)]; });
  }
}

}  // namespace hagfish
