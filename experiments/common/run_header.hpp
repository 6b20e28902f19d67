// What a log says of how its run came about.
#pragma once

#include <string>

#include "core/input/files/scene_reader.hpp"
#include "core/log/log_header.hpp"

namespace hagfish {

/// Header of a run in `scene` with the QP back end `qp`, by the command line as `typed`.
LogHeader log_header(const ResolvedScene& resolved, const std::string& qp,
                     const std::string& typed);

}  // namespace hagfish
