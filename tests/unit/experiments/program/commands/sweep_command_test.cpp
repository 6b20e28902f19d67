// `hagfish sweep` from outside.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "tests/support/program_runs.hpp"

namespace hagfish::sweep_command_test {

namespace fs = std::filesystem;

using Row = std::map<std::string, std::string>;

/// Of a CSV file.
std::vector<Row> rows_of(const fs::path& file) {
  std::vector<Cells> cells = csv_cells(file);
  std::vector<Row> rows(cells.size() - 1);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < cells[0].size(); ++k) rows[r][cells[0][k]] = cells[r + 1].at(k);
  }
  return rows;
}

class SweepTest : public ProgramTest {
 protected:
  /// Nine runs of 0.2 s of the animal's time, which end before anything is tied.
  void SetUp() override {
    folder.write("grid.toml", R"(
scene = "table1"
set = ["time.step=0.02", "time.duration=0.2", "start.noise_deg=0.1", "expect.knot='3_1'"]
seeds = 3
[[axis]]
"model.limit_scale" = [0.8, 1, 1.2]
)");
  }
  void sweep(const std::string& arguments, int code = 0) const {
    const ProgramOutcome outcome = run_program("sweep --quiet " + arguments);
    EXPECT_EQ(outcome.code, code) << arguments << ": " << outcome.output;
  }
  std::string text(const std::string& file) const { return read_text_file(folder / file); }
};

TEST_F(SweepTest, GoesOnWhereAKillLeftIt) {
  sweep("grid.toml --out whole");
  // Rows in the order in which they came, each with its CPU time, the last one half-written.
  std::istringstream lines(text("whole/table.csv"));
  std::string heading, first, second, third;
  for (std::string* line : {&heading, &first, &second, &third}) std::getline(lines, *line);
  fs::create_directory(folder / "killed");
  fs::copy_file(folder / "whole/sweep.toml", folder / "killed/sweep.toml");
  folder.write("killed/table.csv.part",
               third + ",7.5\n" + first + ",1.0\n" + second.substr(0, second.size() / 2));
  sweep("grid.toml --out killed");
  EXPECT_EQ(text("killed/table.csv"), text("whole/table.csv"));
  EXPECT_EQ(rows_of(folder / "killed/times.csv")[2].at("cpu_s"), "7.5");  // not made again
  EXPECT_FALSE(fs::exists(folder / "killed/table.csv.part"));
  // What is whole is left as it is.
  const auto before = fs::last_write_time(folder / "whole/table.csv");
  sweep("grid.toml --out whole");
  EXPECT_EQ(fs::last_write_time(folder / "whole/table.csv"), before);
}

TEST_F(SweepTest, RefusesAFolderOfAnotherSweepAndDamagedRows) {
  sweep("grid.toml --out a --part 1/9");
  folder.write("other.toml",
               "scene='table1'\nset=['time.step=0.02']\n[[axis]]\n'model.bodies'=[50]\n");
  expect_refused("sweep other.toml --out a", {"a: holds another sweep"});
  EXPECT_EQ(run_program("sweep grid.toml --out a --part 2/9 --quiet").code, 0);
  for (const std::string row : {"0,garbage\n", "what,1\n", "1,0.5\n", "2,0.5\n2,0.5\n"}) {
    folder.write("a/table.3-of-9.csv.part", row);
    const ProgramOutcome outcome = run_program("sweep grid.toml --out a --part 3/9");
    EXPECT_EQ(outcome.code, 2) << row;
    EXPECT_NE(outcome.output.find("table.3-of-9.csv.part"), std::string::npos) << outcome.output;
  }
}

TEST_F(SweepTest, RefusesBadInputInOneLine) {
  for (const char* part : {"0/3", "4/3", "3", "x", "1/", "-1/2", "1/2/3", "1/10"}) {
    expect_refused(std::string("sweep grid.toml --out o --part ") + part, {"--part", part});
  }
  expect_refused("sweep grid.toml --out grid.toml", {"grid.toml", "cannot be created"});
  expect_refused("sweep grid.toml --out o --threads 0", {"--threads"});
  EXPECT_FALSE(fs::exists(folder / "o"));
  fs::create_directories(folder / "a/sweep.toml");
  expect_refused("sweep grid.toml --out a", {"a/sweep.toml: is a directory"});
  fs::create_directories(folder / "b/table.csv");
  expect_refused("sweep grid.toml --out b", {"b/table.csv: is not a regular file"});
}

TEST_F(SweepTest, AFailedRunIsARowAndOnlyItsLogIsKept) {
  folder.write("fails.toml", R"(
scene = "table1"
keep = "failed"
set = ["time.step=0.02", "time.duration=0.2", "expect.knot=''", "expect.types=[]", "expect.energy_loss=1"]
[[axis]]
"guard.speed" = [10000, 4]
)");
  sweep("fails.toml --out o");
  const std::vector<Row> rows = rows_of(folder / "o/table.csv");
  EXPECT_EQ(rows[0].at("outcome"), "ok");
  EXPECT_EQ(rows[0].at("unmet"), "");
  EXPECT_EQ(rows[1].at("outcome"), "speed");
  EXPECT_NE(rows[1].at("message").find("guard.speed"), std::string::npos) << rows[1].at("message");
  EXPECT_FALSE(fs::exists(folder / "o/logs/0.h5"));
  const ProgramOutcome info = run_program("info o/logs/1.h5");
  EXPECT_EQ(info.code, 0);
  EXPECT_NE(info.output.find("failed: "), std::string::npos) << info.output;
}

TEST_F(SweepTest, SettingsThatContradictEachOtherAreARow) {
  folder.write("some.toml", R"(
scene = "table1"
set = ["time.duration=0.12"]
[[axis]]
"time.step" = [0.01, 0.02]
[[axis]]
"time.frame_interval" = [0.02, 0.03]
)");
  sweep("some.toml --out o");
  const std::string table = text("o/table.csv");
  EXPECT_NE(table.find("\n2,0.02,0.02,ok,"), std::string::npos) << table;
  EXPECT_NE(table.find("\n3,0.02,0.03,refused,"), std::string::npos) << table;
}

/// Whole runs: a knot slid to the head, one slid back to the tail, one that pulls at food; and one
/// that is never tied.
TEST_F(SweepTest, ARowSaysWhatTheLogSays) {
  folder.write("runs.toml", R"(
keep = "all"
set = ["time.step=0.02", "time.frame_interval=0.02", "food.strength=100", "expect.momentum=1"]
[[axis]]
scene = ["table1", "overhand_reverse", "pull_double_overhand", "table1"]
"time.duration" = [25, 25, 25, 5]
)");
  sweep("runs.toml --out o");
  const std::vector<Row> rows = rows_of(folder / "o/table.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].at("unmet"), "");
  EXPECT_NE(rows[2].at("pull_N"), "");
  for (const Row& row : rows) {
    const std::string log = "o/logs/" + row.at("cell") + ".h5";
    ASSERT_EQ(run_program("export " + log + " --out e --force").code, 0);
    run_program("check " + log + " --csv check.csv --force");
    const auto expect_same = [&](const std::string& name, const std::string& logged) {
      if (row.at(name).empty() || logged.empty()) {
        EXPECT_EQ(row.at(name), logged) << name << " of " << log;
      } else {
        // The export has nine digits; imbalances of ledgers are rounding.
        const double value = std::stod(row.at(name)), wanted = std::stod(logged);
        EXPECT_NEAR(value, wanted, 1e-8 * std::abs(wanted) + 1e-12) << name << " of " << log;
      }
    };
    const Row summary = rows_of(folder / "e/summary.csv").at(0);
    for (const char* name : {"knot", "slide"}) {
      EXPECT_EQ(row.at(name), summary.at(name)) << name << " of " << log;
    }
    int compared = 0;
    for (const auto& [name, value] : summary) {
      if (name != "knot" && name != "slide" && name != "scene" && row.contains(name)) {
        expect_same(name, value);
        ++compared;
      }
    }
    EXPECT_EQ(compared, 31) << log;
    const std::map<std::string, std::string> columns{{"penetration", "penetration_cm"},
                                                     {"skin fold", "skin_fold"},
                                                     {"head drift", "head_drift_cm"},
                                                     {"KKT residual", "kkt"},
                                                     {"Eq. 6", "eq6_percent"},
                                                     {"energy ledger", "energy_ledger"},
                                                     {"energy gain", "energy_gain"},
                                                     {"energy loss", "energy_loss"},
                                                     {"momentum ledger", "momentum_ledger"},
                                                     {"slide", "slide_distance_cm"},
                                                     {"slide of both ends", "both_ends_percent"},
                                                     {"pull", "pull_N"}};
    std::set<std::string> unmet;
    for (const Row& finding : rows_of(folder / "check.csv")) {
      const std::string criterion = finding.at("criterion");
      const auto column = columns.find(criterion);
      if (column != columns.end()) expect_same(column->second, finding.at("value"));
      if (finding.at("met") == "no" && criterion != "status") unmet.insert(criterion);
    }
    std::set<std::string> said;
    std::istringstream names(row.at("unmet"));
    for (std::string name; std::getline(names, name, ';');) {
      said.insert(name.substr(name.find_first_not_of(' ')));
    }
    EXPECT_EQ(said, unmet) << log;
  }
}

}  // namespace hagfish::sweep_command_test
