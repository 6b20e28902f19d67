// Learned shapes as CSV files: what is wrong, and a basis of another body, is told in one line.
#include "core/input/csv/basis_csv.hpp"

#include <gtest/gtest.h>

#include "tests/support/errors.hpp"

namespace hagfish::basis_csv_test {

const std::string heading = "shape,station (cm),bend_y (1),bend_z (1),twist (1)\n";

ReducedBasisSettings read(const std::string& text, BasisFrame frame = BasisFrame::body) {
  ReducedBasisSettings basis;
  basis.frame = frame;
  read_basis_csv(text, "b.csv", 40, basis);
  return basis;
}

std::string complaint(const std::string& text, BasisFrame frame = BasisFrame::body) {
  return error_of([&] { read(text, frame); });
}

TEST(BasisCsv, ReadsAShapeAfterTheOther) {
  const ReducedBasisSettings basis =
      read(heading + "1,0,1,2,3\n1,40,4,5,6\n2,0,7,8,9\n2,40,0,1,2\n");
  EXPECT_EQ(basis.stations, (std::vector<double>{0, 40}));
  EXPECT_EQ(basis.bend_y, (std::vector<double>{1, 4, 7, 0}));
  EXPECT_EQ(basis.bend_z, (std::vector<double>{2, 5, 8, 1}));
  EXPECT_EQ(basis.twist, (std::vector<double>{3, 6, 9, 2}));
  EXPECT_EQ(basis_size(basis), 2);
}

TEST(BasisCsv, OfAnotherBodyIsRefused) {
  EXPECT_EQ(complaint(heading + "1,0,1,2,3\n1,30,4,5,6\n"),
            "b.csv: made for a body of 30 cm, but the animal is 40 cm long");
  EXPECT_NE(
      complaint(heading + "1,0,1,2,3\n1,40,4,5,6\n", BasisFrame::knot).find("station (window)"),
      std::string::npos);
}

TEST(BasisCsv, WhatIsNoBasisIsRefusedWithItsLine) {
  EXPECT_EQ(complaint(heading + "1,0,1,2,3\n1,40,4,x,6\n"),
            "b.csv:3: bend_z (1) = x: must be a number");
  EXPECT_EQ(complaint(heading + "1,1,1,2,3\n"), "b.csv:2: stations must rise from 0");
  EXPECT_EQ(complaint(heading + "2,0,1,2,3\n"),
            "b.csv:2: shapes must be 1, 2, 3, ..., each with all stations");
  EXPECT_EQ(complaint(heading + "1,0,1,2,3\n1,40,1,2,3\n2,0,1,2,3\n"),
            "b.csv: the last shape does not have all stations");
  EXPECT_EQ(complaint(heading + "1,0,1,2,3\n1,40,1,2,3\n2,1,1,2,3\n"),
            "b.csv:4: each shape must have the stations of the first");
  EXPECT_EQ(complaint(heading), "b.csv: a basis needs two stations or more");
}

}  // namespace hagfish::basis_csv_test
