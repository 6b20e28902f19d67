// Curvature programs as CSV files: what is written is read, and what is wrong is told in one line.
#include "core/input/csv/curvature_csv.hpp"

#include <gtest/gtest.h>

#include "tests/support/errors.hpp"

namespace hagfish::curvature_csv_test {

const std::string heading = "time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)\n";

std::string complaint(const std::string& text) {
  return error_of([&] { read_curvature_csv(text, "p.csv"); });
}

TEST(CurvatureCsv, ReadsWhatIsWritten) {
  CurvatureProgram program{{0, 1.5}, {0, 0.25, 1}, {}, {}};
  for (int k = 0; k < 2; ++k) {
    Eigen::Matrix3Xd value(3, 3);
    value << 1.25, -2, 3.5 + k, 0, 0.125, -7, 1e-7, 11, 0.5;
    program.value.push_back(value);
  }
  const std::string text = curvature_csv(program);
  EXPECT_EQ(text.find(heading), 0u) << text;
  const CurvatureProgram read = read_curvature_csv(text, "p.csv");
  EXPECT_EQ(read.time, program.time);
  EXPECT_EQ(read.station, program.station);
  for (int k = 0; k < 2; ++k) {
    // Rounded to curvature_rounding.
    EXPECT_LE((read.value[k] - program.value[k]).cwiseAbs().maxCoeff(), curvature_rounding / 2);
  }
  EXPECT_EQ(curvature_csv(read), text);
}

TEST(CurvatureCsv, TakesColumnsByNameAndSkipsComments) {
  const CurvatureProgram read = read_curvature_csv(
      "# by hand\nstation (L),time (s),note,bend_z (rad/L),bend_y (rad/L),twist (rad/L)\n"
      "0.5,0,a,2,1,3\n# later\n0.5,4,b,5,4,6\n",
      "p.csv");
  EXPECT_EQ(read.time, (std::vector<double>{0, 4}));
  EXPECT_EQ(read.value[0].col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read.value[1].col(0), Eigen::Vector3d(4, 5, 6));
}

/// `text` with each `from` as `to`.
std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST(CurvatureCsv, ReadsTheSameNumbersWhateverProgramSavedThem) {
  const std::string plain =
      heading + "0,0,0.1,-2.5e-3,0\n0,1,1,0,3\n20.5,0,0,1.5,0\n20.5,1,4,0,5\n";
  const std::string german = with(with(plain, ",", ";"), ".", ",");
  std::string wide = "\xFF\xFE";
  for (const char c : with(german, ";", "\t")) wide += {c, '\0'};
  const std::string quoted = with("\"" + with(plain, ",", "\",\""), "\n", "\"\r\n\"");
  const CurvatureProgram wanted = read_curvature_csv(plain, "p.csv");
  for (const std::string& text :
       {german, with(plain, ",", ";"), with(plain, ",", "\t"), with(german, "\n", "\r\n"),
        with(german, "\n", "\r"), "\xEF\xBB\xBF" + german, wide,
        quoted.substr(0, quoted.size() - 1)}) {
    const CurvatureProgram read = read_curvature_csv(text, "p.csv");
    EXPECT_EQ(read.time, wanted.time) << text;
    EXPECT_EQ(read.station, wanted.station) << text;
    EXPECT_EQ(read.value, wanted.value) << text;
  }
}

TEST(CurvatureCsv, TellsWhatIsWrong) {
  EXPECT_EQ(
      complaint("time (s);station (L)\n"),
      "p.csv: no column bend_y (rad/L) among the 2 that semicolons separate: time (s), station "
      "(L)");
  EXPECT_EQ(complaint(""), "p.csv: no column time (s) among the 0 that commas separate: ");
  EXPECT_EQ(complaint(heading), "p.csv: a program needs two times or more");
  EXPECT_EQ(complaint(heading + "0,0,1,2,3\n"), "p.csv: a program needs two times or more");
  EXPECT_EQ(complaint(heading + "1,0,1,2,3\n"), "p.csv:2: the first time must be 0");
  EXPECT_EQ(complaint(heading + "0,0,1,x,3\n"), "p.csv:2: bend_z (rad/L) = x: must be a number");
  EXPECT_EQ(complaint(heading + "0,0,1,nan,3\n"),
            "p.csv:2: bend_z (rad/L) = nan: must be a number");
  EXPECT_EQ(complaint(heading + "0,0,1,,3\n"), "p.csv:2: bend_z (rad/L) = : must be a number");
  EXPECT_EQ(complaint(heading + "0,0.5,1,2,3\n0,0.2,1,2,3\n"),
            "p.csv:3: stations must rise from 0 to 1");
  EXPECT_EQ(complaint(heading + "0,1.5,1,2,3\n"), "p.csv:2: stations must rise from 0 to 1");
  EXPECT_EQ(complaint(heading + "0,0,1,2,3\n0,1,1,2,3\n2,0,1,2,3\n1,0,1,2,3\n"),
            "p.csv:5: times must rise");
  EXPECT_EQ(complaint(heading + "0,0,1,2,3\n0,1,1,2,3\n2,0,1,2,3\n3,0,1,2,3\n"),
            "p.csv:5: time 2 has 1 of 2 stations");
  EXPECT_EQ(complaint(heading + "0,0,1,2,3\n0,1,1,2,3\n2,0.5,1,2,3\n"),
            "p.csv:4: each time must have the stations of the first");
  EXPECT_EQ(complaint(heading + "0,0,1,2,3\n0,1,1,2,3\n2,0,1,2,3\n"),
            "p.csv: the last time does not have all stations");
  EXPECT_EQ(complaint(heading + "0,0,1,2\n"),
            "p.csv:2: commas separate 4 cells, but 5 in the heading");
  EXPECT_EQ(complaint(heading + "0,0,1,5,2,3\n"),
            "p.csv:2: commas separate 6 cells, but 5 in the heading");
  EXPECT_EQ(complaint("time (s)," + heading), "p.csv: two columns time (s)");
}

}  // namespace hagfish::curvature_csv_test
