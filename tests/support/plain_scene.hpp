// The shortest scene, for tests of what is added to it.
#pragma once

#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "tests/support/errors.hpp"

namespace hagfish {

/// A specimen without data files: the text of a specimen file.
inline const std::string plain_specimen =
    "name = 'test'\nlength = 40\nmass = 80\nstation = [0.2, 0.8]\ncircumference = [5, 4]\n"
    "bending_limit_deg = [20, 30]\nbending_span = 0.8\ntwist_limit_deg = 48\n";
/// A scene with nothing else.
inline const std::string plain_scene = "[specimen]\n" + plain_specimen;

/// What reading the plain scene with `more` in front of it complains of.
inline std::string scene_complaint(const std::string& more,
                                   const std::vector<std::string>& overrides = {}) {
  return error_of([&] { read_scene_text(more + plain_scene, "s.toml", overrides); });
}

}  // namespace hagfish
