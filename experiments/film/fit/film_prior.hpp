// What a film's program is taken to be where its points do not tell: smooth in time and along the
// body, and bent no more than joints can be.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "experiments/film/fit/block_arrow.hpp"
#include "experiments/film/fit/film_shape.hpp"

namespace hagfish {

class FilmPrior {
 public:
  /// `shape` of the program, its count of times and how far these are apart, s.
  FilmPrior(const ProgramShape& shape, Eigen::Index times, double interval, bool still);

  /// Cost of `values`, ProgramShape's x times, cm^2.
  double cost(const Eigen::MatrixXd& values) const;
  /// Adds to half of the matrix and of the gradient: `share` of what smooths, and the wall.
  void add(const Eigen::MatrixXd& values, double share, BlockArrow& matrix,
           Eigen::VectorXd& gradient) const;
  /// Keeps what smooths and the wall at the limits in proportion to the matrix's diagonal.
  void bound(double size);

  /// Sums by time: traces of the matrix's inverse times what smooths, and squares of differences.
  struct Traces {
    Eigen::VectorXd along, along_squares, time, time_squares;
  };
  Traces traces(const Eigen::MatrixXd& values, const BlockArrow::Inverse& inverse) const;
  /// How many values are told by what smooths.
  double told(const Traces& traces) const;
  /// What smooths, by this noise, cm, and the differences (Fellner and Schall's update).
  void update(const Traces& traces, double noise);

  /// Bend of both axes together, rad per length; and over the most that a joint can have.
  double bend(const Eigen::MatrixXd& values, Eigen::Index time, Eigen::Index station) const;
  double of_limit(const Eigen::MatrixXd& values, Eigen::Index time, Eigen::Index station) const {
    return bend(values, time, station) / limit_[station];
  }
  double in_time() const { return in_time_; }  ///< cm^2 for 1 (rad per length)^2
  double along() const { return along_; }

 private:
  std::pair<double, double> own_traces() const;
  Eigen::VectorXd around(const Eigen::VectorXd& squares, Eigen::Index count) const;

  Eigen::Index stations_, axes_;
  double interval_;
  bool still_;
  Eigen::MatrixXd along_form_;
  Eigen::VectorXd limit_;               // limit by station
  Eigen::VectorXd along_at_, time_at_;  // weights by time, over along_ and in_time_
  double in_time_, along_, size_ = 1, wall_ = 0;
};

}  // namespace hagfish
