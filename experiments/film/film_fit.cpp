#include "experiments/film/film_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

constexpr int following_rounds = 12;  // Gauss-Newton of one time, from the time before
constexpr int last_rounds = 8;        // of all together
constexpr double settled =
    1e-4;  // relative change of the sum of squares at which a round is the last
/// Of the diagonal, added to it: stations beyond the last point would be left undetermined.
constexpr double ridge = 1e-6;
/// Of the film, that are followed from one time of the program to the next, at least.
constexpr std::size_t frames_a_time = 4;
/// Weight of second differences along the body, cm of distance for 1 rad per length.
constexpr double smoothing = 0.01;
/// Of the body, whose points tell where a still head is and where it looks.
constexpr double head_share = 0.06;
/// A film's first frame is followed from straight in so many steps.
constexpr int unbending_steps = 8;

std::vector<double> even(int count, double last) {
  std::vector<double> knots(count);
  for (int k = 0; k < count; ++k) knots[k] = last * k / (count - 1);
  return knots;
}

/// Values of a program at one time, bend_y of all stations, then bend_z, as hinges' angles: nv x 2
/// stations, by what program_shape makes of them.
Eigen::MatrixXd shares_of(const Model& model, const std::vector<double>& stations) {
  const auto count = static_cast<Eigen::Index>(stations.size());
  Eigen::MatrixXd shares(model.nv(), 2 * count);
  for (Eigen::Index j = 0; j < 2 * count; ++j) {
    CurvatureProgram unit{{0}, stations, {Eigen::Matrix3Xd::Zero(3, count)}, {}};
    unit.value[0](j / count, j % count) = 1;
    shares.col(j) = program_shape(model, unit, 0);
  }
  return shares;
}

/// One frame against the shape of some values: distances and their rates.
struct Misfit {
  Eigen::VectorXd off;   ///< 3 x points, then what smooths
  Eigen::MatrixXd rate;  ///< of it, by each value
  Eigen::Matrix3Xd own;  ///< the shape's points, cm
  double squares = 0;    ///< of the points' distances
};

class Shape {
 public:
  Shape(const Model& model, const std::vector<double>& stations, FilmHead head)
      : model_(model), head_(head), shares_(shares_of(model, stations)) {
    const auto count = static_cast<Eigen::Index>(stations.size());
    smooth_ = Eigen::MatrixXd::Zero(2 * (count - 2), 2 * count);
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      for (Eigen::Index j = 0; j + 2 < count; ++j) {
        smooth_.block<1, 3>(axis * (count - 2) + j, axis * count + j) << smoothing, -2 * smoothing,
            smoothing;
      }
    }
  }

  Misfit misfit(const FilmFrame& frame, const Eigen::VectorXd& values) const {
    Eigen::VectorXd q = rest_state(model_).q;
    q.tail(q.size() - 7) = (shares_ * values).tail(q.size() - 7);
    Kinematics kin;
    update_positions(model_, q, kin);
    const Eigen::Index n = frame.point.cols();
    Eigen::Matrix3Xd own(3, n);
    for (Eigen::Index k = 0; k < n; ++k) own.col(k) = point_on(model_, kin, frame.place[k]);
    const bool free = head_ == FilmHead::free;
    const Eigen::Matrix3Xd film =
        free ? nearest_motion(frame.point, own).of(frame.point) : frame.point;
    Misfit misfit;
    const Eigen::MatrixXd moved = rates(kin, frame, own) * shares_;
    misfit.off.resize(own.size() + smooth_.rows());
    misfit.off << (own - film).reshaped(), smooth_ * values;
    misfit.rate.resize(misfit.off.size(), shares_.cols());
    misfit.rate << (free ? without_rigid(own, moved) : moved), smooth_;
    misfit.squares = (own - film).squaredNorm();
    misfit.own = own;
    return misfit;
  }
  Eigen::Index values() const { return shares_.cols(); }

 private:
  /// Of the points by each velocity, 3n x nv, the root's left 0: rigid motions are free.
  Eigen::MatrixXd rates(const Kinematics& kin, const FilmFrame& frame,
                        const Eigen::Matrix3Xd& own) const {
    Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(own.size(), model_.nv());
    for (Eigen::Index k = 0; k < own.cols(); ++k) {
      const int body = std::clamp(static_cast<int>(frame.place[k] * model_.body_count()), 0,
                                  model_.body_count() - 1);
      const Body& own_body = model_.bodies[body];
      for (int dof = root_dofs; dof < own_body.first_dof + own_body.dofs; ++dof) {
        rate.block<3, 1>(3 * k, dof) =
            point_velocity(kin.axis.col(dof), own.col(k) - kin.reference);
      }
    }
    return rate;
  }

  /// Takes from the rates what a rigid motion of all points can take back.
  static Eigen::MatrixXd without_rigid(const Eigen::Matrix3Xd& own, const Eigen::MatrixXd& rate) {
    const Eigen::Vector3d middle = own.rowwise().mean();
    Eigen::MatrixXd rigid(rate.rows(), 6);
    for (Eigen::Index k = 0; k < own.cols(); ++k) {
      const Eigen::Vector3d x = own.col(k) - middle;
      rigid.block<3, 3>(3 * k, 0).setIdentity();
      rigid.block<3, 3>(3 * k, 3) << 0, x.z(), -x.y(), -x.z(), 0, x.x(), x.y(), -x.x(), 0;
    }
    const Eigen::MatrixXd take =
        (rigid.transpose() * rigid + ridge * Eigen::MatrixXd::Identity(6, 6))
            .ldlt()
            .solve(rigid.transpose() * rate);
    return rate - rigid * take;
  }

  const Model& model_;
  FilmHead head_;
  Eigen::MatrixXd shares_, smooth_;
};

/// The motion that brings a film with a still head to the animal at the origin along +X, by its
/// first points at all times; how it is rolled is as it comes.
RigidMotion to_head(const Film& film) {
  Eigen::Vector3d head = Eigen::Vector3d::Zero(), along = head;
  double count = 0;
  for (const FilmFrame& frame : film.frames) {
    head += frame.point.col(0) / static_cast<double>(film.frames.size());
    for (Eigen::Index k = 1; k < frame.point.cols() && frame.place[k] < head_share; ++k) {
      along += frame.point.col(k);
      ++count;
    }
  }
  if (count == 0) {
    for (const FilmFrame& frame : film.frames) along += frame.point.col(1);
    count = static_cast<double>(film.frames.size());
  }
  RigidMotion motion;
  motion.rotation =
      Eigen::Quaterniond::FromTwoVectors(along / count - head, Eigen::Vector3d::UnitX())
          .toRotationMatrix();
  motion.shift = -(motion.rotation * head);
  return motion;
}

/// Moves the film as a whole to where it is nearest to `own`, its frames one after another.
void move_to(const std::vector<Eigen::Matrix3Xd>& own, Film& film) {
  Eigen::Index count = 0;
  for (const Eigen::Matrix3Xd& points : own) count += points.cols();
  Eigen::Matrix3Xd from(3, count), to(3, count);
  Eigen::Index at = 0;
  for (std::size_t f = 0; f < own.size(); ++f) {
    from.middleCols(at, own[f].cols()) = film.frames[f].point;
    to.middleCols(at, own[f].cols()) = own[f];
    at += own[f].cols();
  }
  const RigidMotion motion = nearest_motion(from, to);
  for (FilmFrame& frame : film.frames) frame.point = motion.of(frame.point);
}

Eigen::VectorXd step_of(Eigen::MatrixXd matrix, const Eigen::VectorXd& gradient) {
  const double size = matrix.diagonal().maxCoeff();
  matrix.diagonal().array() += ridge * size;
  return -matrix.ldlt().solve(gradient);
}

/// Moves `values` to the shape nearest to one frame.
void follow(const Shape& shape, const FilmFrame& frame, Eigen::VectorXd& values) {
  Misfit now = shape.misfit(frame, values);
  double damping = 1;
  for (int round = 0; round < following_rounds; ++round) {
    const Eigen::VectorXd step =
        step_of(now.rate.transpose() * now.rate, now.rate.transpose() * now.off);
    const Eigen::VectorXd next = values + damping * step;
    const Misfit then = shape.misfit(frame, next);
    const double before = now.off.squaredNorm(), after = then.off.squaredNorm();
    if (after < before) {
      values = next;
      now = then;
      damping = std::min(1.0, 2 * damping);
      if (before - after < settled * before) return;
    } else {
      damping *= 0.5;
    }
  }
}

/// The frame unbent towards a straight line of its points, by `share` 0 straight to 1 as it is.
FilmFrame unbent(const FilmFrame& frame, double length, double share) {
  FilmFrame out = frame;
  Eigen::Matrix3Xd straight = Eigen::Matrix3Xd::Zero(3, frame.point.cols());
  for (Eigen::Index k = 0; k < frame.point.cols(); ++k) straight(0, k) = frame.place[k] * length;
  out.point =
      share * nearest_motion(frame.point, straight).of(frame.point) + (1 - share) * straight;
  return out;
}

}  // namespace

FilmFit fit_film(const Model& model, const Film& given, FilmHead head, int times, int stations) {
  Film film = given;
  // The film's animal may be of another length.
  for (FilmFrame& frame : film.frames) frame.point *= model.length() / film.length;
  if (head == FilmHead::still) {
    const RigidMotion motion = to_head(film);
    for (FilmFrame& frame : film.frames) frame.point = motion.of(frame.point);
  }
  const std::vector<FilmFrame>& frames = film.frames;
  if (times < 2 || times > static_cast<int>(frames.size()) || stations < 2 ||
      stations > model.body_count() / 4) {
    throw std::invalid_argument(
        "2 times to as many as frames, 2 stations to a quarter of the bodies");
  }
  const double begin = frames.front().time, last = frames.back().time - begin;
  FilmFit fit;
  CurvatureProgram& program = fit.program;
  program.time = even(times, last);
  program.station = even(stations, 1);
  const Shape shape(model, program.station, head);
  const Eigen::Index count = shape.values();
  // Each time by itself, from the one before.
  Eigen::VectorXd values = Eigen::VectorXd::Zero(count);
  for (int k = 1; k < unbending_steps; ++k) {
    follow(shape, unbent(frames.front(), model.length(), static_cast<double>(k) / unbending_steps),
           values);
  }
  Eigen::VectorXd all(count * times);
  const std::size_t stride = std::max<std::size_t>(1, frames.size() / (times * frames_a_time));
  std::size_t next = 0;
  for (int k = 0; k < times; ++k) {
    const double until = k + 1 == times ? INFINITY : program.time[k];
    for (; next < frames.size() && frames[next].time - begin <= until; next += stride) {
      follow(shape, frames[next], values);
    }
    all.segment(k * count, count) = values;
  }
  // All together: each frame lies between two times.
  const auto at_time = [&](const Eigen::VectorXd& of, double time, int& k, double& share) {
    k = std::clamp(static_cast<int>(time / last * (times - 1)), 0, times - 2);
    share = (time - program.time[k]) / (program.time[k + 1] - program.time[k]);
    return ((1 - share) * of.segment(k * count, count) + share * of.segment((k + 1) * count, count))
        .eval();
  };
  double before = INFINITY;
  for (int round = 0; round <= last_rounds; ++round) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(all.size(), all.size());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(all.size());
    double sum = 0, points = 0;
    std::vector<double> rms_at;
    std::vector<Eigen::Matrix3Xd> own_points;
    for (const FilmFrame& frame : frames) {
      int k = 0;
      double share = 0;
      const Eigen::VectorXd own = at_time(all, frame.time - begin, k, share);
      const Misfit misfit = shape.misfit(frame, own);
      const Eigen::MatrixXd square = misfit.rate.transpose() * misfit.rate;
      const Eigen::VectorXd slope = misfit.rate.transpose() * misfit.off;
      const double shares[] = {1 - share, share};
      for (int a = 0; a < 2; ++a) {
        gradient.segment((k + a) * count, count) += shares[a] * slope;
        for (int b = 0; b < 2; ++b) {
          matrix.block((k + a) * count, (k + b) * count, count, count) +=
              shares[a] * shares[b] * square;
        }
      }
      const double n = static_cast<double>(frame.point.cols());
      rms_at.push_back(std::sqrt(misfit.squares / n));
      sum += misfit.squares;
      own_points.push_back(misfit.own);
      points += n;
    }
    if (!(sum < before)) break;
    // The best so far is kept.
    fit.rms = std::sqrt(sum / points);
    fit.rms_at = rms_at;
    program.value.clear();
    for (int k = 0; k < times; ++k) {
      Eigen::Matrix3Xd& value = program.value.emplace_back(Eigen::Matrix3Xd::Zero(3, stations));
      for (int i = 0; i < 2; ++i) {
        value.row(i) = all.segment(k * count + i * stations, stations).transpose();
      }
    }
    if (before - sum < settled * sum) break;
    before = sum;
    all += step_of(matrix, gradient);
    if (head == FilmHead::still) move_to(own_points, film);
  }
  return fit;
}

}  // namespace hagfish
