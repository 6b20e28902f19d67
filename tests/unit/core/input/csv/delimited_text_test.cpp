// Tables of delimited text.
#include "core/input/csv/delimited_text.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace hagfish::delimited_text_test {

// Short texts are within their string: a view of them would not outlive a move.
TEST(DelimitedText, KeepsItsCellsWhenItIsMoved) {
  DelimitedText first("ab,c\n1,2");
  const DelimitedText moved = std::move(first);
  first = DelimitedText("xy,z\n3,4");
  EXPECT_EQ(moved.cell(0, 0), "ab");
  EXPECT_EQ(moved.cell(0, 1), "c");
  EXPECT_EQ(moved.number(1, 0), 1);
}

}  // namespace hagfish::delimited_text_test
