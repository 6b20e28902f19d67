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

/// EXPECTs `line`, "KEY = VALUE" of `table` (of the scene itself where that is empty), to be
/// refused by file, line, key and value, and `why`.
inline void expect_refused(const std::string& table, const std::string& line,
                           const std::string& why) {
  const std::string heading = table.empty() ? "" : "[" + table + "]\n";
  EXPECT_EQ(scene_complaint(heading + line + "\n"),
            (table.empty() ? "s.toml:1: " : "s.toml:2: " + table + ".") + line + ": " + why);
}

/// EXPECTs the option "--set KEY=VALUE" to be refused for `why`, after `more` in the scene.
inline void expect_set_refused(const std::string& set, const std::string& why,
                               const std::string& more = "") {
  EXPECT_EQ(scene_complaint(more, {set}), "s.toml: --set " + set + ": " + why);
}

}  // namespace hagfish
