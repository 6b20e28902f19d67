#include "core/input/input_text.hpp"

#include <gtest/gtest.h>

namespace hagfish {
namespace {

const std::vector<std::string> words = {"run", "scenes", "record-qp", "qp"};

TEST(InputText, NearestTakesAnyDistance) {
  EXPECT_EQ(nearest("rnu", words), "run");
  EXPECT_EQ(nearest("zebra crossing", {"a", "zebra"}), "zebra");
  EXPECT_EQ(nearest("run", {}), "");
}

TEST(InputText, SimilarTakesSlipsAndBeginningsOnly) {
  EXPECT_EQ(similar("rnu", words), "run");
  EXPECT_EQ(similar("sceens", words), "scenes");
  EXPECT_EQ(similar("record", words), "record-qp");
  EXPECT_EQ(similar("runs-on", words), "run");
  EXPECT_EQ(similar("nowhere", words), "");
  EXPECT_EQ(similar("run", {}), "");
}

TEST(InputText, DidYouMeanIsEmptyWhereNothingIsNear) {
  EXPECT_EQ(did_you_mean("rnu", words), "; did you mean `run`?");
  EXPECT_EQ(did_you_mean("nowhere", words), "");
}

}  // namespace
}  // namespace hagfish
