#include "experiments/film/film_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/input/input_error.hpp"
#include "core/scene/interpolation.hpp"
#include "experiments/film/block_arrow.hpp"
#include "experiments/film/film_curve.hpp"
#include "experiments/film/film_shape.hpp"

namespace hagfish {
namespace {

/// Distances up to this many standard deviations of a coordinate count by their square: one of 150
/// points of normal noise in three dimensions is further.
constexpr double reach = 3.5;
/// Least noise, of the body's length: a chain of straight bodies is that far off a curve.
constexpr double least_noise = 3e-4;
/// Frames that are fitted by themselves to begin with, for each time of the program, at most.
constexpr std::size_t first_frames = 6;
/// Points that a frame needs for that.
constexpr std::size_t first_points = 6;
constexpr int first_steps = 30;  // of Levenberg and Marquardt, for one frame
constexpr int rounds = 20;       // of noise and smoothness, and of the steps at them:
constexpr int steps = 40;
/// The gradient has vanished where the step that it asks for is this much of the standard errors.
constexpr double settled_decrement = 0.01;
/// Noise and smoothness are known once they change by less than this, of themselves.
constexpr double settled_noise = 0.02;
/// What smooths to begin with, cm^2 of squared distance for 1 (rad per length)^2 of second
/// difference: a millimetre of noise, differences of 10 rad per length.
constexpr double first_smoothness = 1e-4;
/// Of the largest number on the matrix's diagonal: the least that smooths, the most, the wall at
/// the limits, and what holds poses that no point tells.
constexpr double least_smoothness = 1e-12, most_smoothness = 1, wall = 0.1, pose_ridge = 1e-9;
/// Of the same: added to the diagonal, so that steps of what nothing tells are none.
constexpr double untold = 1e-13;
/// Of smoothness, by which it changes from round to round at most; and of its traces.
constexpr double largest_change = 100, trace_rounding = 1e-9;
/// Smoothness is that of times up to this far, s, and differs from the mean by this factor at most.
constexpr double around_time = 0.75, most_uneven = 30;
/// Of second differences in time: a free head may roll, and rolls as little as it can.
constexpr double least_motion = 1e-3;

std::vector<double> even(int count, double last) {
  std::vector<double> knots(count);
  for (int k = 0; k < count; ++k) knots[k] = last * k / (count - 1);
  return knots;
}

/// Head to film: a point x of the model, cm, is at rotation x / scale + shift.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Turns about the head's axes, then shifts along them; a small step of a pose, in this order: turn
/// about Y and Z, shift along X, Y, Z, turn about X; of a flat animal, turn about Z, shift along X
/// and Y.
Pose moved(const Pose& pose, const Eigen::VectorXd& step, double scale) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = turn;
  if (step.size() == 3) {
    turn.z() = step[0];
    shift.head<2>() = step.tail<2>();
  } else {
    turn << (step.size() > 5 ? step[5] : 0), step[0], step[1];
    shift = step.segment<3>(2);
  }
  Pose out;
  const double angle = turn.norm();
  out.rotation = pose.rotation;
  if (angle > 0) {
    out.rotation = pose.rotation * Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
  out.shift = pose.shift + pose.rotation * shift / scale;
  return out;
}

/// rho(r) and its weight rho'(r) / 2r: r^2 up to `far`, from there far^2 (1 + 2 log(r / far)).
double cost_of(double r, double far) {
  return r <= far ? r * r : far * far * (1 + 2 * std::log(r / far));
}
double weight_of(double r, double far) { return r <= far ? 1 : far * far / (r * r); }

/// Distances of a frame's points from a shape, in the head's axes, and their rates.
struct Misfit {
  Eigen::VectorXd off;   ///< dimensions x points
  Eigen::MatrixXd rate;  ///< by each value
  Eigen::MatrixXd by_pose;
  Eigen::VectorXd by_scale;  ///< by the logarithm of the scale
};

class Fit {
 public:
  Fit(const Model& model, const Film& film, FilmHead head, int times, int stations)
      : model_(model),
        film_(film),
        still_(head == FilmHead::still),
        scaled_(!film.length_known),
        dims_(film.planar ? 2 : 3),
        knots_(even(times, film.frames.back().time - film.frames.front().time)),
        shape_(model, even(stations, 1), film.planar),
        pose_size_(film.planar ? 3
                   : still_    ? 5
                               : 6),
        border_((still_ ? pose_size_ : 0) + (scaled_ ? 1 : 0)),
        matrix_(times, shape_.values(), border_),
        now_{Eigen::MatrixXd::Zero(shape_.values(), times), {}, 1},
        limit_(limits()),
        along_at_(Eigen::VectorXd::Ones(times)),
        time_at_(Eigen::VectorXd::Ones(times)) {
    now_.pose.resize(still_ ? 1 : film.frames.size());
    now_.scale = model.length() / film.length;
  }

  FilmFit run() {
    begin();
    measure_noise();
    bool settled = false;
    for (int round = 0; round < rounds; ++round) {
      settled = descend();
      const double noise = noise_, in_time = in_time_, along = along_;
      if (!estimate()) break;
      const auto same = [](double a, double b) {
        return std::abs(a - b) <= settled_noise * std::max(a, b);
      };
      if (same(noise, noise_) && same(std::sqrt(in_time), std::sqrt(in_time_)) &&
          same(std::sqrt(along), std::sqrt(along_))) {
        break;
      }
    }
    settled = descend() || settled;
    return result(settled);
  }

 private:
  struct Unknowns {
    Eigen::MatrixXd values;  ///< values x times
    std::vector<Pose> pose;  ///< one, or one for each frame
    double scale = 1;        ///< cm of the model in one of the film's lengths
  };

  const Pose& pose_of(const Unknowns& x, std::size_t frame) const {
    return x.pose[still_ ? 0 : frame];
  }
  TablePlace when(std::size_t frame) const {
    TablePlace place = place_among(knots_, film_.frames[frame].time - film_.frames.front().time);
    if (place.index + 1 == knots_.size()) place = {knots_.size() - 2, 1};
    return place;
  }
  Eigen::VectorXd values_at(const Unknowns& x, std::size_t frame) const {
    const TablePlace at = when(frame);
    const auto k = static_cast<Eigen::Index>(at.index);
    return (1 - at.share) * x.values.col(k) + at.share * x.values.col(k + 1);
  }

  /// The most that both bends of a joint can be together, by station, rad per length.
  Eigen::VectorXd limits() const {
    const Eigen::Index count = shape_.stations();
    Eigen::VectorXd limit = Eigen::VectorXd::Constant(count, INFINITY);
    const Eigen::Matrix2Xd range = hinge_ranges(model_);
    for (Eigen::Index j = 0; j < count; ++j) {
      double nearest = INFINITY;
      for (std::size_t k = 0; k < model_.hinges.size(); ++k) {
        const Hinge& hinge = model_.hinges[k];
        if (hinge.axis == Axis::x) continue;
        const double away = std::abs(static_cast<double>(hinge.body) / model_.body_count() -
                                     static_cast<double>(j) / static_cast<double>(count - 1));
        if (away >= nearest) continue;
        nearest = away;
        const double span = hinge_span(model_, hinge.body);
        limit[j] = range(1, static_cast<Eigen::Index>(k)) * model_.length() / span *
                   (model_.cones.empty() && !film_.planar ? std::sqrt(2.0) : 1);
      }
    }
    return limit;
  }

  Eigen::Matrix3Xd in_head(const Eigen::Matrix3Xd& points, const Pose& pose, double scale) const {
    return scale * (pose.rotation.transpose() * (points.colwise() - pose.shift));
  }

  /// Distances alone, dims x n.
  Eigen::MatrixXd distances(const FilmFrame& frame, const Eigen::VectorXd& values, const Pose& pose,
                            double scale) const {
    return (shape_.points(values, frame.place) - in_head(frame.point, pose, scale)).topRows(dims_);
  }

  Misfit misfit(const FilmFrame& frame, const Eigen::VectorXd& values, const Pose& pose,
                double scale, Eigen::Index pose_size) const {
    Eigen::MatrixXd rate;
    const Eigen::Matrix3Xd own = shape_.points(values, frame.place, rate);
    const Eigen::Matrix3Xd film = in_head(frame.point, pose, scale);
    const Eigen::Index n = own.cols();
    Misfit misfit;
    misfit.off.resize(dims_ * n);
    misfit.rate.resize(dims_ * n, rate.cols());
    misfit.by_pose = Eigen::MatrixXd::Zero(dims_ * n, pose_size);
    misfit.by_scale.resize(dims_ * n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto rows = Eigen::seqN(dims_ * k, dims_);
      misfit.off(rows) = (own.col(k) - film.col(k)).head(dims_);
      misfit.rate(rows, Eigen::all) = rate.middleRows(3 * k, dims_);
      misfit.by_scale(rows) = -film.col(k).head(dims_);
      const Eigen::Vector3d p = own.col(k);
      Eigen::MatrixXd by(3, pose_size);
      if (pose_size == 3) {
        by << -p.y(), 1, 0, p.x(), 0, 1, 0, 0, 0;
      } else {
        by.leftCols<5>() << p.z(), -p.y(), 1, 0, 0,  //
            0, p.x(), 0, 1, 0,                       //
            -p.x(), 0, 0, 0, 1;
        if (pose_size > 5) by.col(5) << 0, -p.z(), p.y();
      }
      misfit.by_pose(rows, Eigen::all) = by.topRows(dims_);
    }
    return misfit;
  }

  /// Multiplies what belongs to a point by the root of its weight. Returns the cost.
  double weigh(Misfit& misfit, double far) const {
    double cost = 0;
    for (Eigen::Index k = 0; k < misfit.off.size() / dims_; ++k) {
      const auto rows = Eigen::seqN(dims_ * k, dims_);
      const double r = misfit.off(rows).norm(), root = std::sqrt(weight_of(r, far));
      cost += cost_of(r, far);
      if (root == 1) continue;
      misfit.off(rows) *= root;
      misfit.rate(rows, Eigen::all) *= root;
      misfit.by_pose(rows, Eigen::all) *= root;
      misfit.by_scale(rows) *= root;
    }
    return cost;
  }

  /// Second differences along the body of a time's values, and the matrix of their squares.
  Eigen::MatrixXd along_square() const {
    const Eigen::Index count = shape_.stations();
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(shape_.values(), shape_.values());
    const Eigen::Vector3d c(1, -2, 1);
    for (Eigen::Index axis = 0; axis < shape_.axes(); ++axis) {
      for (Eigen::Index j = 0; j + 2 < count; ++j) {
        square.block<3, 3>(axis * count + j, axis * count + j) += c * c.transpose();
      }
    }
    return square;
  }

  /// One frame by itself: its pose and its bends. Returns the rms distance, cm.
  double follow(const FilmFrame& frame, Eigen::VectorXd& values, Pose& pose) const {
    const Eigen::Index m = values.size(), p = dims_ == 2 ? 3 : 6;
    const Eigen::MatrixXd smooth = first_smoothness * along_square();
    const auto rms_of = [&](const Eigen::MatrixXd& off) {
      return std::sqrt(off.squaredNorm() / static_cast<double>(off.cols()));
    };
    const auto cost_at = [&](const Eigen::VectorXd& v, const Pose& at, double far) {
      double cost = v.dot(smooth * v);
      const Eigen::MatrixXd off = distances(frame, v, at, now_.scale);
      for (Eigen::Index k = 0; k < off.cols(); ++k) cost += cost_of(off.col(k).norm(), far);
      return cost;
    };
    double damping = 1e-3;
    for (int round = 0; round < first_steps; ++round) {
      // What is far is told by the distances as they are: few points of a frame are outliers.
      std::vector<double> sizes;
      const Eigen::MatrixXd off = distances(frame, values, pose, now_.scale);
      for (Eigen::Index k = 0; k < off.cols(); ++k) sizes.push_back(off.col(k).norm());
      std::ranges::nth_element(sizes,
                               sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2));
      const double far = std::max(2.5 * sizes[sizes.size() / 2], 1e-4 * model_.length());
      Misfit misfit = this->misfit(frame, values, pose, now_.scale, p);
      weigh(misfit, far);
      Eigen::MatrixXd rate(misfit.off.size(), m + p);
      rate << misfit.rate, misfit.by_pose;
      Eigen::MatrixXd square = rate.transpose() * rate;
      square.topLeftCorner(m, m) += smooth;
      Eigen::VectorXd gradient = rate.transpose() * misfit.off;
      gradient.head(m) += smooth * values;
      const double before = cost_at(values, pose, far);
      bool better = false;
      while (damping < 1e6) {
        Eigen::MatrixXd damped = square;
        damped.diagonal() *= 1 + damping;
        damped.diagonal().array() += 1e-9;
        const Eigen::VectorXd step = -damped.ldlt().solve(gradient);
        const Eigen::VectorXd next = values + step.head(m);
        const Pose then = moved(pose, step.tail(p), now_.scale);
        const double after = cost_at(next, then, far);
        if (after < before) {
          better = before - after > 1e-4 * before;
          values = next;
          pose = then;
          damping *= 0.2;
          break;
        }
        damping *= 5;
      }
      if (!better) break;
    }
    return rms_of(distances(frame, values, pose, now_.scale));
  }

  /// Turns bends (about Y, then about Z) by a roll of the head's axes.
  Eigen::VectorXd rolled(const Eigen::VectorXd& values, double roll) const {
    if (dims_ == 2) return values;
    const Eigen::Index n = shape_.stations();
    Eigen::VectorXd out(values.size());
    out.head(n) = std::cos(roll) * values.head(n) - std::sin(roll) * values.tail(n);
    out.tail(n) = std::sin(roll) * values.head(n) + std::cos(roll) * values.tail(n);
    return out;
  }

  /// Frames by themselves, from the curve through their points; then the program through them.
  void begin() {
    const std::vector<FilmFrame>& frames = film_.frames;
    const std::size_t stride =
        std::max<std::size_t>(1, frames.size() / (knots_.size() * first_frames));
    std::vector<std::size_t> which;
    std::vector<Eigen::VectorXd> values;
    std::vector<Pose> poses;
    Eigen::VectorXd last;
    for (std::size_t f = 0; f < frames.size(); f += stride) {
      if (frames[f].place.size() < first_points) continue;
      const CurveBends bends = bends_along(curve_through(frames[f]), shape_.stations());
      Eigen::VectorXd own(shape_.values());
      if (dims_ == 2) {
        own = bends.bends.col(1);
      } else {
        own << bends.bends.col(0), bends.bends.col(1);
      }
      Pose pose{bends.head, Eigen::Vector3d::Zero()};
      const Eigen::Matrix3Xd shape = shape_.points(own, frames[f].place) / now_.scale;
      pose.shift = (frames[f].point - pose.rotation * shape).rowwise().mean();
      double rms = follow(frames[f], own, pose);
      if (last.size() > 0) {
        Eigen::VectorXd other = last;
        Pose there = poses.back();
        if (follow(frames[f], other, there) < 0.9 * rms) {
          own = other;
          pose = there;
        }
      }
      last = own;
      which.push_back(f);
      values.push_back(own);
      poses.push_back(pose);
    }
    if (which.size() < 2) {
      throw InputError(std::to_string(first_points) +
                       " points or more in two of its midlines are needed");
    }
    // One roll of the head for all, about which a midline says nothing.
    Eigen::Vector3d along, at;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> a, b;
      for (const Pose& pose : poses) {
        a.push_back(pose.rotation(axis, 0));
        b.push_back(pose.shift[axis]);
      }
      const auto middle = static_cast<std::ptrdiff_t>(a.size() / 2);
      std::ranges::nth_element(a, a.begin() + middle);
      std::ranges::nth_element(b, b.begin() + middle);
      along[axis] = a[middle];
      at[axis] = b[middle];
    }
    if (along.norm() < 1e-3) along = poses.front().rotation.col(0);
    const Eigen::Matrix3d mean = turn_to(along.normalized());
    for (std::size_t i = 0; i < which.size(); ++i) {
      const Eigen::Vector3d own_along = mean.transpose() * poses[i].rotation.col(0);
      Eigen::Matrix3d target = mean * turn_to(own_along);
      const auto roll_to = [&](const Eigen::Matrix3d& to) {
        const Eigen::Matrix3d by = to.transpose() * poses[i].rotation;
        return std::atan2(by(2, 1), by(1, 1));
      };
      double roll = roll_to(target);
      if (!still_ && i > 0 && dims_ == 3) {  // as little motion as can be
        const Eigen::Index n = shape_.stations();
        const auto turned = rolled(values[i], roll);
        const double same = turned.dot(values[i - 1]);
        const double across =
            turned.head(n).dot(values[i - 1].tail(n)) - turned.tail(n).dot(values[i - 1].head(n));
        const double more = std::atan2(across, same);
        target = target * Eigen::AngleAxisd(-more, Eigen::Vector3d::UnitX()).toRotationMatrix();
        roll += more;
      }
      values[i] = rolled(values[i], roll);
      poses[i].rotation = dims_ == 2 ? poses[i].rotation : target;
    }
    if (still_) {
      now_.pose[0] = {mean, at};
    } else {
      for (std::size_t f = 0, i = 0; f < frames.size(); ++f) {
        while (i + 1 < which.size() && which[i + 1] <= f) ++i;
        now_.pose[f] = poses[i];
      }
    }
    through(which, values);
  }

  /// The program whose values at the frames are nearest to `values`, smooth where none are.
  void through(const std::vector<std::size_t>& which, const std::vector<Eigen::VectorXd>& values) {
    const auto n = static_cast<Eigen::Index>(knots_.size());
    Eigen::MatrixXd form = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, shape_.values());
    for (std::size_t i = 0; i < which.size(); ++i) {
      const TablePlace at = when(which[i]);
      const auto k = static_cast<Eigen::Index>(at.index);
      Eigen::Vector2d shares(1 - at.share, at.share);
      form.block<2, 2>(k, k) += shares * shares.transpose();
      right.middleRows<2>(k) += shares * values[i].transpose();
    }
    for (Eigen::Index k = 0; k + 2 < n; ++k) {
      const Eigen::Vector3d c(1, -2, 1);
      form.block<3, 3>(k, k) += 0.01 * c * c.transpose();
    }
    form.diagonal().array() += 1e-9;
    now_.values = form.ldlt().solve(right).transpose();
  }

  void measure_noise() {
    std::vector<double> squares;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off =
          distances(film_.frames[f], values_at(now_, f), pose_of(now_, f), now_.scale);
      for (Eigen::Index k = 0; k < off.cols(); ++k) squares.push_back(off.col(k).squaredNorm());
    }
    // What nine tenths are within, so that none but outliers are far to begin with.
    const auto most = squares.begin() + static_cast<std::ptrdiff_t>(9 * squares.size() / 10);
    std::ranges::nth_element(squares, most);
    const double of_normal = dims_ == 3 ? 6.25 : 4.61;  // the same of chi squared
    noise_ = std::max(std::sqrt(*most / of_normal), least_noise * model_.length());
  }

  double far() const { return reach * noise_; }

  /// What smooths and what stops at limits.
  double prior_cost(const Unknowns& x) const {
    double cost = 0;
    const Eigen::Index times = x.values.cols(), n = shape_.stations();
    for (Eigen::Index k = 0; k < times; ++k) {
      cost += along_ * along_at_[k] * x.values.col(k).dot(along_form_ * x.values.col(k));
      if (k + 2 < times) {
        cost += in_time_ * time_at_[k] *
                (x.values.col(k) - 2 * x.values.col(k + 1) + x.values.col(k + 2)).squaredNorm();
      }
      if (!still_ && k + 1 < times) {
        cost += least_motion * in_time_ * (x.values.col(k + 1) - x.values.col(k)).squaredNorm();
      }
      for (Eigen::Index j = 0; j < n; ++j) {
        const double past = bend(x, k, j) - limit_[j];
        if (past > 0) cost += wall_ * past * past;
      }
    }
    return cost;
  }
  double bend(const Unknowns& x, Eigen::Index time, Eigen::Index station) const {
    return dims_ == 2
               ? std::abs(x.values(station, time))
               : std::hypot(x.values(station, time), x.values(shape_.stations() + station, time));
  }
  double cost(const Unknowns& x) const {
    double sum = prior_cost(x);
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off =
          distances(film_.frames[f], values_at(x, f), pose_of(x, f), x.scale);
      for (Eigen::Index k = 0; k < off.cols(); ++k) sum += cost_of(off.col(k).norm(), far());
    }
    return sum;
  }

  /// What a free head's frame keeps, so that its own pose can follow a step of the rest.
  struct FramePose {
    Eigen::LLT<Eigen::MatrixXd> own;
    Eigen::MatrixXd by_first, by_second;  // pose x values, of the two times
    Eigen::MatrixXd by_border;
    Eigen::VectorXd gradient;
  };

  /// The matrix and the gradient of the cost at now_ (Gauss and Newton), half of each. Returns the
  /// cost.
  double assemble() {
    const Eigen::Index m = shape_.values();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    matrix_.clear();
    gradient_ = Eigen::VectorXd::Zero(times * m + border_);
    frame_pose_.resize(still_ ? 0 : film_.frames.size());
    double sum = 0;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const TablePlace at = when(f);
      const auto k = static_cast<Eigen::Index>(at.index);
      Misfit misfit = this->misfit(film_.frames[f], values_at(now_, f), pose_of(now_, f),
                                   now_.scale, pose_size_);
      sum += weigh(misfit, far());
      Eigen::MatrixXd square = misfit.rate.transpose() * misfit.rate;
      Eigen::VectorXd slope = misfit.rate.transpose() * misfit.off;
      Eigen::MatrixXd by_border(misfit.off.size(), border_);
      if (still_ && scaled_) {
        by_border << misfit.by_pose, misfit.by_scale;
      } else if (still_) {
        by_border = misfit.by_pose;
      } else if (scaled_) {
        by_border = misfit.by_scale;
      }
      Eigen::MatrixXd beside = misfit.rate.transpose() * by_border;
      Eigen::MatrixXd corner = by_border.transpose() * by_border;
      Eigen::VectorXd border_slope = by_border.transpose() * misfit.off;
      if (!still_) {
        FramePose& own = frame_pose_[f];
        Eigen::MatrixXd pose = misfit.by_pose.transpose() * misfit.by_pose;
        pose.diagonal().array() += pose_ridge * square.diagonal().maxCoeff() + 1e-9;
        own.own.compute(pose);
        const Eigen::MatrixXd by_values = misfit.by_pose.transpose() * misfit.rate;
        own.by_first = (1 - at.share) * by_values;
        own.by_second = at.share * by_values;
        own.by_border = misfit.by_pose.transpose() * by_border;
        own.gradient = misfit.by_pose.transpose() * misfit.off;
        const Eigen::MatrixXd solved = own.own.solve(by_values);
        square -= by_values.transpose() * solved;
        slope -= solved.transpose() * own.gradient;
        beside -= solved.transpose() * own.by_border;
        corner -= own.by_border.transpose() * own.own.solve(own.by_border);
        border_slope -= own.by_border.transpose() * own.own.solve(own.gradient);
      }
      const double shares[] = {1 - at.share, at.share};
      for (int a = 0; a < 2; ++a) {
        if (shares[a] == 0) continue;
        gradient_.segment((k + a) * m, m) += shares[a] * slope;
        if (border_ > 0) matrix_.add_border(k + a, shares[a] * beside);
        for (int b = 0; b <= a; ++b) {
          if (shares[b] != 0) matrix_.add(k + a, k + b, shares[a] * shares[b] * square);
        }
      }
      matrix_.corner() += corner;
      gradient_.tail(border_) += border_slope;
    }
    size_ = std::max(matrix_.diagonal().head(times * m).maxCoeff(), 1e-12);
    bound_smoothness();
    wall_ = wall * size_;
    add_prior();
    // What nothing tells, such as the roll of a free head, stays where it is.
    for (Eigen::Index k = 0; k < times; ++k) {
      for (Eigen::Index j = 0; j < m; ++j) matrix_.add_diagonal(k, j, j, untold * size_);
    }
    return sum + prior_cost(now_);
  }

  void bound_smoothness() {
    in_time_ = std::clamp(in_time_, least_smoothness * size_, most_smoothness * size_);
    along_ = std::clamp(along_, least_smoothness * size_, most_smoothness * size_);
  }

  void add_prior() {
    const Eigen::Index m = shape_.values(), n = shape_.stations();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(m, m);
    const double c[] = {1, -2, 1};
    for (Eigen::Index k = 0; k < times; ++k) {
      const double along = along_ * along_at_[k], in_time = in_time_ * time_at_[k];
      matrix_.add(k, k, along * along_form_);
      gradient_.segment(k * m, m) += along * along_form_ * now_.values.col(k);
      if (k + 2 < times) {
        const Eigen::VectorXd bend =
            now_.values.col(k) - 2 * now_.values.col(k + 1) + now_.values.col(k + 2);
        for (int a = 0; a < 3; ++a) {
          gradient_.segment((k + a) * m, m) += in_time * c[a] * bend;
          for (int b = 0; b <= a; ++b) matrix_.add(k + a, k + b, in_time * c[a] * c[b] * unit);
        }
      }
      if (!still_ && k + 1 < times) {
        const double weight = least_motion * in_time_;
        const Eigen::VectorXd change = now_.values.col(k + 1) - now_.values.col(k);
        gradient_.segment((k + 1) * m, m) += weight * change;
        gradient_.segment(k * m, m) -= weight * change;
        matrix_.add(k, k, weight * unit);
        matrix_.add(k + 1, k + 1, weight * unit);
        matrix_.add(k + 1, k, -weight * unit);
      }
      for (Eigen::Index j = 0; j < n; ++j) {
        const double size = bend(now_, k, j), past = size - limit_[j];
        if (!(past > 0)) continue;
        for (Eigen::Index a = 0; a < shape_.axes(); ++a) {
          const double first = now_.values(a * n + j, k) / size;
          gradient_[k * m + a * n + j] += wall_ * past * first;
          for (Eigen::Index b = 0; b < shape_.axes(); ++b) {
            matrix_.add_diagonal(k, a * n + j, b * n + j,
                                 wall_ * first * now_.values(b * n + j, k) / size);
          }
        }
      }
    }
  }

  Unknowns stepped(const Eigen::VectorXd& step) const {
    const Eigen::Index m = shape_.values();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    Unknowns next = now_;
    next.values += Eigen::MatrixXd::Map(step.data(), m, times);
    if (scaled_) next.scale *= std::exp(std::clamp(step[step.size() - 1], -1.0, 1.0));
    if (still_) {
      next.pose[0] = moved(now_.pose[0], step.segment(times * m, pose_size_), now_.scale);
    } else {
      for (std::size_t f = 0; f < next.pose.size(); ++f) {
        const FramePose& own = frame_pose_[f];
        const auto k = static_cast<Eigen::Index>(when(f).index);
        const Eigen::VectorXd rest = own.gradient + own.by_first * step.segment(k * m, m) +
                                     own.by_second * step.segment((k + 1) * m, m) +
                                     own.by_border * step.tail(border_);
        next.pose[f] = moved(now_.pose[f], -own.own.solve(rest), now_.scale);
      }
    }
    return next;
  }

  /// Levenberg and Marquardt's steps at this noise and smoothness. Whether the gradient vanished.
  bool descend() {
    double damping = 1e-4;
    for (int step = 0; step < steps; ++step) {
      const double before = assemble();
      for (;;) {
        if (damping > 1e8) return false;
        Eigen::VectorXd by;
        if (matrix_.factor(damping)) by = -matrix_.solve(gradient_);
        if (by.size() > 0 && by.allFinite()) {
          const double decrement = -gradient_.dot(by);
          if (decrement <= settled_decrement * settled_decrement * noise_ * noise_ ||
              decrement <= 1e-9 * before) {
            return true;
          }
          const Unknowns next = stepped(by);
          const double after = cost(next);
          if (after < before) {
            now_ = next;
            damping = std::max(1e-9, 0.1 * damping);
            break;
          }
        }
        damping = std::max(1e-6, 10 * damping);
      }
    }
    return false;
  }

  /// Traces of (what smooths)^-1 times its parts along the body and in time. The two parts commute,
  /// and their eigenvalues are those of second differences with free ends, but for the ends.
  std::pair<double, double> prior_traces() const {
    const auto eigenvalues = [](Eigen::Index n) {
      Eigen::VectorXd values = Eigen::VectorXd::Zero(n);
      for (Eigen::Index k = 2; k < n; ++k) {
        const double root =
            2 * std::sin(M_PI * static_cast<double>(k) / static_cast<double>(2 * n));
        values[k] = root * root * root * root;
      }
      return values;
    };
    const Eigen::VectorXd along = eigenvalues(shape_.stations());
    const Eigen::VectorXd time = eigenvalues(static_cast<Eigen::Index>(knots_.size()));
    double along_trace = 0, time_trace = 0;
    for (const double a : along) {
      for (const double t : time) {
        const double both = along_ * a + in_time_ * t;
        if (!(both > 0)) continue;
        along_trace += a / both;
        time_trace += t / both;
      }
    }
    const auto axes = static_cast<double>(shape_.axes());
    return {axes * along_trace, axes * time_trace};
  }

  /// How smooth each time is to be, over all of them: by what its differences are expected to be,
  /// in the mean of the times around it. An animal rests and moves.
  Eigen::VectorXd around(const Eigen::VectorXd& squares, Eigen::Index count) const {
    Eigen::VectorXd at = Eigen::VectorXd::Ones(squares.size());
    if (count < 1) return at;
    const double mean = squares.head(count).mean();
    const auto reaches = static_cast<Eigen::Index>(around_time / (knots_[1] - knots_[0]));
    for (Eigen::Index k = 0; k < count; ++k) {
      const Eigen::Index from = std::max<Eigen::Index>(0, k - reaches);
      const Eigen::Index to = std::min(count - 1, k + reaches);
      const double here = squares.segment(from, to - from + 1).mean();
      at[k] = std::clamp(mean / std::max(here, 1e-12), 1 / most_uneven, most_uneven);
    }
    return at;
  }

  /// Noise and smoothness from what is left (Fellner and Schall's update). False where the matrix
  /// says too little.
  bool estimate() {
    assemble();
    if (!matrix_.factor(0)) return false;
    const BlockArrow::Inverse inverse = matrix_.inverse();
    const Eigen::Index m = shape_.values();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    Eigen::VectorXd along_trace = Eigen::VectorXd::Zero(times), along_squares = along_trace,
                    time_trace = along_trace, time_squares = along_trace;
    for (Eigen::Index k = 0; k < times; ++k) {
      along_trace[k] = inverse.own[k].cwiseProduct(along_form_).sum();
      along_squares[k] = now_.values.col(k).dot(along_form_ * now_.values.col(k));
      if (k + 2 >= times) continue;
      time_trace[k] = inverse.own[k].trace() + 4 * inverse.own[k + 1].trace() +
                      inverse.own[k + 2].trace() - 4 * inverse.one_below[k].trace() -
                      4 * inverse.one_below[k + 1].trace() + 2 * inverse.two_below[k].trace();
      time_squares[k] =
          (now_.values.col(k) - 2 * now_.values.col(k + 1) + now_.values.col(k + 2)).squaredNorm();
    }
    // What is far counts as just as far as squares reach, so that noise does not shrink to that of
    // the points which happen to be nearest.
    double squares = 0;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off =
          distances(film_.frames[f], values_at(now_, f), pose_of(now_, f), now_.scale);
      squares += off.colwise().squaredNorm().cwiseMin(far() * far()).sum();
    }
    const auto count = static_cast<double>(dims_ * points());
    const double along_sum = along_trace.dot(along_at_), time_sum = time_trace.dot(time_at_);
    const double told = static_cast<double>(times * m) - along_ * along_sum - in_time_ * time_sum +
                        static_cast<double>(still_ ? border_ : pose_size_ * now_.pose.size());
    const double free = std::max(count - std::max(told, 0.0), 0.05 * count);
    noise_ = std::max(std::sqrt(squares / std::max(free, 1.0)), least_noise * model_.length());
    const auto [along_prior, time_prior] = prior_traces();
    // Fellner and Schall's factor, no more than `largest_change` at once. Where the points tell
    // next to nothing of a difference, the two traces differ by rounding alone.
    const auto factor = [&](double now, double prior, double trace, double differences) {
      const double known = std::max(prior - trace, trace_rounding * prior);
      const double wanted = noise_ * noise_ * known / std::max(differences, 1e-12);
      return std::clamp(wanted, 1 / largest_change, largest_change) * now;
    };
    along_ = factor(along_, along_prior, along_sum, along_squares.dot(along_at_));
    in_time_ = factor(in_time_, time_prior, time_sum, time_squares.dot(time_at_));
    along_at_ = around(along_squares + noise_ * noise_ * along_trace, times);
    time_at_ = around(time_squares + noise_ * noise_ * time_trace, times - 2);
    bound_smoothness();
    return true;
  }

  Eigen::Index points() const {
    Eigen::Index count = 0;
    for (const FilmFrame& frame : film_.frames) count += frame.point.cols();
    return count;
  }

  FilmFit result(bool settled) {
    FilmFit fit;
    const auto times = static_cast<Eigen::Index>(knots_.size());
    const Eigen::Index n = shape_.stations();
    fit.settled = settled;
    fit.noise = noise_;
    fit.scale = now_.scale;
    fit.program.time = knots_;
    fit.program.station = even(static_cast<int>(n), 1);
    double sum = 0, count = 0;
    double neighbours = 0, own = 0;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off =
          distances(film_.frames[f], values_at(now_, f), pose_of(now_, f), now_.scale);
      double squares = 0, all = 0;
      std::vector<bool>& used = fit.used.emplace_back();
      for (Eigen::Index k = 0; k < off.cols(); ++k) {
        const double square = off.col(k).squaredNorm();
        used.push_back(square <= far() * far());
        all += square;
        if (!used.back()) continue;
        squares += square;
        if (k > 0 && used[k - 1]) neighbours += off.col(k).dot(off.col(k - 1));
        own += square;
      }
      const auto near = static_cast<double>(std::ranges::count(used, true));
      sum += squares;
      count += near;
      const auto points = static_cast<double>(off.cols());
      fit.rms_at.push_back(2 * near >= points ? std::sqrt(squares / near)
                                              : std::sqrt(all / points));
    }
    fit.rms = std::sqrt(sum / std::max(count, 1.0));
    for (Eigen::Index k = 0; k < times; ++k) {
      Eigen::Matrix3Xd& value = fit.program.value.emplace_back(Eigen::Matrix3Xd::Zero(3, n));
      for (Eigen::Index j = 0; j < n; ++j) {
        if (dims_ == 3) value(0, j) = now_.values(j, k);
        value(1, j) = now_.values((shape_.axes() - 1) * n + j, k);
        const double share = bend(now_, k, j) / limit_[j];
        if (share > fit.of_limit) {
          fit.of_limit = share;
          fit.of_limit_time = knots_[k] + film_.frames.front().time;
          fit.of_limit_station = fit.program.station[j];
        }
      }
    }
    errors(std::clamp(own > 0 ? neighbours / own : 0, 0.0, 0.9), fit);
    return fit;
  }

  /// Standard errors, by the inverse of the matrix. Neighbouring points whose distances are alike
  /// tell less than they would by themselves: `alike` is their correlation.
  void errors(double alike, FilmFit& fit) {
    const Eigen::Index n = shape_.stations();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    assemble();
    if (!still_ && dims_ == 3) {
      // Bends of a free head are told but for a roll of all of them at a time.
      for (Eigen::Index k = 0; k < times; ++k) {
        Eigen::VectorXd roll(2 * n);
        roll << -now_.values.col(k).tail(n), now_.values.col(k).head(n);
        if (roll.norm() > 0)
          matrix_.add(k, k, size_ * roll * roll.transpose() / roll.squaredNorm());
      }
    }
    const bool told = matrix_.factor(0);
    BlockArrow::Inverse inverse;
    if (told) inverse = matrix_.inverse();
    const double variance = noise_ * noise_ * (1 + alike) / (1 - alike);
    for (Eigen::Index k = 0; k < times; ++k) {
      Eigen::Matrix3Xd& error = fit.error.emplace_back(Eigen::Matrix3Xd::Zero(3, n));
      for (Eigen::Index j = 0; j < shape_.values(); ++j) {
        const Eigen::Index row = dims_ == 2 ? 1 : j / n;
        error(row, j % n) = told ? std::sqrt(variance * inverse.own[k](j, j)) : INFINITY;
      }
    }
  }

  const Model& model_;
  const Film& film_;
  bool still_, scaled_;
  Eigen::Index dims_;
  std::vector<double> knots_;  // times of the program
  ProgramShape shape_;
  Eigen::Index pose_size_, border_;
  BlockArrow matrix_;
  Eigen::VectorXd gradient_;
  std::vector<FramePose> frame_pose_;
  Unknowns now_;
  Eigen::VectorXd limit_;  // by station
  Eigen::MatrixXd along_form_ = along_square();
  double noise_ = 0;  // cm
  double in_time_ = first_smoothness, along_ = first_smoothness;
  Eigen::VectorXd along_at_, time_at_;  // by time, over these
  double wall_ = 0, size_ = 1;          // of the matrix
};

}  // namespace

FilmFit fit_film(const Model& model, const Film& film, FilmHead head, int times, int stations) {
  if (times < 2 || stations < 2 || stations > model.body_count() / 4) {
    throw std::invalid_argument("2 times, 2 stations to a quarter of the bodies");
  }
  return Fit(model, film, head, times, stations).run();
}

}  // namespace hagfish
