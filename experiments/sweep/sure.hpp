// How sure a scene's figures are: the scene as it is, and with one thing changed at a time.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/input/scene_text.hpp"
#include "experiments/sweep/grid.hpp"

namespace hagfish {

/// A scene with settings that one cause changes, as --set has them.
struct SureCase {
  std::string cause;  ///< "as it is" of the first case
  std::vector<std::pair<std::string, std::string>> set;
};

/// The scene as it is first; then other bodies and steps, other starts, and animals whose girth,
/// limits and stiffness are others within what is known of them.
std::vector<SureCase> sure_cases(const ResolvedScene& scene);

/// One axis: a cell a case. `set` are settings of every cell.
Grid sure_grid(const std::string& scene, const std::vector<std::string>& set,
               const std::vector<SureCase>& cases);

}  // namespace hagfish
