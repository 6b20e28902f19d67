#include "experiments/film/film_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// Distance of points from the program's shapes, rms, of the body's length: twice the noise of
/// points clicked by hand, and a body's thickness.
constexpr double doubtful_rms = 0.012, failed_rms = 0.03;
/// Of the points that the film should have, used.
constexpr double doubtful_share = 0.8, failed_share = 0.5;
/// A midline is far off at so many times the middle one's distance, and so much of the body.
constexpr double far_times = 4, far_share = 0.01;
/// Bends over the largest that a joint can have: the wall gives by this much.
constexpr double past_limit = 1.02;
/// Of an animal's length, what its points may make of it: tips that nobody digitised.
constexpr double same_length = 0.1;
/// A clamped head's tip moves by no more, of the body, in nine tenths of the film.
constexpr double still_share = 0.03, most_of_film = 0.9;

/// How far the first point is from where it usually is, the film's unit, in nine tenths of the
/// film.
double first_moves(const Film& film, double first_place) {
  std::vector<Eigen::Vector3d> points;
  for (const FilmFrame& frame : film.frames) {
    if (frame.place.front() == first_place) points.emplace_back(frame.point.col(0));
  }
  Eigen::Vector3d usual;
  for (Eigen::Index d = 0; d < 3; ++d) {
    std::vector<double> values;
    for (const Eigen::Vector3d& point : points) values.push_back(point[d]);
    usual[d] = quantile_of(values, 0.5);
  }
  std::vector<double> off;
  for (const Eigen::Vector3d& point : points) off.push_back((point - usual).norm());
  return quantile_of(off, most_of_film);
}

}  // namespace

const char* verdict_name(FilmVerdict verdict) {
  return verdict == FilmVerdict::fitted     ? "fitted"
         : verdict == FilmVerdict::doubtful ? "doubtful"
                                            : "failed";
}

double animal_length(const Film& film, const FilmReading& reading) {
  if (film.unit != "cm") return 0;
  return film.length_known || reading.length == 0 ? film.length : reading.length;
}

FilmJudgement judge(const Model& model, const Film& film, const FilmReading& reading,
                    const FilmRemarks& remarks, const FilmFit& fit, FilmHead head) {
  FilmJudgement out;
  const auto say = [&out](FilmVerdict at_least, const std::string& why) {
    out.verdict = std::max(out.verdict, at_least);
    out.why.push_back(why);
  };
  // What most often makes a film that does not fit.
  const auto doubt_order = [&] {
    if (out.why.empty()) {
      say(FilmVerdict::doubtful,
          "first, the order of the points: from head to tail, not from tail to head, and with p2 "
          "after p1, where the alphabet has p10");
    }
  };
  const double length = model.length();
  std::vector<double> sorted = fit.rms_at;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  const double far = std::max(far_times * *middle, far_share * length);
  std::vector<double> off, left_out;
  double used = 0;
  for (std::size_t f = 0; f < fit.rms_at.size(); ++f) {
    const auto here = std::ranges::count(fit.used[f], true);
    used += static_cast<double>(here);
    if (2 * here < static_cast<std::ptrdiff_t>(fit.used[f].size())) {
      left_out.push_back(film.frames[f].time);
    } else if (fit.rms_at[f] > far) {
      off.push_back(film.frames[f].time);
    }
  }
  const auto worst = std::ranges::max_element(fit.rms_at) - fit.rms_at.begin();
  out.worst = fit.rms_at[worst];
  out.worst_time = film.frames[worst].time;
  out.share_used = used / static_cast<double>(std::max<std::size_t>(film.expected, 1));

  if (head == FilmHead::still) {
    double place = 1;
    for (const FilmFrame& frame : film.frames) place = std::min(place, frame.place.front());
    const double moves = first_moves(film, place);
    if (moves > (still_share + 2 * place) * film.length) {
      doubt_order();
      say(FilmVerdict::doubtful,
          fmt::format("the first point moves by {:.2g} {}, though the head is taken as clamped: is "
                      "it a head that the film never shows (--first-point), or one that is free "
                      "(--free-head)?",
                      moves, film.unit));
    }
  }
  const double made = length / fit.scale, told = reading.length > 0 ? reading.length : length;
  if (film.unit == "cm" && !film.length_known && std::abs(made / told - 1) > same_length) {
    doubt_order();
    say(FilmVerdict::doubtful,
        fmt::format("the fit makes an animal of {:.3g} cm, and {} {:.3g} cm: check --scale, --unit "
                    "and whether the film shows both ends (--animal-length, --first-point)",
                    made, reading.length > 0 ? "--animal-length is" : "the scene's has", told));
  }
  if (fit.rms > doubtful_rms * length) {
    doubt_order();
    say(fit.rms > failed_rms * length ? FilmVerdict::failed : FilmVerdict::doubtful,
        fmt::format("points lie {:.2g} cm from the shapes, {:.2g} % of the body", fit.rms,
                    100 * fit.rms / length));
  }
  if (out.share_used < doubtful_share) {
    say(out.share_used < failed_share ? FilmVerdict::failed : FilmVerdict::doubtful,
        fmt::format("{:.0f} % of the points are missing or too far off",
                    100 * (1 - out.share_used)));
  }
  if (!left_out.empty()) {
    say(FilmVerdict::doubtful, fmt::format("{} midlines are far from where the others are ({} s)",
                                           left_out.size(), times_text(left_out)));
  }
  if (!off.empty()) {
    say(FilmVerdict::doubtful, fmt::format("{} midlines lie over {:.2g} cm from the shapes ({} s)",
                                           off.size(), far, times_text(off)));
  }
  if (fit.of_limit > past_limit) {
    say(FilmVerdict::doubtful,
        fmt::format("it bends up to {:.2g} times as much as the animal's joints can, at {:.3g} s, "
                    "{:.2g} of the body from the head",
                    fit.of_limit, fit.of_limit_time, fit.of_limit_station));
  }
  if (!fit.settled) say(FilmVerdict::doubtful, "the fit did not converge");
  for (const std::string& doubt : remarks.doubts) say(FilmVerdict::doubtful, doubt);
  return out;
}

}  // namespace hagfish
