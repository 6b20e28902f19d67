// The viewer: one HTML page that holds its scripts, its libraries and the data of one or two logs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/log/reading/log_contents.hpp"

namespace hagfish {

/// What the page needs of a log, as JSON: names, and arrays as base64. An array is {"f4": base64}
/// of 32-bit floats (6e-8 of each value: 4e-6 cm of a place), {"i2": base64, "scale": s} of 16-bit
/// integers times s, where s is the largest magnitude over 32767 and -32768 stands for nan, {"u1":
/// ...} or {"u4": ...}; little-endian, row by row. Forces are means since the frame before, but for
/// those of contacts and the tip, which are of the step at the frame. Throws FileError where a
/// dataset is missing.
nlohmann::ordered_json view_data(const LogContents& log, const std::string& name);

/// The page over `logs`, of view_data(). Reads three.js and d3 from where Debian's libjs-three and
/// node-d3 put them; throws FileError where they are not there, naming the package.
std::string view_page(const std::vector<nlohmann::ordered_json>& logs);

/// Text of the file `name` of experiments/view/, which is compiled in (view_files.cmake). Throws
/// std::out_of_range where there is none.
std::string_view view_file(std::string_view name);

}  // namespace hagfish
