// Rows of Eq. 6 (paper, 3.2): the body is to slide along itself where it touches itself.
#pragma once

#include <array>
#include <vector>

#include "core/contact/observation.hpp"
#include "core/step/rows/row.hpp"

namespace hagfish {

/// Commanded sliding at one contact.
struct ThigmotaxisCommand {
  Contact contact;
  ThigmotaxisSpeeds speed;
  BodyEnd towards = BodyEnd::head;  ///< goal of the slide; the tail reverses both tangents
  double effort = 1;                ///< share of ControllerSettings::cap that bounds its rows
  KnotEnd end = KnotEnd::neither;   ///< identifies its rows from step to step
  /// Whether `speed` is asked of the rows, as in Eq. 6, or of the strands: slip_of_shape.
  Eq6Slip slip = Eq6Slip::paper;
};

/// The left sides of Eq. 6 where both strands run along themselves, ẋ_a = speed.a t_a and
/// ẋ_b = speed.b t_b, as those of a knot of constant shape do at one speed:
///
///     t_a . (ẋ_a - ẋ_b) = speed.a - speed.b t_a . t_b
///     t_b . (ẋ_b - ẋ_a) = speed.b - speed.a t_a . t_b
///
/// At one speed v both are v (1 - t_a . t_b). This is v where strands cross at right angles, 2 v
/// where they run in opposite directions, and 0 side by side. The paper has v on both rows. Side by
/// side these contradict each other, as they ask for v along t_a and against it. The motion above
/// meets both rows at any angle. `cosine` is t_a . t_b, or its mean over a patch.
ThigmotaxisSpeeds slip_of_shape(double cosine, const ThigmotaxisSpeeds& speed);

/// A row of Eq. 6 without a right-hand side or bounds, along t_a or t_b of `contact`. Both tangents
/// are reversed if `towards` is the tail. `at` as in ControllerSettings::eq6_at.
///
/// At the centreline its velocity is the one seen from the head, which the rates of the joints
/// determine. Forces at two points a diameter apart have a moment, and a couple at the head takes
/// it up. So the forces are torques of joints, and nothing turns the animal from outside. A clamped
/// head does not turn, so there the world sees the same.
Row eq6_row(const Model& model, const Kinematics& kin, const std::vector<SplineSegment>& segments,
            const Contact& contact, bool on_a, BodyEnd towards, Eq6Point at);

/// The rows of a command along t_a and t_b, with right-hand sides. At an end of the knot they are
/// the means of such rows over a patch (ControllerSettings::contact_patch). `found` is of the same
/// segments, or null. Its patches serve a contact that is one of its ends.
std::array<Row, 2> eq6_rows(const Model& model, const Kinematics& kin,
                            const std::vector<SplineSegment>& segments,
                            const ThigmotaxisCommand& command, const Scene& scene,
                            const Observation* found = nullptr);

/// Whether a row counts as met: its slack against its command, both cm/s.
bool meets_command(double slack, double command);

/// A place for the rows of Eq. 6.
struct ThigmotaxisPlace {
  const Kinematics& kin;
  const std::vector<SplineSegment>& segments;  ///< segments at `kin`
  bool displaced;                      ///< the segments have moved since the contacts were found
  const Observation* found = nullptr;  ///< observation of the segments, if there is one (eq6_rows)
};

/// Eq. 6 at the commanded contacts. controller.cap times the command's effort bounds λ / h. No two
/// commands may have the same end or, with neither end, the same segments.
void append_thigmotaxis_rows(const Model& model, const std::vector<ThigmotaxisCommand>& commands,
                             const ThigmotaxisPlace& place, const Scene& scene, double h,
                             std::vector<Row>& rows);

}  // namespace hagfish
