#include "experiments/film/fit/film_begin.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/input/input_error.hpp"
#include "experiments/film/fit/film_curve.hpp"

namespace hagfish {
namespace {

/// Frames that are fitted by themselves to begin with, for each time of the program, at most.
constexpr std::size_t first_frames = 6;
/// Points that a frame needs for that.
constexpr std::size_t first_points = 6;
constexpr int first_steps = 30;  // of Levenberg and Marquardt, for one frame

/// Frames of a film that were fitted by themselves.
struct Frames {
  std::vector<std::size_t> which;
  std::vector<Eigen::VectorXd> values;
  std::vector<FilmPose> poses;
};

/// One frame by itself: its pose and its bends. Returns the rms distance, cm.
double follow(const ProgramShape& shape, const FilmFrame& frame, double scale,
              Eigen::VectorXd& values, FilmPose& pose) {
  const Eigen::Index m = values.size(), p = dimensions(shape) == 2 ? 3 : 6;
  const Eigen::MatrixXd smooth = first_smoothness * along_square(shape);
  const auto rms_of = [&](const Eigen::MatrixXd& off) {
    return std::sqrt(off.squaredNorm() / static_cast<double>(off.cols()));
  };
  const auto cost_at = [&](const Eigen::VectorXd& v, const FilmPose& at, double far) {
    double cost = v.dot(smooth * v);
    const Eigen::MatrixXd off = distances(shape, frame, v, at, scale);
    for (Eigen::Index k = 0; k < off.cols(); ++k) cost += cost_of(off.col(k).norm(), far);
    return cost;
  };
  double damping = 1e-3;
  for (int round = 0; round < first_steps; ++round) {
    // What is far is told by the distances as they are: few points of a frame are outliers.
    std::vector<double> sizes;
    const Eigen::MatrixXd off = distances(shape, frame, values, pose, scale);
    for (Eigen::Index k = 0; k < off.cols(); ++k) sizes.push_back(off.col(k).norm());
    std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2));
    const double far = std::max(2.5 * sizes[sizes.size() / 2], 1e-4 * shape.model().length());
    Misfit misfit = hagfish::misfit(shape, frame, values, pose, scale, p);
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
      const FilmPose then = moved(pose, step.tail(p), scale);
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
  return rms_of(distances(shape, frame, values, pose, scale));
}

/// Turns bends (about Y, then about Z) by a roll of the head's axes.
Eigen::VectorXd rolled(const ProgramShape& shape, const Eigen::VectorXd& values, double roll) {
  if (dimensions(shape) == 2) return values;
  const Eigen::Index n = shape.stations();
  Eigen::VectorXd out(values.size());
  out.head(n) = std::cos(roll) * values.head(n) - std::sin(roll) * values.tail(n);
  out.tail(n) = std::sin(roll) * values.head(n) + std::cos(roll) * values.tail(n);
  return out;
}

Frames follow_frames(const ProgramShape& shape, const Film& film, std::size_t times, double scale) {
  const std::vector<FilmFrame>& frames = film.frames;
  const std::size_t stride = std::max<std::size_t>(1, frames.size() / (times * first_frames));
  Frames begun;
  Eigen::VectorXd last;
  for (std::size_t f = 0; f < frames.size(); f += stride) {
    if (frames[f].place.size() < first_points) continue;
    const CurveBends bends = bends_along(curve_through(frames[f]), shape.stations());
    Eigen::VectorXd own(shape.values());
    if (dimensions(shape) == 2) {
      own = bends.bends.col(1);
    } else {
      own << bends.bends.col(0), bends.bends.col(1);
    }
    FilmPose pose{bends.head, Eigen::Vector3d::Zero()};
    const Eigen::Matrix3Xd placed = shape.points(own, frames[f].place) / scale;
    pose.shift = (frames[f].point - pose.rotation * placed).rowwise().mean();
    double rms = follow(shape, frames[f], scale, own, pose);
    if (last.size() > 0) {
      Eigen::VectorXd other = last;
      FilmPose there = begun.poses.back();
      if (follow(shape, frames[f], scale, other, there) < 0.9 * rms) {
        own = other;
        pose = there;
      }
    }
    last = own;
    begun.which.push_back(f);
    begun.values.push_back(own);
    begun.poses.push_back(pose);
  }
  if (begun.which.size() < 2) {
    throw InputError(std::to_string(first_points) +
                     " points or more are needed in at least two midlines");
  }
  return begun;
}

/// The middle of the poses: along the head, and where it is.
FilmPose middle_pose(const std::vector<FilmPose>& poses) {
  Eigen::Vector3d along, at;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> a, b;
    for (const FilmPose& pose : poses) {
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
  return {turn_to(along.normalized()), at};
}

/// One roll of the head for all, about which a midline says nothing.
void roll_alike(const ProgramShape& shape, const Eigen::Matrix3d& mean, bool still,
                Frames& frames) {
  std::vector<Eigen::VectorXd>& values = frames.values;
  std::vector<FilmPose>& poses = frames.poses;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Eigen::Vector3d own_along = mean.transpose() * poses[i].rotation.col(0);
    Eigen::Matrix3d target = mean * turn_to(own_along);
    const auto roll_to = [&](const Eigen::Matrix3d& to) {
      const Eigen::Matrix3d by = to.transpose() * poses[i].rotation;
      return std::atan2(by(2, 1), by(1, 1));
    };
    double roll = roll_to(target);
    if (!still && i > 0 && dimensions(shape) == 3) {  // as little motion as can be
      const Eigen::Index n = shape.stations();
      const auto turned = rolled(shape, values[i], roll);
      const double same = turned.dot(values[i - 1]);
      const double across =
          turned.head(n).dot(values[i - 1].tail(n)) - turned.tail(n).dot(values[i - 1].head(n));
      const double more = std::atan2(across, same);
      target = target * Eigen::AngleAxisd(-more, Eigen::Vector3d::UnitX()).toRotationMatrix();
      roll += more;
    }
    values[i] = rolled(shape, values[i], roll);
    poses[i].rotation = dimensions(shape) == 2 ? poses[i].rotation : target;
  }
}

/// The program whose values at the frames are nearest to theirs, smooth where none are.
Eigen::MatrixXd through(const ProgramShape& shape, const Film& film,
                        const std::vector<double>& knots, const Frames& frames) {
  const auto n = static_cast<Eigen::Index>(knots.size());
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, shape.values());
  for (std::size_t i = 0; i < frames.which.size(); ++i) {
    const Bracket at = film_place(film, frames.which[i], knots);
    const auto k = static_cast<Eigen::Index>(at.index);
    Eigen::Vector2d shares(1 - at.share, at.share);
    form.block<2, 2>(k, k) += shares * shares.transpose();
    right.middleRows<2>(k) += shares * frames.values[i].transpose();
  }
  for (Eigen::Index k = 0; k + 2 < n; ++k) {
    const Eigen::Vector3d c(1, -2, 1);
    form.block<3, 3>(k, k) += 0.01 * c * c.transpose();
  }
  form.diagonal().array() += 1e-9;
  return form.ldlt().solve(right).transpose();
}

}  // namespace

Bracket film_place(const Film& film, std::size_t frame, const std::vector<double>& knots) {
  Bracket place = bracket_of(knots, film.frames[frame].time - film.frames.front().time);
  if (place.index + 1 == knots.size()) place = {knots.size() - 2, 1};
  return place;
}

Eigen::MatrixXd along_square(const ProgramShape& shape) {
  const Eigen::Index count = shape.stations();
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(shape.values(), shape.values());
  const Eigen::Vector3d c(1, -2, 1);
  for (Eigen::Index axis = 0; axis < shape.axes(); ++axis) {
    for (Eigen::Index j = 0; j + 2 < count; ++j) {
      square.block<3, 3>(axis * count + j, axis * count + j) += c * c.transpose();
    }
  }
  return square;
}

FilmUnknowns begin_fit(const ProgramShape& shape, const Film& film,
                       const std::vector<double>& knots, bool still, double scale) {
  Frames frames = follow_frames(shape, film, knots.size(), scale);
  const FilmPose middle = middle_pose(frames.poses);
  roll_alike(shape, middle.rotation, still, frames);
  FilmUnknowns begin{through(shape, film, knots, frames), {middle}, scale};
  if (still) return begin;
  begin.pose.resize(film.frames.size());
  for (std::size_t f = 0, i = 0; f < film.frames.size(); ++f) {
    while (i + 1 < frames.which.size() && frames.which[i + 1] <= f) ++i;
    begin.pose[f] = frames.poses[i];
  }
  return begin;
}

}  // namespace hagfish
