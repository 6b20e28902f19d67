#include "experiments/film/fit/film_prior.hpp"

#include <algorithm>
#include <cmath>

#include "core/muscle/active_curvature.hpp"
#include "experiments/film/fit/film_begin.hpp"

namespace hagfish {
namespace {

/// Of the largest number on the matrix's diagonal: the least that smooths, the most, the wall at
/// the limits.
constexpr double least_smoothness = 1e-12, most_smoothness = 1, wall = 0.1;
/// Of smoothness, by which it changes from round to round at most; and of its traces.
constexpr double largest_change = 100, trace_rounding = 1e-9;
/// Smoothness is that of times up to this far, s, and differs from the mean by this factor at most.
constexpr double around_time = 0.75, most_uneven = 30;
/// Of second differences in time: a free head may roll, and rolls as little as it can.
constexpr double least_motion = 1e-3;

/// The most that both bends of a joint can be together, by station, rad per length.
Eigen::VectorXd limits(const ProgramShape& shape) {
  const Model& model = shape.model();
  const Eigen::Index count = shape.stations();
  Eigen::VectorXd limit = Eigen::VectorXd::Constant(count, INFINITY);
  const Eigen::Matrix2Xd range = hinge_ranges(model);
  for (Eigen::Index j = 0; j < count; ++j) {
    double nearest = INFINITY;
    for (std::size_t k = 0; k < model.hinges.size(); ++k) {
      const Hinge& hinge = model.hinges[k];
      if (hinge.axis == Axis::x) continue;
      const double away = std::abs(static_cast<double>(hinge.body) / model.body_count() -
                                   static_cast<double>(j) / static_cast<double>(count - 1));
      if (away >= nearest) continue;
      nearest = away;
      const double span = hinge_span(model, hinge.body);
      limit[j] = range(1, static_cast<Eigen::Index>(k)) * model.length() / span *
                 (model.cones.empty() && shape.axes() == 2 ? std::sqrt(2.0) : 1);
    }
  }
  return limit;
}

}  // namespace

FilmPrior::FilmPrior(const ProgramShape& shape, Eigen::Index times, double interval, bool still)
    : stations_(shape.stations()),
      axes_(shape.axes()),
      interval_(interval),
      still_(still),
      along_form_(along_square(shape)),
      limit_(limits(shape)),
      along_at_(Eigen::VectorXd::Ones(times)),
      time_at_(Eigen::VectorXd::Ones(times)),
      in_time_(first_smoothness),
      along_(first_smoothness) {}

double FilmPrior::cost(const Eigen::MatrixXd& values) const {
  double cost = 0;
  const Eigen::Index times = values.cols(), n = stations_;
  for (Eigen::Index k = 0; k < times; ++k) {
    cost += along_ * along_at_[k] * values.col(k).dot(along_form_ * values.col(k));
    if (k + 2 < times) {
      cost += in_time_ * time_at_[k] *
              (values.col(k) - 2 * values.col(k + 1) + values.col(k + 2)).squaredNorm();
    }
    if (!still_ && k + 1 < times) {
      cost += least_motion * in_time_ * (values.col(k + 1) - values.col(k)).squaredNorm();
    }
    for (Eigen::Index j = 0; j < n; ++j) {
      const double past = bend(values, k, j) - limit_[j];
      if (past > 0) cost += wall_ * past * past;
    }
  }
  return cost;
}

double FilmPrior::bend(const Eigen::MatrixXd& values, Eigen::Index time,
                       Eigen::Index station) const {
  return axes_ == 1 ? std::abs(values(station, time))
                    : std::hypot(values(station, time), values(stations_ + station, time));
}

void FilmPrior::bound(double size) {
  size_ = size;
  wall_ = wall * size;
  in_time_ = std::clamp(in_time_, least_smoothness * size, most_smoothness * size);
  along_ = std::clamp(along_, least_smoothness * size, most_smoothness * size);
}

void FilmPrior::add(const Eigen::MatrixXd& values, double share, BlockArrow& matrix,
                    Eigen::VectorXd& gradient) const {
  const Eigen::Index m = values.rows(), n = stations_;
  const Eigen::Index times = values.cols();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(m, m);
  const double c[] = {1, -2, 1};
  for (Eigen::Index k = 0; k < times; ++k) {
    const double along = share * along_ * along_at_[k], in_time = share * in_time_ * time_at_[k];
    matrix.add(k, k, along * along_form_);
    gradient.segment(k * m, m) += along * along_form_ * values.col(k);
    if (k + 2 < times) {
      const Eigen::VectorXd bend = values.col(k) - 2 * values.col(k + 1) + values.col(k + 2);
      for (int a = 0; a < 3; ++a) {
        gradient.segment((k + a) * m, m) += in_time * c[a] * bend;
        for (int b = 0; b <= a; ++b) matrix.add(k + a, k + b, in_time * c[a] * c[b] * unit);
      }
    }
    if (!still_ && k + 1 < times) {
      const double weight = share * least_motion * in_time_;
      const Eigen::VectorXd change = values.col(k + 1) - values.col(k);
      gradient.segment((k + 1) * m, m) += weight * change;
      gradient.segment(k * m, m) -= weight * change;
      matrix.add(k, k, weight * unit);
      matrix.add(k + 1, k + 1, weight * unit);
      matrix.add(k + 1, k, -weight * unit);
    }
    for (Eigen::Index j = 0; j < n; ++j) {
      const double size = bend(values, k, j), past = size - limit_[j];
      if (!(past > 0)) continue;
      for (Eigen::Index a = 0; a < axes_; ++a) {
        const double first = values(a * n + j, k) / size;
        gradient[k * m + a * n + j] += wall_ * past * first;
        for (Eigen::Index b = 0; b < axes_; ++b) {
          matrix.add_diagonal(k, a * n + j, b * n + j, wall_ * first * values(b * n + j, k) / size);
        }
      }
    }
  }
}

/// Traces of (what smooths)^-1 times its parts along the body and in time. The two parts commute,
/// and their eigenvalues are those of second differences with free ends, but for the ends.
std::pair<double, double> FilmPrior::own_traces() const {
  const auto eigenvalues = [](Eigen::Index n) {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(n);
    for (Eigen::Index k = 2; k < n; ++k) {
      const double root = 2 * std::sin(M_PI * static_cast<double>(k) / static_cast<double>(2 * n));
      values[k] = root * root * root * root;
    }
    return values;
  };
  const Eigen::VectorXd along = eigenvalues(stations_);
  const Eigen::VectorXd time = eigenvalues(along_at_.size());
  double along_trace = 0, time_trace = 0;
  for (const double a : along) {
    for (const double t : time) {
      const double both = along_ * a + in_time_ * t;
      if (!(both > 0)) continue;
      along_trace += a / both;
      time_trace += t / both;
    }
  }
  const auto axes = static_cast<double>(axes_);
  return {axes * along_trace, axes * time_trace};
}

/// How smooth each time is to be, over all of them: by what its differences are expected to be,
/// in the mean of the times around it. An animal rests and moves.
Eigen::VectorXd FilmPrior::around(const Eigen::VectorXd& squares, Eigen::Index count) const {
  Eigen::VectorXd at = Eigen::VectorXd::Ones(squares.size());
  if (count < 1) return at;
  const double mean = squares.head(count).mean();
  const auto reaches = static_cast<Eigen::Index>(around_time / interval_);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index from = std::max<Eigen::Index>(0, k - reaches);
    const Eigen::Index to = std::min(count - 1, k + reaches);
    const double here = squares.segment(from, to - from + 1).mean();
    at[k] = std::clamp(mean / std::max(here, 1e-12), 1 / most_uneven, most_uneven);
  }
  return at;
}

FilmPrior::Traces FilmPrior::traces(const Eigen::MatrixXd& values,
                                    const BlockArrow::Inverse& inverse) const {
  const Eigen::Index times = values.cols();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(times);
  Traces traces{none, none, none, none};
  for (Eigen::Index k = 0; k < times; ++k) {
    traces.along[k] = inverse.own[k].cwiseProduct(along_form_).sum();
    traces.along_squares[k] = values.col(k).dot(along_form_ * values.col(k));
    if (k + 2 >= times) continue;
    traces.time[k] = inverse.own[k].trace() + 4 * inverse.own[k + 1].trace() +
                     inverse.own[k + 2].trace() - 4 * inverse.one_below[k].trace() -
                     4 * inverse.one_below[k + 1].trace() + 2 * inverse.two_below[k].trace();
    traces.time_squares[k] =
        (values.col(k) - 2 * values.col(k + 1) + values.col(k + 2)).squaredNorm();
  }
  return traces;
}

double FilmPrior::told(const Traces& traces) const {
  return along_ * traces.along.dot(along_at_) + in_time_ * traces.time.dot(time_at_);
}

void FilmPrior::update(const Traces& traces, double noise) {
  const Eigen::Index times = along_at_.size();
  const double along_sum = traces.along.dot(along_at_), time_sum = traces.time.dot(time_at_);
  const auto [along_prior, time_prior] = own_traces();
  // Fellner and Schall's factor, no more than `largest_change` at once. Where the points tell
  // next to nothing of a difference, the two traces differ by rounding alone.
  const auto factor = [&](double now, double prior, double trace, double differences) {
    const double known = std::max(prior - trace, trace_rounding * prior);
    const double wanted = noise * noise * known / std::max(differences, 1e-12);
    return std::clamp(wanted, 1 / largest_change, largest_change) * now;
  };
  along_ = factor(along_, along_prior, along_sum, traces.along_squares.dot(along_at_));
  in_time_ = factor(in_time_, time_prior, time_sum, traces.time_squares.dot(time_at_));
  along_at_ = around(traces.along_squares + noise * noise * traces.along, times);
  time_at_ = around(traces.time_squares + noise * noise * traces.time, times - 2);
  bound(size_);
}

}  // namespace hagfish
