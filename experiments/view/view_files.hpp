// The page, style and scripts of this folder, compiled in; view_files.cmake writes the definition.
#pragma once

#include <string_view>

namespace hagfish {

/// Text of the file `name` of experiments/view/. Throws std::out_of_range where there is none.
std::string_view view_file(std::string_view name);

}  // namespace hagfish
