#include "core/scene/specimen.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace hagfish {

double profile(const std::vector<double>& station, const std::vector<double>& value,
               double fraction) {
  if (fraction <= station.front()) return value.front();
  if (fraction >= station.back()) return value.back();
  const auto above = std::upper_bound(station.begin(), station.end(), fraction);
  const auto i = static_cast<std::size_t>(above - station.begin());
  const double share = (fraction - station[i - 1]) / (station[i] - station[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

double mean_diameter(const Specimen& specimen) {
  const std::vector<double>& station = specimen.station;
  const std::vector<double>& around = specimen.circumference;
  double mean = station.front() * around.front() + (1 - station.back()) * around.back();
  for (std::size_t i = 1; i < station.size(); ++i) {
    mean += (station[i] - station[i - 1]) * (around[i] + around[i - 1]) / 2;
  }
  return mean / std::numbers::pi;
}

}  // namespace hagfish
