#include "experiments/common/failure.hpp"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "core/input/input_error.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "core/step/outcome.hpp"

namespace hagfish::failure_test {

TEST(Failure, OutOfMemoryIsSaidInWords) {
  EXPECT_EQ(reason(std::bad_alloc()), "out of memory");
  EXPECT_EQ(reason(std::bad_array_new_length()), "out of memory");
}

TEST(Failure, AMessageForTheReaderIsAllThatIsSaid) {
  EXPECT_EQ(reason(InputError("a.toml: why")), "a.toml: why");
  EXPECT_EQ(reason(FileError("a.h5: why")), "a.h5: why");
  EXPECT_EQ(reason(StepError({Outcome::speed, "body 3 is fast"})), "body 3 is fast");
  EXPECT_EQ(reason(std::domain_error("knot: degenerate")), "knot: degenerate");
}

TEST(Failure, WhatATerminalWouldObeyIsShownAsBytes) {
  EXPECT_EQ(reason(FileError("a.h5: \x1b[31mred\x07")), "a.h5: \\x1b[31mred\\x07");
}

TEST(Failure, WhatNobodyForesawIsAnInternalError) {
  EXPECT_EQ(reason(std::exception()), "internal error: std::exception");
  EXPECT_EQ(reason(std::out_of_range("row 7\nof 3")), "internal error: row 7 of 3") << "one line";
}

TEST(Failure, OnlyWhatTheUserGaveIsBadInput) {
  EXPECT_TRUE(is_bad_input(InputError("why")));
  EXPECT_TRUE(is_bad_input(FileError("why")));
  EXPECT_FALSE(is_bad_input(std::bad_alloc()));
  EXPECT_FALSE(is_bad_input(std::runtime_error("why")));
}

}  // namespace hagfish::failure_test
