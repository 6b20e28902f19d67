#include "core/scene/specimen.hpp"

#include <algorithm>
#include <cstddef>

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

}  // namespace hagfish
