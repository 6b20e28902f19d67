#include "experiments/film/fit/film_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/design/program_fit.hpp"
#include "experiments/film/fit/block_arrow.hpp"
#include "experiments/film/fit/film_begin.hpp"
#include "experiments/film/fit/film_prior.hpp"

namespace hagfish {
namespace {

/// Distances up to this many standard deviations of a coordinate count by their square: one of 150
/// points of normal noise in three dimensions is further.
constexpr double reach = 3.5;
/// Least noise, of the body's length: points of a smooth curve of 12 rad are that far off stretches
/// of two straight bodies of a hundred. Less, and bends follow the corners.
constexpr double least_noise = 6e-4;
constexpr int rounds = 20;  // of noise and smoothness, and of the steps at them:
constexpr int steps = 40;
/// The gradient has vanished where the step that it asks for is this much of the standard errors.
constexpr double settled_decrement = 0.01;
/// Noise and smoothness are known once they change by less than this, of themselves.
constexpr double settled_noise = 0.02;
/// Points tell a value where noise is at least this share of the variance that the matrix gives it.
constexpr double told_by_points = 0.2;
/// Of the largest number on the matrix's diagonal: what holds poses that no point tells.
constexpr double pose_ridge = 1e-9;
/// Of the same: added to the diagonal, so that steps of what nothing tells are none.
constexpr double untold = 1e-13;

class Fit {
 public:
  Fit(const Model& model, const Film& film, FilmHead head, int times, int stations,
      const std::function<void(int)>& watch)
      : watch_(watch),
        model_(model),
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
        now_(begin_fit(shape_, film, knots_, still_, model.length() / film.length)),
        prior_(shape_, times, knots_[1] - knots_[0], still_) {}

  FilmFit run() {
    measure_noise();
    bool settled = false;
    for (int round = 0; round < rounds; ++round) {
      settled = descend();
      const double noise = noise_, in_time = prior_.in_time(), along = prior_.along();
      if (!estimate()) break;
      const auto same = [](double a, double b) {
        return std::abs(a - b) <= settled_noise * std::max(a, b);
      };
      if (same(noise, noise_) && same(std::sqrt(in_time), std::sqrt(prior_.in_time())) &&
          same(std::sqrt(along), std::sqrt(prior_.along()))) {
        break;
      }
    }
    settled = descend() || settled;
    return result(settled);
  }

 private:
  const FilmPose& pose_of(const FilmUnknowns& x, std::size_t frame) const {
    return x.pose[still_ ? 0 : frame];
  }
  TablePlace when(std::size_t frame) const { return film_place(film_, frame, knots_); }
  Eigen::VectorXd values_at(const FilmUnknowns& x, std::size_t frame) const {
    const TablePlace at = when(frame);
    const auto k = static_cast<Eigen::Index>(at.index);
    return (1 - at.share) * x.values.col(k) + at.share * x.values.col(k + 1);
  }

  /// Distances of a frame's points, dimensions x points.
  Eigen::MatrixXd off_points(const FilmUnknowns& x, std::size_t frame) const {
    return distances(shape_, film_.frames[frame], values_at(x, frame), pose_of(x, frame), x.scale);
  }

  void measure_noise() {
    std::vector<double> squares;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off = off_points(now_, f);
      for (Eigen::Index k = 0; k < off.cols(); ++k) squares.push_back(off.col(k).squaredNorm());
    }
    // What nine tenths are within, so that none but outliers are far to begin with.
    const auto most = squares.begin() + static_cast<std::ptrdiff_t>(9 * squares.size() / 10);
    std::ranges::nth_element(squares, most);
    const double of_normal = dims_ == 3 ? 6.25 : 4.61;  // the same of chi squared
    noise_ = std::max(std::sqrt(*most / of_normal), least_noise * model_.length());
  }

  double far() const { return reach * noise_; }

  double cost(const FilmUnknowns& x) const {
    double sum = prior_.cost(x.values);
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off = off_points(x, f);
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

  /// The matrix and the gradient of the cost at now_ (Gauss and Newton), half of each, with what
  /// smooths times `smoothing`. Returns the cost.
  double assemble(double smoothing = 1) {
    const Eigen::Index m = shape_.values();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    matrix_.clear();
    gradient_ = Eigen::VectorXd::Zero(times * m + border_);
    frame_pose_.resize(still_ ? 0 : film_.frames.size());
    double sum = 0;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const TablePlace at = when(f);
      const auto k = static_cast<Eigen::Index>(at.index);
      Misfit misfit = hagfish::misfit(shape_, film_.frames[f], values_at(now_, f), pose_of(now_, f),
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
      // A free head's pose belongs to its frame alone. So it is eliminated at once (Schur
      // complement), and the matrix has blocks of times and a border only. stepped() finds it.
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
      // The frame's values lie between those of two times, so each time gets its share.
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
    prior_.bound(size_);
    prior_.add(now_.values, smoothing, matrix_, gradient_);
    // What nothing tells, such as the roll of a free head, stays where it is.
    for (Eigen::Index k = 0; k < times; ++k) {
      for (Eigen::Index j = 0; j < m; ++j) matrix_.add_diagonal(k, j, j, untold * size_);
    }
    return sum + prior_.cost(now_.values);
  }

  FilmUnknowns stepped(const Eigen::VectorXd& step) const {
    const Eigen::Index m = shape_.values();
    const auto times = static_cast<Eigen::Index>(knots_.size());
    FilmUnknowns next = now_;
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
      if (watch_) watch_(++taken_);
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
          const FilmUnknowns next = stepped(by);
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

  /// Noise and smoothness from what is left (Fellner and Schall's update). False where the matrix
  /// says too little.
  bool estimate() {
    assemble();
    if (!matrix_.factor(0)) return false;
    const BlockArrow::Inverse inverse = matrix_.inverse();
    const FilmPrior::Traces traces = prior_.traces(now_.values, inverse);
    // What is far counts as just as far as squares reach, so that noise does not shrink to that of
    // the points which happen to be nearest.
    double squares = 0;
    for (std::size_t f = 0; f < film_.frames.size(); ++f) {
      const Eigen::MatrixXd off = off_points(now_, f);
      squares += off.colwise().squaredNorm().cwiseMin(far() * far()).sum();
    }
    const auto count = static_cast<double>(dims_ * points());
    const double told = static_cast<double>(now_.values.size()) - prior_.told(traces) +
                        static_cast<double>(still_ ? border_ : pose_size_ * now_.pose.size());
    const double free = std::max(count - std::max(told, 0.0), 0.05 * count);
    noise_ = std::max(std::sqrt(squares / std::max(free, 1.0)), least_noise * model_.length());
    prior_.update(traces, noise_);
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
      const Eigen::MatrixXd off = off_points(now_, f);
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
        const double share = prior_.of_limit(now_.values, k, j);
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

  /// The matrix and its gradient with what smooths times `smoothing`, factored. False where it says
  /// too little.
  bool factor_for_errors(double smoothing) {
    assemble(smoothing);
    const Eigen::Index n = shape_.stations();
    if (!still_ && shape_.axes() == 2) {
      // Bends of a free head are told but for a roll of all of them at a time.
      for (Eigen::Index k = 0; k < now_.values.cols(); ++k) {
        Eigen::VectorXd roll(2 * n);
        roll << -now_.values.col(k).tail(n), now_.values.col(k).head(n);
        if (roll.norm() > 0)
          matrix_.add(k, k, size_ * roll * roll.transpose() / roll.squaredNorm());
      }
    }
    return matrix_.factor(0);
  }

  /// Standard errors: of the noise that values take from the points, and of how far what smooths
  /// moves them, by the fit's own differences. The inverse of the matrix takes these differences
  /// as alike everywhere, which they are not: it holds where points do not tell. Neighbouring
  /// points whose distances are alike tell less than they would by themselves: `alike` is their
  /// correlation.
  void errors(double alike, FilmFit& fit) {
    const Eigen::Index n = shape_.stations(), m = shape_.values();
    constexpr double more = 1e-3;  // of what smooths: a derivative
    BlockArrow::Inverse smoother, inverse;
    Eigen::VectorXd moved;
    bool told = factor_for_errors(1 + more);
    if (told) {
      smoother = matrix_.inverse();
      moved = gradient_;
      told = factor_for_errors(1);
    }
    if (told) {
      inverse = matrix_.inverse();
      moved = matrix_.solve((moved - gradient_) / more);
    }
    const double variance = noise_ * noise_ * (1 + alike) / (1 - alike);
    for (Eigen::Index k = 0; k < now_.values.cols(); ++k) {
      Eigen::Matrix3Xd& error = fit.error.emplace_back(Eigen::Matrix3Xd::Zero(3, n));
      for (Eigen::Index j = 0; j < m; ++j) {
        const Eigen::Index row = dims_ == 2 ? 1 : j / n;
        if (!told) {
          error(row, j % n) = INFINITY;
          continue;
        }
        const double all = inverse.own[k](j, j);
        const double by_noise = all - (all - smoother.own[k](j, j)) / more;
        error(row, j % n) = by_noise < told_by_points * all
                                ? std::sqrt(variance * all)
                                : std::hypot(std::sqrt(variance * by_noise), moved[k * m + j]);
      }
    }
  }

  const std::function<void(int)>& watch_;
  int taken_ = 0;  // steps
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
  FilmUnknowns now_;
  FilmPrior prior_;
  double noise_ = 0;  // cm
  double size_ = 1;   // of the matrix
};

}  // namespace

FilmFit fit_film(const Model& model, const Film& film, FilmHead head, int times, int stations,
                 const std::function<void(int)>& watch) {
  if (times < 2 || stations < 2 || stations > model.body_count() / 4) {
    throw std::invalid_argument("2 times, 2 stations to a quarter of the bodies");
  }
  return Fit(model, film, head, times, stations, watch).run();
}

}  // namespace hagfish
