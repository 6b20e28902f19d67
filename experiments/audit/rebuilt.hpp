// Logged numbers against what they are rebuilt from: deviations by dataset, one finding of them.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "experiments/audit/audit.hpp"

namespace hagfish {

/// Deviation up to which a logged number counts as the rebuilt one, of the dataset's largest: sums
/// of a hundred bodies round differently on another machine, by 1e-13.
inline constexpr double rebuilt_tolerance = 1e-9;

class Rebuilt {
 public:
  /// Notes a number of dataset `path`. Two nan are the same. A deviation may be rebuilt_tolerance
  /// of the largest |wanted| of the dataset, or `allowed`, in its unit, where that is more.
  void compare(const std::string& path, double logged, double wanted, double allowed = 0);
  void compare(const std::string& path, const Eigen::Ref<const Eigen::VectorXd>& logged,
               const Eigen::Ref<const Eigen::VectorXd>& wanted, double allowed = 0);

  /// Passes where all are met; else names each dataset that is not, with its deviation. `from` says
  /// what all were rebuilt from.
  Finding finding(const std::string& name, const std::string& from) const;

 private:
  struct Deviation {
    double off = 0, scale = 0, allowed = 0;
    double share() const;  ///< share of what is allowed
  };
  std::map<std::string, Deviation> datasets_;
};

}  // namespace hagfish
