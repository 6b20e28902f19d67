#include "experiments/film/fit/film_rigid.hpp"

#include <Eigen/SVD>

namespace hagfish {

RigidMotion nearest_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Vector3d a = from.rowwise().mean(), b = to.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd((to.colwise() - b) * (from.colwise() - a).transpose(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  RigidMotion motion;
  motion.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  motion.shift = b - motion.rotation * a;
  return motion;
}

}  // namespace hagfish
