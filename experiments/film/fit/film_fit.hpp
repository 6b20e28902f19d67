// A curvature program whose shapes are those of a film: how an animal that was filmed ties its
// knot.
#pragma once

#include <functional>
#include <vector>

#include "core/chain/model.hpp"
#include "experiments/film/film.hpp"

namespace hagfish {

/// What the film's axes are: where the head is and how it is turned.
enum class FilmHead {
  still,  ///< fixed all through the film: it is clamped
  free    ///< anything at each time, so that nothing is known of how the animal rolls
};

struct FilmFit {
  CurvatureProgram program;
  /// Standard errors of the program's values, laid out as they are, rad per body length; of bends
  /// alone. Where the film has no points they are those of what bridges the gap.
  std::vector<Eigen::Matrix3Xd> error;
  double rms = 0;    ///< distance of the points used from the program's shapes, cm of the model
  double noise = 0;  ///< standard deviation of each coordinate of a point, cm of the model
  double scale = 1;  ///< cm of the model in one of the film's lengths
  /// Of each frame: rms of the points used, or of all where less than half are, cm of the model;
  /// and which points were used, the others being too far off for the film's noise.
  std::vector<double> rms_at;
  std::vector<std::vector<bool>> used;
  /// The largest bend over the most that a joint can have, and where.
  double of_limit = 0, of_limit_time = 0, of_limit_station = 0;
  bool settled = false;  ///< the gradient vanished
};

/// The program of `times` from 0 to the film's last time and `stations` from 0 to 1, both even,
/// whose shapes lie nearest to the film's points. One least squares over all values, the pose of a
/// still head (or of the head at each frame) and, where the film does not say how long its animal
/// is, its scale:
///   sum of rho(distance) + smoothness in time and along the body + a wall at the joints' limits.
/// rho is a square up to some standard deviations and grows as a logarithm from there. Second
/// differences in time and along the body are taken as normal, with variances that are estimated
/// from the film with that of its noise (Fellner and Schall's update: Wood and Fasiolo, Biometrics
/// 73, 2017), so that they matter only where points do not tell. Twist, of which a midline says
/// nothing, is 0. Levenberg and Marquardt's steps, until the gradient vanishes. Throws
/// std::invalid_argument as fit_program(), and InputError, without the file's name, where no frame
/// has points enough to begin with. Calls `watch`, where there is one, at each step with their
/// number so far.
FilmFit fit_film(const Model& model, const Film& film, FilmHead head, int times, int stations,
                 const std::function<void(int)>& watch = {});

}  // namespace hagfish
