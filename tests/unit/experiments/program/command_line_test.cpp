// What `hagfish` says of a command line that names what is not there.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/program_runs.hpp"

namespace hagfish::command_line_test {

class CommandLine : public ProgramTest {
 protected:
  void expect_line(const std::string& arguments, const std::string& line) const {
    const ProgramOutcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.output, "hagfish: " + line + "\n") << arguments;
  }
};

TEST_F(CommandLine, ASlipIsToldTheCommandMeant) {
  expect_line("rnu", "rnu: no such command; did you mean `run`?");
  expect_line("rnu table1 --set time.step=1", "rnu: no such command; did you mean `run`?");
  expect_line("record", "record: no such command; did you mean `record-qp`?");
  expect_line("xyzzyplugh", "xyzzyplugh: no such command (see `hagfish --help`)");
  expect_line("", "A subcommand is required (see `hagfish --help`)");
}

TEST_F(CommandLine, AFileOrSceneInTheCommandsPlaceIsToldWhatTakesIt) {
  expect_line("table1", "table1: no such command; did you mean `run table1`?");
  expect_line("tabel1", "tabel1: no such command; did you mean `run table1`?");
  expect_line("my.toml", "my.toml: no such command; did you mean `run my.toml`?");
  expect_line("a.h5", "a.h5: no such command; did you mean `check a.h5`?");
}

TEST_F(CommandLine, ASlipIsToldTheOptionMeant) {
  expect_line("run --presset quick",
              "--presset: no such option; did you mean `--preset`? (see `hagfish run --help`)");
  expect_line("--verson",
              "--verson: no such option; did you mean `--version`? (see `hagfish --help`)");
  expect_line("run --no-such-thing", "--no-such-thing: no such option (see `hagfish run --help`)");
}

TEST_F(CommandLine, ASlipIsToldTheNameMeant) {
  expect_line("run tabel1",
              "tabel1: no built-in scene of that name (see `hagfish scenes`); did you mean "
              "`table1`?");
  expect_line("run nowhere", "nowhere: no built-in scene of that name (see `hagfish scenes`)");
  expect_line("run --preset quik",
              "--preset: quik is not one of quick, figure; did you mean `quick`? (see "
              "`hagfish run --help`)");
  expect_line("run --preset best",
              "--preset: best is not one of quick, figure (see `hagfish run --help`)");
  expect_line("run --set model.bodie=100",
              "table1 (built in): --set model.bodie=100: unknown key; did you mean model.bodies?");
  expect_line("run --set modle.bodies=100",
              "table1 (built in): --set modle.bodies=100: modle: unknown key; did you mean model?");
}

TEST_F(CommandLine, NumbersOfOptionsAreFiniteAndInRange) {
  for (const std::string word : {"nan", "inf", "0", "-1", "x", "1e999"}) {
    expect_line(
        "stress table1 --step " + word,
        "--step: " + word + " is not a finite number above 0 (see `hagfish stress --help`)");
    expect_line(
        "run --step-limit " + word,
        "--step-limit: " + word + " is not a finite number above 0 (see `hagfish run --help`)");
  }
  expect_line("sweep grid.toml --out x --threads nan",
              "--threads: nan is not a number from 1 to 1024 (see `hagfish sweep --help`)");
}

}  // namespace hagfish::command_line_test
