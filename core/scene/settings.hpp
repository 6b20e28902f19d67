// Every number that a scene file may set, grouped by the stage that uses it. Defaults are those of
// a scene that says nothing: head clamped, head plate in place, no gravity, drag, stiffness or
// script.
//
// Units are cm, g, s, rad, dyn throughout; scene files give angles in degrees (toml_reader.hpp).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/obstacle.hpp"
#include "core/scene/phase.hpp"

namespace hagfish {

/// What a universal joint's limit bounds; the paper does not say.
enum class BendingLimit {
  box,  ///< the angle of each of its two hinges, so that both together bend up to 1.4 times as far
  cone  ///< the angle between the X axes of its two bodies
};

/// Layout of the joints behind the free head.
enum class JointLayout {
  alternating,  ///< universal about Y and Z, then revolute about X, and so on (paper, 3.1)
  universal     ///< universal ones alone, as robots have them: no twist (addition)
};

/// Source of the body's passive stiffness and damping.
enum class PassiveSource {
  scene,    ///< ModelSettings: one value all along the body
  specimen  ///< what is known of the animal, Specimen::bending_stiffness and so on
};

/// How the specimen becomes a chain. The passive terms are additions to the paper: it states none.
struct ModelSettings {
  int bodies = 100;  ///< rigid bodies along the animal, 2 to 400
  JointLayout joints = JointLayout::alternating;
  PassiveSource passive = PassiveSource::scene;
  double bending_stiffness = 0;  ///< flexural rigidity about each bending axis, dyn cm^2
  double bending_damping = 0;    ///< its rate form, dyn cm^2 s
  double twist_stiffness = 0;    ///< torsional rigidity, dyn cm^2
  double twist_damping = 0;      ///< its rate form, dyn cm^2 s
  /// Largest bending limit of one hinge or cone, rad. A coarse chain must bend further per joint to
  /// reach the same curvature; past 90 degrees a universal joint loses its second axis.
  double largest_limit = 1.4835298641951802;
  double limit_scale = 1;  ///< factor of every bending and twisting limit, before the bound above
  /// Last body's density over the first's, geometric in between; the mass of the whole is kept.
  double mass_ratio = 1;
  BendingLimit bending_limit = BendingLimit::box;
};

/// Linear water drag per unit length of body (addition to the paper), g / (s cm).
struct DragSettings {
  double normal = 0;      ///< drag across the body
  double tangential = 0;  ///< drag along it
};

/// Time at which a unilateral row (joint limit, contact, obstacle) enters the problem.
enum class Activation {
  speculative,  ///< acts within reach: C v >= -gap / h, so the gap closes and does not cross
  violated      ///< acts only once violated, as RedMax does
};

struct ConstraintSettings {
  Activation activation = Activation::speculative;
  /// Baumgarte gain, the share of a violation that a step takes back: C v >= -baumgarte * gap / h
  /// for gap < 0.
  double baumgarte = 0.5;
  /// But no faster than this, cm/s: bodies keep the speed at which they separate, and deep overlaps
  /// must not throw them apart.
  double baumgarte_speed = 5;
  /// Speculative rows only: a step whose path overlaps by this much more than it should is solved
  /// again with rows that see it, cm.
  double tolerance = 0.0003;
  int corrections = 8;  ///< most corrections of a step; 0: none
  /// A step that moves a body further than this is checked along its path too, cm: less than the
  /// radius of the thinnest body, so that no strand passes through another unseen.
  double stride = 0.25;
};

/// Self-contact along the spline through the body centres (paper, Eq. 5).
struct ContactSettings {
  double margin = 0.1;  ///< gaps up to this enter the problem when speculative, cm
  /// Parts of the body whose nearest ends are closer than this along it never touch: neighbours
  /// always overlap, cm of arc (7 bodies of 100 between them).
  double least_arc = 2.968;

  /// Whether parts with this much body between them, cm of arc, may touch. The slack keeps rounding
  /// from putting equal arcs on different sides of the bound.
  bool may_touch(double arc_between) const { return arc_between >= least_arc * (1 - 1e-9); }
};

/// Flesh that yields where it is pressed (addition): skins overlap, and points along the strands
/// press them apart, each as a spring and a damper side by side (Kelvin-Voigt, contact/flesh.hpp).
struct FleshSettings {
  /// Normal force per cm of contact and cm of overlap, k', dyn/cm^2; 0: contact is hard.
  double stiffness = 0;
  double relaxation = 0;  ///< damping over stiffness, tau, s
  double spacing = 0;     ///< distance of points along a strand, cm

  bool present() const { return stiffness > 0; }
};

/// The tank's head plate, the plane x = 0: the first of the obstacles (obstacles_of).
struct WallSettings {
  bool present = true;
  double neck = 3.0;  ///< bodies nearer the head than this pass through the plate, cm of arc
};

/// A waypoint of a script in time: a force (dyn) or a position of the last body's centre (cm).
struct Waypoint {
  double time = 0;  ///< s
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();  ///< drawn on top of it, same unit
};

/// The shape that the animal gives itself through time: its curvature about Y and Z and its twist.
/// Linear between times and between stations, constant outside.
struct CurvatureProgram {
  std::vector<double> time;     ///< s, rising; the first is 0
  std::vector<double> station;  ///< share of the length from the head, 0 to 1, rising
  /// For each time one column for each station: about Y, about Z, twist. In rad per body length,
  /// curvature times length, so that animals of any length take the same shape.
  std::vector<Eigen::Matrix3Xd> value;
  std::vector<Eigen::Matrix3Xd> noise;  ///< drawn on top of it, the same unit; or empty
};

/// Scripted forward dynamics of knot forming (paper, 3.2): a force on the last body's centre, or
/// the animal's own torques.
struct ScriptSettings {
  enum class Kind {
    none,
    force,     ///< the paper's: a force, linear between waypoints
    position,  ///< waypoints, Catmull-Rom through time, followed by a spring-damper
    curvature  ///< the animal bends itself (addition): `curvature`, by ActiveSettings
  };
  Kind kind = Kind::none;
  CurvatureProgram curvature;
  std::vector<Waypoint> waypoints;  ///< times rising; first one at 0
  double spring = 0;                ///< position script: dyn / cm, taken implicitly
  double damper = 0;                ///< position script: dyn s / cm, taken implicitly
  double largest_force = 0;         ///< position script: the spring-damper saturates here, dyn
  /// Standard deviation of the normal noise on each coordinate of each waypoint, cm or dyn, or on
  /// each value of a curvature program, rad per body length: no animal does the same thing twice.
  double noise = 0;
  unsigned noise_seed = 1;  ///< number of the draw
};

/// How the animal's own torques bend it (addition): each hinge is pulled towards its angle in a
/// rest shape. While the knot forms, a curvature program is the rest shape; then muscle tone
/// follows the shape that the knot takes, until release lets it go.
struct ActiveSettings {
  double stiffness = 0;   ///< B_a towards the rest shape, dyn cm^2: per hinge, over hinge_span()
  double tone_time = 0;   ///< time constant by which the rest shape follows the body, tau, s
  double relax_time = 0;  ///< time constant by which it becomes straight from release on, s
  /// Torque of one hinge that the muscles can make, dyn cm: above it the torque is constant within
  /// the step, and the run reports it.
  double capacity = 0;
  bool bounds_laws = false;  ///< bounds also torques that a law of the run's own asks for besides
};

/// Muscles that make the animal's torques (addition; core/chain/muscle.hpp).
struct MuscleSettings {
  bool present = false;  ///< the specimen's: the activations that the torques take are logged
  /// Time constant by which a muscle follows its excitation, s (laws muscles, reflex_muscles).
  double activation_time = 0;
};

/// Commanded speeds of Eq. 6 at one contact, cm/s.
struct ThigmotaxisSpeeds {
  double a = 0;  ///< row along t_a, the tangent of the strand nearer the head
  double b = 0;  ///< row along t_b, the tangent of the strand nearer the tail
};

/// The end of the animal by which the knot leaves it.
enum class BodyEnd { head, tail };

/// Points whose velocities Eq. 6 takes. The forces are internal in both cases.
enum class Eq6Point {
  skin,  ///< one point, where the skins touch
  /// The two closest points of the spline, as seen from the head: as the joints move them.
  centreline
};

/// What Eq. 6 asks of two strands that are commanded to run at given speeds.
enum class Eq6Slip {
  paper,  ///< the speeds themselves, whatever the angle of the strands
  shape   ///< the slip that strands have which run along themselves at these speeds
};

/// The control law that is of the program that runs the scene.
inline constexpr const char* own_law = "own";

/// The loop of the law knot_speed: s' = gain (1 - v / target) for the scale s of the commanded
/// speeds, with v the knot's speed.
struct KnotSpeedSettings {
  double target = 0;  ///< speed of the knot's leading end along the body, cm/s
  double gain = 0;    ///< 1/s
  double filter = 0;  ///< time constant by which the end's place is smoothed to tell its speed, s
  double most = 1;    ///< largest s; the least is 0
};

/// What the shapes of a reduced basis lie along.
enum class BasisFrame {
  body,  ///< the animal, from head to tail
  knot   ///< the body from a margin before the knot's first contact to one behind its last: a
         ///< window that travels with the knot
};

/// The torques u = B a of the law reduced_basis: few numbers a, dyn cm, times shapes along the
/// body, the columns of B, with no unit. Shapes are cosines, or learned ones of a file.
struct ReducedBasisSettings {
  BasisFrame frame = BasisFrame::knot;
  double margin = 0;  ///< margin of the knot's window, cm of arc
  double smooth = 0;  ///< time constant by which the window follows the two contacts, s
  int cosines = 0;    ///< number per bending axis and twist; 0: the shapes are learned
  std::string file;   ///< file of learned shapes, as a scene names it; empty once they are read
  std::vector<double> stations;  ///< rising: cm of arc, or shares of the window from 0 to 1
  /// One shape after the other at all stations, linear between them and zero outside.
  std::vector<double> bend_y, bend_z, twist;
  double period = 0;  ///< time between two findings of a, s: rounded to whole steps, one at least
  double filter = 0;  ///< time constant by which the torques follow a, s
  /// How far Eq. 6 may be missed for a smaller |a|: added to the diagonal of the problem in its
  /// multipliers, as a share of the largest entry there.
  double softness = 0;
  double most = 0;  ///< bound on |u| of any hinge, by which all of a is scaled down, dyn cm
  /// Open loop: a of each place of the knot's head end (cm of arc, rising), one place after the
  /// other, linear between them. No model is asked then. Empty: a is found.
  std::vector<double> places, played;
};

/// How many numbers a has.
inline int basis_size(const ReducedBasisSettings& basis) {
  return basis.cosines > 0 ? 3 * basis.cosines
                           : static_cast<int>(basis.bend_y.size() / basis.stations.size());
}

/// Joints that the law reflex moves.
enum class ReflexGate {
  all,
  touch  ///< those within a reach of where the body touches itself; the others keep their angle
};

/// The rule of the law reflex (core/control/reflex.hpp): every joint copies what the animal senses
/// of its own shape a little further on.
struct ReflexSettings {
  /// Δ, cm of arc: how far behind itself (negative: before itself) a joint finds what it copies. On
  /// a way back to the tail it is turned round.
  double shift = 0;
  double pull_shift = 0;  ///< shift while the head pulls at food; 0: as before that
  bool bend_y = true, bend_z = true, twist = true;  ///< turns that are copied, each from its kind
  ReflexGate gate = ReflexGate::all;
  double reach = 0;   ///< reach of ReflexGate::touch, along either strand, cm of arc
  double delay = 0;   ///< delay of the senses, s: rounded to whole steps
  double noise = 0;   ///< standard deviation of each sensed angle at each step, share of it
  unsigned seed = 1;  ///< seed of the noise
};

/// The thigmotaxis controller (paper, 3.2, Eq. 6) and its switches between phases.
struct ControllerSettings {
  std::string law = "paper";  ///< law of the animal in each phase (core/control/laws.hpp)
  Eq6Point eq6_at = Eq6Point::skin;
  Eq6Slip eq6_slip = Eq6Slip::paper;
  KnotSpeedSettings knot_speed;
  ReducedBasisSettings reduced_basis;
  ReflexSettings reflex;
  ThigmotaxisSpeeds tighten_head, tighten_tail;  ///< first and last contact while tightening
  ThigmotaxisSpeeds slide_head, slide_tail;      ///< first and last contact while sliding
  /// Speeds on the way back to the tail. Eq. 6 bounds speeds from below, so that v < 0 asks for
  /// nothing: here both tangents point to the head.
  ThigmotaxisSpeeds reverse_head, reverse_tail;
  BodyEnd leave_by = BodyEnd::head;  ///< tail: at the head the knot turns back
  Phase free_from = Phase::release;  ///< a clamped head is free from this phase on
  double cap = 5000;          ///< largest lambda / h of a thigmotaxis row, dyn: the rows are soft
  double contact_gap = 0.05;  ///< strands this close count as touching, cm (TouchingEnds)
  /// Eq. 6 at an end of the knot holds in the mean over a patch of contact (contact_patch) whose
  /// area is the square of this, cm; 0: at its first (last) point.
  double contact_patch = 0;
  double tail_through = 8.0;   ///< tighten once this much body is past the last contact, cm of arc
  double tighten_from = 0;     ///< earliest time to tighten, s: a script may end by pulling tight
  double tight_span = 20.352;  ///< slide once the knot spans no more body than this, cm of arc
  double tight_hold = 0.25;    ///< time for which it must be so, s: loose loops touch at times
  double tighten_time = 2.0;   ///< slide after this long in any case, s
  /// The slide ends when the first contact is this near the head, and a way back when the last one
  /// is this near the tail: then it is released, cm of arc.
  double release_at = 1.6;
  /// The knot is gone once it has been for this long: near an end of the body, where it leaves, the
  /// type of an open line is for a moment a matter of how it is closed, s.
  double untied_for = 0;
  double free_time = 1.0;  ///< run on this long after the knot is gone, s
};

inline constexpr double dyn_per_newton = 1e5;

/// A number that rises, or stays.
struct Ramp {
  double from = 0, to = 0;
  double time = 0;  ///< duration of the way from the one to the other, s

  double at(double since) const {  ///< the value this long after its start, s
    return since < time ? from + (to - from) * (since / time) : to;
  }
};

/// Food in the mouth that is held fast (addition): it is the head's clamp. Once the knot has slid
/// to the head, sliding goes on: the knot is pressed against the head plate, and the head pulls,
/// until the food gives or the animal lets go of it.
struct FoodSettings {
  double hold = 0;         ///< the animal lets go after this long, s; 0: there is no food
  double strength = 1000;  ///< the food gives where the pull passes this, N
  double average = 0.02;   ///< the pull is a mean over this time, s
  /// Largest lambda / h of a thigmotaxis row while pulling, in place of ControllerSettings::cap,
  /// dyn.
  Ramp cap;
};

/// How the body lies and moves at time 0: straight and at rest where nothing is said.
struct StartSettings {
  /// Bend of the body [station, about x, y, z], rad per cm of body, linear between stations (0 head
  /// to 1 tail). A hinge takes the share of the body that it stands for, and stops at its limits.
  std::vector<Eigen::Vector4d> bend;
  std::vector<Eigen::Vector4d> bend_rate;  ///< rate of bend, rad/(cm s)
  /// Turn of the body as a whole, rad/s, head's own axes; the head must be free.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  std::vector<double> q;      ///< State::q in place of bend, or empty
  std::vector<double> qdot;   ///< State::qdot in place of bend_rate and spin, or empty
  double noise = 0;           ///< normal noise on each hinge, stopped by its limits, rad
  unsigned seed = 1;          ///< seed of the noise
  Phase phase = Phase::form;  ///< what the controller takes the state to be
};

/// Topology of the open centreline, by vote over closures and projections.
struct KnotSettings {
  int votes = 15;            ///< directions tried
  unsigned seed = 20220301;  ///< seed of the directions
  double interval = 0.02;    ///< time between checks while the controller waits for a change, s
  bool mirror = false;       ///< tries the directions' mirror images, y to -y: see Scene::mirror
};

/// The rule of a step in time (core/README.md, "Steps in time").
enum class TimeRule {
  euler,    ///< the paper's: linearly implicit, of first order
  midpoint  ///< forces in the middle of the step, of second order; impulses act in full
};

/// What becomes of the momentum that a rule makes while nothing holds the head.
enum class FreeMomentum {
  kept,  ///< given back after each step, so that momentum changes by outside impulses alone
  rule   ///< it stays, as the rule has it: the paper's, and MuJoCo's
};

struct TimeSettings {
  TimeRule rule = TimeRule::euler;
  FreeMomentum momentum = FreeMomentum::kept;
  double step = 0.002;  ///< h, s
  /// The middle of a step has settled once further passes change the velocity by no more than this,
  /// as far as can be told: rad/s of each hinge, and cm/s and rad/s of the root.
  double settled = 0.001;
  int passes = 20;  ///< most passes to settle in, twice: with a balanced bias, and without
  /// Far stiffer springs than the step resolves ring from step to step by the midpoint rule: this
  /// times h² of their stiffness damps them, at the velocity after the step, 1/s.
  double ring_damping = 1;
  double frame_interval = 0.020;  ///< time between logged frames, s; a whole number of steps
  double duration = 30;           ///< the run ends here at the latest, s
  Phase until = Phase::free;      ///< the run ends with this phase

  /// How far into a step its forces act, s.
  double reach() const { return rule == TimeRule::euler ? step : step / 2; }
  /// Numerical damping of a spring over its stiffness, s.
  double spring_damping() const { return rule == TimeRule::euler ? 0 : ring_damping * step * step; }
};

enum class GuardAction { stop, warn };
enum class EnergyAction {
  hold,  ///< the excess is removed from the velocity, reported once; by the midpoint rule as warn
  warn,
  stop
};

/// Bounds of sanity, not physics: past one of these something is wrong with a run.
struct GuardSettings {
  /// Action at too much penetration, a limit passed too far or a lost knot. Speed always stops.
  GuardAction action = GuardAction::stop;
  double penetration = 0.5;      ///< cm
  double limit_violation = 0.2;  ///< rad
  double speed = 1e4;            ///< speed of any body centre, cm/s
  /// Energy that the integrator makes, over the largest kinetic and elastic energy so far and what
  /// drag and damping took.
  double energy_gain = 0.005;
  EnergyAction energy_action = EnergyAction::hold;
  double capped_time = 0.25;  ///< a thigmotaxis row at its cap for this long is reported, s
};

/// The sign of the body's writhe: which of its two mirror images a knot is.
enum class Hand { any, right, left };

/// A time of a run: by the clock, or after a phase has begun, as no two animals are as quick.
struct RunTime {
  std::optional<Phase> after;  ///< counted from this phase's start; none: from the run's
  double time = 0;             ///< s; infinite for the run's end
};

/// A stretch of the run in which the knot has one type.
struct KnotStretch {
  std::string type;  ///< type by knot_name()
  RunTime from, to;  ///< both included where they are times by the clock; else up to before `to`
};

/// What a run of the scene must show; `hagfish check` compares a log with it.
struct ExpectSettings {
  /// Knot that the controller waits for before it tightens, kept until release: "3_1", or
  /// "det=9,v2=-2" for one without a name; "" for none, which is never tightened.
  std::string knot;
  /// Knot type through time. Between the stretches, while it changes, any type will do.
  std::vector<KnotStretch> types;
  Hand hand = Hand::any;  ///< hand of the knot until release
  /// Headward travel of the knot's head end while sliding, cm; where the knot began nearer to its
  /// release than that, all the way there, but half of this at least.
  double slide_distance = 0;
  /// Least Slide::share() of the slide and of the way back: both ends of the knot move, and the
  /// body's curvature with them.
  double slide_share = 0;
  double reverse_distance = 0;  ///< tailward travel of its tail end on the way back, cm
  std::string out_of;  ///< plane behind which the head is until the knot pulls it out; "" for none
  /// Largest torque of a hinge while the knot slides or pulls, as a share of active.capacity: the
  /// animal's own and f_thigmo together, both of which muscles make. 0: not bounded.
  double torque_share = 0;
  double pull = 0;                    ///< mean pull at the food, N
  double pull_settled = 1;            ///< first part of the pull that these figures leave out, s
  double pull_drift = 0.4;            ///< difference between the means of both halves, of the mean
  double pull_balance = 0.005;        ///< difference of the plate's mean force and the pull, of it
  double speed_share = 0.95;          ///< least share of sliding steps with Eq. 6 met without slack
  double penetration = 0.0015;        ///< deepest at any step where contact is hard, cm
  double overlap = 0.4;               ///< deepest at any step where there is flesh, cm
  double skin_fold = 0;               ///< largest skin_fold() while the knot is held; 0: no bound
  double limit_violation = 1.745e-5;  ///< largest at any step, rad (0.001 degrees)
  double head_drift = 1e-6;           ///< largest at any step while clamped, cm
  double kkt = 1e-8;                  ///< largest scaled KKT residual of any step
  double energy = 1e-6;               ///< imbalance of the ledger, of the energy that passed
  /// Share by which kinetic, elastic and gravity energy may exceed what there was and what the
  /// script and thigmotaxis put in, at any step.
  double energy_gain = 0.01;
  /// What the integrator takes, without impacts, of the energy that passed.
  double energy_loss = 0.1;
  /// Momentum that the integrator makes while nothing holds the head, of what passed.
  double momentum = 1e-6;
};

struct Scene {
  std::string title;
  std::string specimen;  ///< specimen file as the scene names it
  /// The scene is the mirror image, y to -y, of what its file says: all of this is reflected
  /// already, and written back as the file had it.
  bool mirror = false;
  bool clamp_head = true;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< cm/s^2
  ModelSettings model;
  DragSettings drag;
  ConstraintSettings constraints;
  ContactSettings contact;
  FleshSettings flesh;
  WallSettings wall;
  std::vector<Obstacle> obstacles;  ///< others than the head plate
  StartSettings start;
  ScriptSettings script;
  ActiveSettings active;
  MuscleSettings muscle;
  ControllerSettings controller;
  FoodSettings food;
  KnotSettings knot;
  TimeSettings time;
  GuardSettings guard;
  ExpectSettings expect;
};

}  // namespace hagfish
