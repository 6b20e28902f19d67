#include "core/scene/specimen.hpp"

#include <cstddef>
#include <numbers>

#include "core/scene/interpolation.hpp"

namespace hagfish {

double profile(const std::vector<double>& station, const std::vector<double>& value,
               double fraction) {
  return value_at(bracket_of(station, fraction), [&](std::size_t k) { return value[k]; });
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
