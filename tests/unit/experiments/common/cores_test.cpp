#include "experiments/common/cores.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace hagfish {
namespace {

int cores_at(const std::string& quota) {
  const std::string file = testing::TempDir() + "cpu.max";
  std::ofstream(file) << quota;
  const int cores = usable_cores(file);
  std::filesystem::remove(file);
  return cores;
}

TEST(UsableCores, AreNoMoreThanTheQuotaOfAContainer) {
  const int all = usable_cores("no such file");
  EXPECT_GE(all, 1);
  EXPECT_EQ(cores_at("max 100000\n"), all);
  EXPECT_EQ(cores_at("100000 100000\n"), 1);
  EXPECT_EQ(cores_at("20000 100000\n"), 1);
  EXPECT_EQ(cores_at("150000 100000\n"), std::min(all, 2));
  EXPECT_EQ(cores_at("1000000000 100000\n"), all);
  EXPECT_EQ(cores_at("nonsense"), all);
}

}  // namespace
}  // namespace hagfish
