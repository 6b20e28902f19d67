// Texts that would take the TOML parser's stack or its time are refused before it sees them.
#include "core/input/toml/toml_document.hpp"

#include <gtest/gtest.h>

#include "core/input/files/scene_reader.hpp"
#include "tests/support/errors.hpp"

namespace hagfish::toml_bounds_test {

std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

std::string refusal(const std::string& text) {
  return error_of([&] { check_toml_bounds(text, "a.toml"); });
}

constexpr const char* deep = "a.toml:2: not a scene: brackets deeper than 32";
constexpr const char* many = "a.toml:2: not a scene: a key of more than 32 parts";

TEST(TomlBounds, BracketsAndBracesAreCountedTogether) {
  EXPECT_EQ(refusal("\na = " + times(32, "[") + times(32, "]")), "no error");
  EXPECT_EQ(refusal("\na = " + times(33, "[")), deep);
  EXPECT_EQ(refusal("\na = " + times(17, "[{a=")), deep);
  EXPECT_EQ(refusal("\n" + times(33, "[")), deep);
  EXPECT_EQ(refusal("]]]]\na = " + times(33, "[")), deep) << "closed before they open";
}

TEST(TomlBounds, PartsOfAKeyAreCounted) {
  EXPECT_EQ(refusal("\n" + times(31, "a.") + "a = 1"), "no error");
  EXPECT_EQ(refusal("\n" + times(32, "a.") + "a = 1"), many);
  EXPECT_EQ(refusal("\n[" + times(32, "\"a b\" . ") + "a]"), many);
  EXPECT_EQ(refusal("\na = [" + times(100, "1.5, ") + "]"), "no error") << "numbers have dots too";
}

TEST(TomlBounds, StringsAndCommentsCountForNothing) {
  const std::string open = times(100, "["), dots = times(100, ".");
  for (const std::string& quiet :
       {"a = \"" + open + "\\\"" + open + dots + "\"", "a = '" + open + dots + "\\'",
        "# " + open + dots, "a = \"\"\"" + open + "\n\"\"" + open + "\\\"\"\"" + open + "\"\"\"",
        "a = '''" + open + "\n''" + open + dots + "'''", "a = \"\"\"" + open + "\"\"\"\"\""}) {
    EXPECT_EQ(refusal("\n" + quiet), "no error") << quiet;
    EXPECT_EQ(refusal(quiet + "\nb = 1\n"), "no error") << quiet;
  }
  EXPECT_EQ(refusal("\na = [\"\"\"x\"\"\"\"\", " + open), deep) << "after quotes that close late";
  EXPECT_EQ(refusal("a = \"never closed\n" + open), deep) << "a string of one line ends with it";
  EXPECT_EQ(refusal("# comment\n" + open), deep);
}

TEST(TomlBounds, HoldForScenesAndOverrides) {
  for (const int depth : {5000, 20000}) {
    EXPECT_EQ(error_of([&] { read_scene_text("a = " + times(depth, "["), "a.toml"); }),
              "a.toml:1: not a scene: brackets deeper than 32");
  }
  EXPECT_EQ(error_of([&] { read_scene_text(times(100000, "a.") + "a = 1", "a.toml"); }),
            "a.toml:1: not a scene: a key of more than 32 parts");
  const std::string set = error_of(
      [&] { read_scene_text("base = \"table1\"", "a.toml", {times(100000, "a.") + "a=1"}); });
  EXPECT_TRUE(set.ends_with("...: has more than 32 parts")) << set;
}

}  // namespace hagfish::toml_bounds_test
