#include "core/log/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/bitset.hpp>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>

#include "core/contact/obstacles.hpp"
#include "core/log/hdf5_error.hpp"

// Each struct is taken apart by a structured binding: one that gains a member does not compile
// until the member is kept here too.
namespace hagfish {
namespace {

/// Of the bytes' layout; raised with every change of what they hold.
constexpr int layout = 11;
/// No list of a run is longer; a damaged count must not ask for all memory.
constexpr std::uint64_t most_entries = 1000000;

void require(bool holds, const char* what) {
  if (!holds) {
    throw FileError(fmt::format("checkpoint: {}", what));
  }
}

std::uint64_t count_of(cereal::BinaryInputArchive& archive) {
  std::uint64_t count = 0;
  archive(count);
  require(count <= most_entries, "a list is too long");
  return count;
}

}  // namespace
}  // namespace hagfish

namespace cereal {

using hagfish::count_of;

template <class Archive>
void save(Archive& archive, const std::string& text) {
  archive(std::uint64_t{text.size()}, binary_data(text.data(), text.size()));
}
inline void load(BinaryInputArchive& archive, std::string& text) {
  text.resize(count_of(archive));
  archive(binary_data(text.data(), text.size()));
}

template <class Archive, class T>
void save(Archive& archive, const std::vector<T>& list) {
  archive(std::uint64_t{list.size()});
  for (const T& entry : list) {
    archive(entry);
  }
}
template <class T>
void load(BinaryInputArchive& archive, std::vector<T>& list) {
  list.clear();
  for (std::uint64_t left = count_of(archive); left > 0; --left) {
    archive(list.emplace_back());
  }
}

// A damaged byte that is neither true nor false must not be read as a bool.
template <class Archive, class T>
void save(Archive& archive, const std::optional<T>& entry) {
  archive(std::uint8_t{!entry});
  if (entry) {
    archive(*entry);
  }
}
template <class T>
void load(BinaryInputArchive& archive, std::optional<T>& entry) {
  std::uint8_t absent = 0;
  archive(absent);
  hagfish::require(absent <= 1, "a flag is neither 0 nor 1");
  entry.reset();
  if (absent == 0) {
    archive(entry.emplace());
  }
}

template <class Archive, int rows>
void save(Archive& archive, const Eigen::Matrix<double, rows, 1>& vector) {
  archive(std::uint64_t(vector.size()),
          binary_data(vector.data(), static_cast<std::size_t>(vector.size()) * sizeof(double)));
}
template <int rows>
void load(BinaryInputArchive& archive, Eigen::Matrix<double, rows, 1>& vector) {
  const auto size = static_cast<Eigen::Index>(count_of(archive));
  hagfish::require(rows == Eigen::Dynamic || size == rows, "a vector has the wrong size");
  vector.resize(size);
  archive(binary_data(vector.data(), static_cast<std::size_t>(size) * sizeof(double)));
}

}  // namespace cereal

namespace hagfish {

template <class Archive>
void serialize(Archive& archive, State& state) {
  auto& [q, qdot] = state;
  archive(q, qdot);
}

template <class Archive>
void serialize(Archive& archive, Contact& contact) {
  auto& [segment_a, segment_b, t_a, t_b, arc_a, arc_b, gap, normal, tangent_a, tangent_b,
         obstacle] = contact;
  archive(segment_a, segment_b, t_a, t_b, arc_a, arc_b, gap, normal, tangent_a, tangent_b,
          obstacle);
}

template <class Archive>
void serialize(Archive& archive, ContactSet& set) {
  auto& [contacts, on_obstacles, near_pairs, least_gap] = set;
  archive(contacts, on_obstacles, near_pairs, least_gap);
}

template <class Archive>
void serialize(Archive& archive, TouchingEnds& ends) {
  auto& [first, last, head_end, tail_end] = ends;
  archive(first, last, head_end, tail_end);
}

template <class Archive>
void serialize(Archive& archive, Observation& observation) {
  // The first two follow from q, and the patches from these and the ends.
  auto& [kin, segments, contact, ends, patches, penetration, limit_violation] = observation;
  archive(contact, ends, penetration, limit_violation);
}

template <class Archive>
void serialize(Archive& archive, ClosestPoints& closest) {
  auto& [t_a, t_b, gap] = closest;
  archive(t_a, t_b, gap);
}

template <class Archive>
void serialize(Archive& archive, SegmentPair& pair) {
  auto& [a, b] = pair;
  archive(a, b);
}

template <class Archive>
void serialize(Archive& archive, Candidates& candidates) {
  // Two follow from the others, and the last two are of BeforeStep.
  auto& [pairs, clear_until, closest, first, ends, displacement, changed, all_changed] = candidates;
  archive(pairs, clear_until, closest, displacement);
}

template <class Archive>
void serialize(Archive& archive, ContactSearch& search) {
  auto& [candidates, scratch] = search;
  archive(candidates);
}

template <class Archive>
void serialize(Archive& archive, KnotInvariants& type) {
  auto& [determinant, v2] = type;
  archive(determinant, v2);
}

template <class Archive>
void serialize(Archive& archive, KnotVote& knot) {
  auto& [type, agreement] = knot;
  archive(type, agreement);
}

template <class Archive>
void serialize(Archive& archive, PastKnot& past) {
  auto& [type, from, to] = past;
  archive(type, from, to);
}

template <class Archive>
void serialize(Archive& archive, PullSum& pull) {
  auto& [sum, steps] = pull;
  archive(sum, steps);
}

template <class Archive>
void serialize(Archive& archive, ControllerState& controller) {
  auto& [phase, phase_start, loose, knot, knot_seen, knot_from, past, lost, ends, pull, rest_shape,
         memory] = controller;
  archive(phase, phase_start, loose, knot, knot_seen, knot_from, past, lost, ends, pull, rest_shape,
          memory);
}

template <class Archive>
void serialize(Archive& archive, WarmStart::Kept& kept) {
  auto& [id, lambda] = kept;
  archive(id, lambda);
}

template <class Archive>
void serialize(Archive& archive, EnergyLedger& ledger) {
  auto& [initial, kinetic, elastic, gravity, work_tip, work_active, work, dissipated, impacts,
         inertia, potential, coriolis, held, momentum, translation, lowest_error, largest] = ledger;
  archive(initial, kinetic, elastic, gravity, work_tip, work_active, work.of_kind, dissipated,
          impacts, inertia, potential, coriolis, held, momentum, translation, lowest_error,
          largest);
}

template <class Archive>
void serialize(Archive& archive, Momentum& momentum) {
  auto& [linear, angular] = momentum;
  archive(linear, angular);
}

template <class Archive>
void serialize(Archive& archive, MomentumLedger& ledger) {
  auto& [initial, momentum, drag, outside, integrator, given_back] = ledger;
  archive(initial, momentum, drag, outside, integrator, given_back);
}

template <class Archive>
void serialize(Archive& archive, CapWatch& row) {
  auto& [id, since] = row;
  archive(id, since);
}

template <class Archive>
void serialize(Archive& archive, Watch& watch) {
  auto& [warned, capped, made] = watch;
  archive(warned, capped, made);
}

template <class Archive>
void serialize(Archive& archive, Worst& worst) {
  auto& [penetration, limit_violation, head_drift, kkt] = worst;
  archive(penetration, limit_violation, head_drift, kkt);
}

template <class Archive>
void serialize(Archive& archive, ConstraintForces& force) {
  archive(force.of_kind);
}

template <class Archive>
void serialize(Archive& archive, FrameMeans& means) {
  auto& [force, active_torque, net_force, lambda, speed, slack, pulls] = means;
  archive(force, active_torque, net_force, lambda, speed, slack, pulls);
}

template <class Archive>
void serialize(Archive& archive, LogState& log) {
  auto& [means, worst, warnings] = log;
  archive(means, worst, warnings);
}

template <class Archive>
void serialize(Archive& archive, Simulation& sim) {
  auto& [step, now, search, controller, solver, ledger, momentum, watch, before, storage, law,
         under_way] = sim;  // the last are storage and code
  archive(step, now.state, now.observation, search, controller, solver.warm,
          solver.warm.half_change, solver.warm.half_before, solver.warm.remaining, ledger, momentum,
          watch);
}

namespace {

// What the program takes as an index, or as a size, must be one.

bool fits(const Contact& contact, const Model& model) {
  const int own = model.body_count() - 1;
  const bool on_obstacle = contact.obstacle != -1;
  if (on_obstacle && !has_strand(model, contact.obstacle)) return false;
  const int first = on_obstacle ? strand_begin(model, contact.obstacle) : 0;
  const int end = on_obstacle ? first + segments_of(model.obstacles[contact.obstacle]) : own;
  const auto on_segment = [](int segment, double t, int from, int to) {
    return segment >= from && segment < to && t >= 0 && t <= 1;
  };
  const auto direction = [](const Eigen::Vector3d& v) {
    constexpr double rounding = 1e-9;  // of a unit vector
    return std::abs(v.norm() - 1) <= rounding;
  };
  return on_segment(contact.segment_a, contact.t_a, 0, own) &&
         on_segment(contact.segment_b, contact.t_b, first, end) && std::isfinite(contact.arc_a) &&
         std::isfinite(contact.arc_b) != on_obstacle && std::isfinite(contact.gap) &&
         direction(contact.normal) && direction(contact.tangent_a) && direction(contact.tangent_b);
}

bool fits(const std::vector<Contact>& contacts, const Model& model) {
  return std::ranges::all_of(contacts, [&](const Contact& c) { return fits(c, model); });
}

bool fits(const TouchingEnds& ends, const Model& model) {
  const auto end = [&](const std::optional<Contact>& contact) {
    return !contact || (contact->obstacle == -1 && fits(*contact, model));
  };
  return end(ends.first) && end(ends.last);
}

bool fits(const Candidates& candidates, const Model& model) {
  const int segments = segment_count(model);
  const auto& [pairs, clear_until, closest, first, ends, displacement, changed, all_changed] =
      candidates;
  return static_cast<int>(displacement.size()) == segments && clear_until.size() == pairs.size() &&
         closest.size() == pairs.size() &&
         std::ranges::is_sorted(
             pairs, {}, [](const SegmentPair& pair) { return std::pair(pair.a, pair.b); }) &&
         std::ranges::all_of(pairs, [&](const SegmentPair& pair) {
           return pair.a >= 0 && pair.a < pair.b && pair.a < model.body_count() - 1 &&
                  pair.b < segments;
         });
}

bool fits(const State& state, const Model& model) {
  return state.q.size() == model.nq() && state.qdot.size() == model.nv() && state.q.allFinite() &&
         state.qdot.allFinite();
}

void check(const Simulation& sim, const LogState& log, const Model& model) {
  const ContactSet& contact = sim.now.observation.contact;
  require(sim.step >= 0, "a step before the first");
  require(fits(sim.now.state, model), "a state that is not of its model");
  require(fits(contact.contacts, model) && fits(contact.on_obstacles, model) &&
              fits(contact.near_pairs, model) && fits(sim.search.candidates, model) &&
              fits(sim.now.observation.ends, model) && fits(sim.controller.ends, model),
          "a contact that is not on its animal");
  require(sim.controller.phase <= Phase::last, "an unknown phase");
  require(sim.controller.memory.allFinite(), "a memory that is not finite");
  const Eigen::Index rest = sim.controller.rest_shape.size();
  require(rest == 0 || (rest == model.nv() && sim.controller.rest_shape.allFinite()),
          "a rest shape that is not of its model");
  for (const auto* change : {&sim.solver.warm.half_change, &sim.solver.warm.half_before}) {
    require(change->size() == 0 || (change->size() == model.nv() && change->allFinite()),
            "a change of velocity that is not of its model");
  }
  require(sim.solver.warm.remaining > 0 && std::isfinite(sim.solver.warm.remaining),
          "a share of passes that is not positive");
  require(log.means.size() == model.nv(), "means that are not of its model");
}

}  // namespace

bool is_older_checkpoint(std::span<const std::uint8_t> bytes) {
  int found = layout;
  if (bytes.size() >= sizeof found) std::memcpy(&found, bytes.data(), sizeof found);
  return found > 0 && found < layout;
}

std::vector<std::uint8_t> encode(const Simulation& sim, const LogState& log) {
  std::ostringstream stream;
  cereal::BinaryOutputArchive archive(stream);
  archive(layout, sim, log);
  const std::string bytes = stream.str();
  return {bytes.begin(), bytes.end()};
}

Simulation decode(std::span<const std::uint8_t> bytes, const Model& model,
                  const std::string& back_end, LogState& log) {
  Simulation sim{.step = 0,
                 .now = {},
                 .search = {},
                 .controller = {},
                 .solver = StepSolver(back_end),
                 .ledger = {},
                 .momentum = {},
                 .watch = {},
                 .before = {}};
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  try {
    cereal::BinaryInputArchive archive(stream);
    int found = 0;
    archive(found);
    require(found == layout, "made by another version of the program");
    archive(sim, log);
  } catch (const cereal::Exception&) {
    require(false, "ends early");
  }
  require(stream.peek() == std::istringstream::traits_type::eof(), "does not end where it should");
  check(sim, log, model);
  Observation& seen = sim.now.observation;
  update_positions(model, sim.now.state.q, seen.kin);
  update_velocities(model, sim.now.state.qdot, seen.kin);
  update_segments(model, seen.kin.centre, seen.segments);
  keep_ends(seen.segments, sim.search.candidates);
  index_pairs(seen.segments.size(), sim.search.candidates);
  return sim;
}

}  // namespace hagfish
