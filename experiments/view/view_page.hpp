// The viewer: one HTML page that holds its scripts, its libraries and the data of one or two logs.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace hagfish {

/// The page over `logs` (view_data.hpp). Reads three.js and d3 from where Debian's libjs-three and
/// node-d3 put them; throws FileError where they are not there, naming the package.
std::string view_page(const std::vector<nlohmann::ordered_json>& logs);

}  // namespace hagfish
