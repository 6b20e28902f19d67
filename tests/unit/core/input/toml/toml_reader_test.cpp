#include "core/input/toml/toml_reader.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "core/input/toml/toml_writer.hpp"
#include "tests/support/errors.hpp"

namespace hagfish::toml_reader_test {

/// What reading `text` as "f.toml" with `read` complains of.
std::string complaint(const std::string& text, const std::function<void(TableReader&)>& read) {
  return error_of([&] {
    TableReader table(text, "f.toml");
    read(table);
    table.finish();
  });
}

void read_size(TableReader& table) {
  double size = 0;
  table.number("size", size, positive());
}

TEST(TomlReader, ReadsEveryTypeOfValue) {
  TableReader table(
      "s = 'text'\nb = true\ni = -3\nu = 4294967295\nx = 2\nv = [1, 2.5, -3]\nn = [4]\n"
      "angle_deg = 180\nfine_rad = [0.25]\nr = [[0, 1, 2, 3], [1.5, 4, 5, 6]]\n[t]\nx = 1e-3\n",
      "f.toml");
  std::string s;
  bool b = false;
  int i = 0;
  unsigned u = 0;
  double x = 0, angle = 0, inner = 0;
  Eigen::Vector3d v;
  std::vector<double> n, fine;
  std::vector<Eigen::Vector4d> r;
  table.string("s", s);
  table.boolean("b", b);
  table.integer("i", i, within(-3, 3));
  table.integer("u", u, any_number());
  table.number("x", x, positive());
  table.vector("v", v);
  table.numbers("n", n, positive());
  table.angle("angle", angle, within(0, 180));
  table.angles("fine", fine, inside(0, 90));
  table.rows("r", "knot", "t, x, y, z", r);
  table.table("t", [&](TableReader& t) { t.number("x", inner, positive()); });
  table.finish();
  EXPECT_EQ(s, "text");
  EXPECT_TRUE(b);
  EXPECT_EQ(i, -3);
  EXPECT_EQ(u, 4294967295u);
  EXPECT_EQ(x, 2.0);
  EXPECT_EQ(v, Eigen::Vector3d(1, 2.5, -3));
  EXPECT_EQ(n, std::vector<double>{4});
  EXPECT_DOUBLE_EQ(angle, std::numbers::pi);  // 4 ulp: one multiplication by a rounded factor
  EXPECT_EQ(fine, std::vector<double>{0.25});
  ASSERT_EQ(r.size(), 2u);
  EXPECT_EQ(r[1], Eigen::Vector4d(1.5, 4, 5, 6));
  EXPECT_EQ(inner, 1e-3);
}

TEST(TomlReader, RowsOfTextsThereAndBack) {
  using Rows = std::vector<std::array<std::string, 3>>;
  const Rows rows = {{"a \"b\"", "0.1", "2"}, {"", "x + 3", "1e-09"}};
  TomlWriter writer;
  writer.text_rows("k", "row", "[x, y, z]", rows);
  Rows again = {{"old", "", ""}};
  TableReader table(writer.text(), "f.toml");
  table.text_rows("k", "row", "[x, y, z]", again);
  EXPECT_EQ(again, rows);
  TableReader numbers("k = [['a', 0.1, 2], ['b', -3, 1e-9]]", "f.toml");
  numbers.text_rows("k", "row", "[x, y, z]", again);
  EXPECT_EQ(again, (Rows{{"a", "0.1", "2"}, {"b", "-3", "1e-09"}}));
  const auto read = [](TableReader& t) {
    Rows r;
    t.text_rows("k", "row", "[x, y, z]", r);
  };
  EXPECT_EQ(complaint("k = 1", read), "f.toml:1: k = 1: must be an array of arrays [x, y, z]");
  EXPECT_EQ(complaint("k = [[1, 2, 3]]", read), "f.toml:1: k = [1, 2, 3]: row 1 must be [x, y, z]");
  EXPECT_EQ(complaint("k = [['a', 2, 3], ['b', 2]]", read),
            "f.toml:1: k = ['b', 2]: row 2 must be [x, y, z]");
  EXPECT_EQ(complaint("k = [['a', 2, true]]", read),
            "f.toml:1: k = ['a', 2, true]: row 1 must be a number");
}

TEST(TomlReader, AbsentKeyKeepsTheValue) {
  TableReader table("", "f.toml");
  double x = 7;
  table.number("x", x, positive());
  table.table("t", [&](TableReader& t) { t.number("x", x, positive()); });
  table.finish();
  EXPECT_EQ(x, 7);
}

TEST(TomlReader, UnknownKeySuggestsTheNearest) {
  const auto read = [](TableReader& table) {
    table.table("time", [](TableReader& t) {
      double x = 0;
      t.number("duration", x, positive());
      t.number("step", x, positive());
    });
  };
  EXPECT_EQ(complaint("[time]\n\nstpe = 2\n", read),
            "f.toml:3: time.stpe = 2: unknown key; did you mean time.step?");
  EXPECT_EQ(complaint("tme = 3\n", read), "f.toml:1: tme = 3: unknown key; did you mean time?");
  // Where none is near, and where a table should stand: which there are.
  EXPECT_EQ(complaint("water = 3\n", read), "f.toml:1: water = 3: unknown key; there are time");
  EXPECT_EQ(complaint("[time]\nwater = 3\n", read),
            "f.toml:2: time.water = 3: unknown key; there are duration, step");
  EXPECT_EQ(complaint("time = 2\n", read),
            "f.toml:1: time = 2: must be a table; in it there are duration, step");
}

TEST(TomlReader, UnknownKeyIsToldBeforeAMissingOne) {
  const auto read = [](TableReader& table) {
    table.require_all();
    read_size(table);
  };
  EXPECT_EQ(complaint("sise = 1", read), "f.toml:1: sise = 1: unknown key; did you mean size?");
  EXPECT_EQ(complaint("", read), "f.toml: size: is missing");
}

TEST(TomlReader, RefusesBadValuesWithLineKeyAndReason) {
  const auto read = [](TableReader& table) {
    double size = 0, angle = 0;
    int n = 0, choice = 0;
    unsigned u = 0;
    bool b = false;
    std::string s;
    Eigen::Vector3d v;
    std::vector<double> k;
    std::vector<Eigen::Vector4d> r;
    table.number("size", size, positive());
    table.integer("n", n, within(2, 400));
    table.integer("u", u, any_number());
    table.boolean("b", b);
    table.string("s", s);
    table.choice<int>("c", choice, {{"one", 1}, {"two", 2}});
    table.table("t", [&](TableReader& t) { t.boolean("u", b); });
    table.vector("v", v);
    table.numbers("k", k, positive());
    table.rows("r", "knot", "t, x, y, z", r);
    table.angle("bend", angle, inside(0, 90));
  };
  const std::pair<const char*, const char*> wrong[] = {
      {"size = 'big'", "must be a number"},
      {"size = true", "must be a number"},
      {"size = [1]", "must be a number"},
      {"size = nan", "must be finite"},
      {"size = -inf", "must be finite"},
      {"size = 1e400", "must be finite"},
      {"size = 99999999999999999999", "does not fit 64 bits"},
      {"size = 0", "must be positive"},
      {"size = -1.5", "must be positive"},
      {"n = 1", "must be from 2 to 400"},
      {"n = 401", "must be from 2 to 400"},
      {"n = 100.0", "must be a whole number"},
      {"n = 4294967300", "is out of range"},
      {"u = -1", "is out of range"},
      {"b = 1", "must be true or false"},
      {"s = 1", "must be a string in quotes"},
      {"c = 'ten'", "must be one of \"one\", \"two\""},
      {"t = 3", "must be a table; in it there are u"},
      {"v = [1, 2]", "must be three numbers [x, y, z]"},
      {"k = []", "must be an array of numbers"},
      {"k = 1", "must be an array of numbers"},
      {"k = [1, 'x']", "number 2 must be a number"},
      {"k = [1, 0]", "number 2 must be positive"},
      {"bend_deg = 90", "must be above 0 and below 90 degrees"},
      {"bend_rad = 1.6", "must be above 0 and below 90 degrees"}};
  for (const auto& [line, why] : wrong) {
    EXPECT_EQ(complaint(line, read), std::string("f.toml:1: ") + line + ": " + why);
  }
  EXPECT_EQ(complaint("r = [\n [0, 1, 2, 3],\n [1, 2, 3]]", read),
            "f.toml:3: r = [1, 2, 3]: knot 2 must be four numbers [t, x, y, z]");
  EXPECT_EQ(complaint("r = [[0, 1, nan, 3]]", read),
            "f.toml:1: r = [0, 1, nan, 3]: knot 1 number 3 must be finite");
  EXPECT_EQ(complaint("bend_deg = 1\nbend_rad = 1", read),
            "f.toml:2: bend_rad = 1: bend_deg is also given; give only one");
  const auto read_bend = [](TableReader& table) {
    double angle = 0;
    table.angle("bend", angle, inside(0, 90));
  };
  EXPECT_EQ(complaint("bend = 1", read_bend),
            "f.toml:1: bend = 1: unknown key; did you mean bend_deg?");
}

TEST(TomlReader, CondensesSyntaxErrorsToOneLine) {
  for (const auto& [text, line] :
       {std::pair("a = 1\nb = \n", "2"), {"size = 1\nsize = 2", "2"}, {"\n\n[time", "3"}}) {
    const std::string message = complaint(text, read_size);  // error_of() looks for line breaks
    EXPECT_TRUE(message.starts_with(std::string("f.toml:") + line + ": not valid TOML: "))
        << message;
  }
}

TEST(TomlReader, KeepsErrorsOnOneShortLine) {
  const std::string text = "\"a\\nb\" = \"" + std::string(500, 'x') + "\"";
  const std::string message = complaint(text, read_size);
  EXPECT_LT(message.size(), 150u);  // 60 bytes of the value and what is said of it
  EXPECT_NE(message.find("a b = \"xxx"), std::string::npos) << message;
}

TEST(TomlReader, OverridesNameTheOption) {
  const auto why = [](const std::string& assignment) {
    return complaint("size = 1\n[t]\nx = 1\n", [&](TableReader& table) {
      const Override change = parse_override(assignment);
      table.set(change, change.key);
      read_size(table);
      table.table("t", [](TableReader& t) {
        double x = 0;
        t.number("x", x, positive());
      });
    });
  };
  EXPECT_EQ(why("size=2"), "no error");
  EXPECT_EQ(why(" t.x = 2 "), "no error");
  EXPECT_EQ(why("size=-2"), "f.toml: --set size=-2: must be positive");
  EXPECT_EQ(why("t.x=abc"), "f.toml: --set t.x=abc: must be a number");
  EXPECT_EQ(why("t.x="), "f.toml: --set t.x=: must be a number");
  EXPECT_EQ(why("t.x=1\ny=2"), "f.toml: --set t.x=1 y=2: must be a number");
  EXPECT_EQ(why("t.y=1"), "f.toml: --set t.y=1: unknown key; did you mean t.x?");
  EXPECT_EQ(why("t=1"), "f.toml: --set t=1: must be a table; in it there are x");
  EXPECT_EQ(why("water.t=1"), "f.toml: --set water.t=1: water: unknown key; there are size, t");
  EXPECT_EQ(why("size.x=1"), "f.toml: --set size.x=1: size is not a table");
  EXPECT_EQ(why("t={x = -1}"), "f.toml: --set t={x = -1}: t.x must be positive");
  EXPECT_EQ(why("size"), "--set size: must be KEY=VALUE");
  EXPECT_EQ(why("=2"), "--set =2: must be KEY=VALUE");
  EXPECT_EQ(why("t..x=2"), "--set t..x=2: must be KEY=VALUE");
}

TEST(TomlReader, OverriddenStringsNeedNoQuotes) {
  for (const std::string typed : {"two words", "\"two words\"", "12", "nan", "1979-05-27", ""}) {
    TableReader table("title = 'x'", "f.toml");
    table.set(parse_override("title=" + typed), "title");
    std::string title;
    table.string("title", title);
    EXPECT_EQ(title, typed.starts_with('"') ? "two words" : typed);
  }
}

// Of angles, tables and choices: scene_text_test.cpp.
TEST(TomlWriter, WritesTextsAndNumbersThatTheReaderReadsToTheBit) {
  const std::vector<double> values = {0.1, 1.0 / 3, -0.0, 5e-324, 1e22, 1e-5, 123456789.0};
  const std::string name = "quote \" backslash \\ tab \t bell \a é";
  TomlWriter writer;
  writer.string("name", name);
  writer.numbers("values", values, any_number());
  TableReader reader(writer.text(), "f.toml");
  std::string read_name;
  std::vector<double> read;
  reader.string("name", read_name);
  reader.numbers("values", read, any_number());
  reader.finish();
  EXPECT_EQ(read_name, name);
  ASSERT_EQ(read.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read[i]), std::bit_cast<std::uint64_t>(values[i]));
  }
}

TEST(TomlWriter, PrefersDegreesAndFallsBackOnRadians) {
  TomlWriter writer;
  writer.angle("right", 90 * (std::numbers::pi / 180), any_number());
  EXPECT_EQ(writer.text(), "right_deg = 90.0\n");
  // The product with pi / 180 jumps over 1.21, as over one double in eleven.
  TomlWriter skipped;
  skipped.angle("a", 1.21, any_number());
  EXPECT_EQ(skipped.text(), "a_rad = 1.21\n");
}

TEST(TomlWriter, RefusesWhatNoReaderTakesBack) {
  TomlWriter writer;
  EXPECT_THROW(writer.number("x", HUGE_VAL, any_number()), std::invalid_argument);
}

}  // namespace hagfish::toml_reader_test
