#include "experiments/common/csv.hpp"

#include <gtest/gtest.h>

namespace hagfish::csv_test {

TEST(Csv, QuotesWhatNeedsQuotes) {
  EXPECT_EQ(csv_text({{"a", "b"}, {"1", ""}, {"x, y", "say \"no\""}, {"two\nlines", "c"}}),
            "a,b\n1,\n\"x, y\",\"say \"\"no\"\"\"\n\"two\nlines\",c\n");
}

}  // namespace hagfish::csv_test
