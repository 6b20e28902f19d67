// What the viewer's page needs of a log, as JSON: names, and arrays as base64.
#pragma once

#include <nlohmann/json.hpp>

#include "core/log/reading/log_contents.hpp"

namespace hagfish {

/// An array is {"f4": base64} of 32-bit floats (6e-8 of each value: 4e-6 cm of a place), {"i2":
/// base64, "scale": s} of 16-bit integers times s, where s is the largest magnitude over 32767 and
/// -32768 stands for nan, {"u1": ...} or {"u4": ...}; little-endian, row by row. Forces are means
/// since the frame before, but for those of contacts and the tip, which are of the step at the
/// frame. Throws FileError where a dataset is missing.
nlohmann::ordered_json view_data(const LogContents& log, const std::string& name);

}  // namespace hagfish
