#include "experiments/audit/rebuilt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hagfish {

double Rebuilt::Deviation::share() const {
  return off == 0 ? 0 : off / std::max(rebuilt_tolerance * scale, allowed);
}

void Rebuilt::compare(const std::string& path, double logged, double wanted, double allowed) {
  Deviation& d = datasets_[path];
  d.allowed = std::max(d.allowed, allowed);
  if (std::isnan(logged) && std::isnan(wanted)) {
    return;
  }
  const double off = std::abs(logged - wanted);
  d.off = std::isnan(off) ? INFINITY : std::max(d.off, off);
  if (std::isfinite(wanted)) {
    d.scale = std::max(d.scale, std::abs(wanted));
  }
}

void Rebuilt::compare(const std::string& path, const Eigen::Ref<const Eigen::VectorXd>& logged,
                      const Eigen::Ref<const Eigen::VectorXd>& wanted, double allowed) {
  for (Eigen::Index i = 0; i < wanted.size(); ++i) {
    compare(path, logged[i], wanted[i], allowed);
  }
}

Finding Rebuilt::finding(const std::string& name, const std::string& from) const {
  double worst = 0;
  std::string worst_path;
  std::string failed;
  for (const auto& [path, deviation] : datasets_) {
    const double share = deviation.share();
    if (share > worst) {
      worst = share;
      worst_path = " in " + path;
    }
    if (!(share <= 1)) {
      failed +=
          fmt::format("{}{} is {}", failed.empty() ? "" : ", ", path,
                      std::isfinite(share) ? fmt::format("off by {:.2g} times its tolerance", share)
                                           : "another number, or none");
    }
  }
  const Criterion criterion{name, worst, 1, "of the tolerance"};
  if (!failed.empty()) {
    return judged(criterion, failed + ", rebuilt from " + from);
  }
  return judged(criterion,
                fmt::format("{} datasets rebuilt from {}: off by {:.2g} of the tolerance "
                            "at most{}",
                            datasets_.size(), from, worst, worst_path));
}

}  // namespace hagfish
