#include "experiments/film/film_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace

const char* verdict_name(FilmVerdict verdict) {
  return verdict == FilmVerdict::fitted     ? "fitted"
         : verdict == FilmVerdict::doubtful ? "doubtful"
                                            : "failed";
}

FilmJudgement judge(const Model& model, const Film& film, const FilmRemarks& remarks,
                    const FilmFit& fit) {
  FilmJudgement out;
  const auto say = [&out](FilmVerdict at_least, const std::string& why) {
    out.verdict = std::max(out.verdict, at_least);
    out.why.push_back(why);
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

  if (fit.rms > doubtful_rms * length) {
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
