#include "experiments/film/film_distance.hpp"

#include <algorithm>
#include <cmath>

#include "core/input/input_error.hpp"
#include "experiments/film/fit/film_curve.hpp"
#include "experiments/film/fit/film_shape.hpp"

namespace hagfish {
namespace {

/// Of times, in frames of the log: a film made from a log has its times rounded.
constexpr double rounding = 1e-6;

/// The log's points at the places of a film's frame, times `share`.
Eigen::Matrix3Xd points_at(const LogContents& log, std::size_t frame, const FilmFrame& film,
                           double share) {
  Kinematics kin;
  update_positions(log.model, log.q.row(static_cast<Eigen::Index>(frame)).transpose(), kin);
  Eigen::Matrix3Xd points(3, film.point.cols());
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    points.col(k) = point_on(log.model, kin, std::min(share * film.place[k], 1.0));
  }
  return points;
}

}  // namespace

double FilmDistance::rms() const {
  double sum = 0, count = 0;
  for (const std::vector<double>& frame : off) {
    for (const double x : frame) sum += x * x;
    count += static_cast<double>(frame.size());
  }
  return std::sqrt(sum / count);
}

std::vector<double> FilmDistance::rms_by_time() const {
  std::vector<double> rms;
  for (const std::vector<double>& frame : off) {
    double sum = 0;
    for (const double x : frame) sum += x * x;
    rms.push_back(std::sqrt(sum / static_cast<double>(frame.size())));
  }
  return rms;
}

FilmDistance film_distance(const LogContents& log, const Film& film, const FilmPlacing& placing) {
  std::vector<const FilmFrame*> common;
  std::vector<Eigen::Matrix3Xd> own;
  Eigen::Index count = 0;
  if (!placing.aligned && !film.length_known) {
    throw InputError("--as-is needs a column s_cm, the place of each point along the body");
  }
  const double length = log.model.length();
  const double along = placing.aligned ? 1 : film.length / length;
  const double begin = log.time.front(), end = log.time.back();
  const double little = rounding * log.resolved.scene.time.frame_interval;
  for (const FilmFrame& frame : film.frames) {
    const double time = frame.time + placing.later;
    if (time < begin - little || time > end + little) continue;
    const auto after = static_cast<std::size_t>(std::ranges::lower_bound(log.time, time - little) -
                                                log.time.begin());
    const std::size_t b = std::min(after, log.time.size() - 1);
    Eigen::Matrix3Xd points = points_at(log, b, frame, along);
    if (b > 0 && log.time[b] > time + little) {
      const double share = (log.time[b] - time) / (log.time[b] - log.time[b - 1]);
      points = ((1 - share) * points + share * points_at(log, b - 1, frame, along)).eval();
    }
    common.push_back(&frame);
    own.push_back(points);
    count += points.cols();
  }
  if (common.empty()) {
    throw InputError(log.h5.file() + ": has no time in common with the film");
  }
  FilmDistance distance;
  distance.scale = placing.aligned ? length / film.length : 1;
  Eigen::Matrix3Xd from(3, count), to(3, count);
  Eigen::Index at = 0;
  for (std::size_t f = 0; f < common.size(); ++f) {
    from.middleCols(at, own[f].cols()) = distance.scale * common[f]->point;
    to.middleCols(at, own[f].cols()) = own[f];
    at += own[f].cols();
  }
  RigidMotion motion = placing.aligned ? nearest_motion(from, to) : RigidMotion{};
  if (placing.aligned && !film.length_known) {
    const Eigen::Matrix3Xd a =
        (motion.rotation * from).colwise() - (motion.rotation * from).rowwise().mean();
    const Eigen::Matrix3Xd b = to.colwise() - to.rowwise().mean();
    const double more = a.cwiseProduct(b).sum() / a.squaredNorm();
    if (std::isfinite(more) && more > 0) {
      distance.scale *= more;
      motion = nearest_motion(more * from, to);
    }
  }
  for (std::size_t f = 0; f < common.size(); ++f) {
    distance.time.push_back(common[f]->time + placing.later);
    const Eigen::RowVectorXd off =
        (own[f] - motion.of(distance.scale * common[f]->point)).colwise().norm();
    distance.off.emplace_back(off.begin(), off.end());
    std::vector<double>& arc = distance.arc.emplace_back();
    for (const double place : common[f]->place) arc.push_back(place * along * length);
  }
  return distance;
}

}  // namespace hagfish
