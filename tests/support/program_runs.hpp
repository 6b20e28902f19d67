// The program from outside: exit codes, one clear line for bad input, nothing half-written. For
// tests that have HAGFISH_PROGRAM, its path.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/input/csv/delimited_text.hpp"
#include "core/input/files/text_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish {

struct ProgramOutcome {
  int code = -1;
  std::string output;  ///< standard output and error
};

/// A folder of its own, and the program run in it.
class ProgramTest : public testing::Test {
 protected:
  ProgramOutcome run_program(const std::string& arguments) const {
    return run_shell("'" HAGFISH_PROGRAM "' " + arguments);
  }

  ProgramOutcome run_shell(const std::string& words) const {
    const std::string command = "cd '" + folder.path().string() + "' && " + words + " 2>&1";
    ProgramOutcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) {
      outcome.output.append(buffer.data(), n);
    }
    outcome.code = WEXITSTATUS(pclose(pipe));
    return outcome;
  }

  /// Bad input: exit 2, one line that holds every part, and no file left.
  void expect_refused(const std::string& arguments, const std::vector<std::string>& parts) const {
    const ProgramOutcome outcome = run_program(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.output.find(part), std::string::npos) << part << " in " << outcome.output;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      EXPECT_NE(entry.path().extension(), ".h5") << entry.path();
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }

  TemporaryFolder folder;
};

using Cells = std::vector<std::string>;

/// The cells of each line of a CSV file, its heading first.
inline std::vector<Cells> csv_cells(const std::filesystem::path& file) {
  const DelimitedText table(read_text_file(file));
  std::vector<Cells> rows(table.rows());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < table.cells(r); ++k) rows[r].emplace_back(table.cell(r, k));
  }
  return rows;
}

/// 0.02 s of the run: as good as any where only the program's manners are tested.
inline const std::string brief_run = "run --quiet --set time.duration=0.02 ";

}  // namespace hagfish
