// A log whose datasets are not what its scene makes of them is refused, with the first one named,
// whatever command reads it.
#include "core/log/reading/log_schema.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/log/reading/log_contents.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::log_schema_test {

using H5::PredType;

class LogSchema : public testing::Test {
 protected:
  LogSchema() { write_log(file, stored_scene({"time.frame_interval=0.01", "model.bodies=8"}), 15); }
  /// Puts `extent` values of `type`, all 0, in the place of a dataset.
  void replace(const std::string& path, const H5::DataType& type,
               const std::vector<hsize_t>& extent) const {
    H5::H5File h5(file, H5F_ACC_RDWR);
    h5.unlink(path);
    const H5::DataSpace space = extent.empty()
                                    ? H5::DataSpace()
                                    : H5::DataSpace(static_cast<int>(extent.size()), extent.data());
    h5.createDataSet(path, type, space);
  }
  template <class T>
  void set(const std::string& path, const PredType& type, std::size_t index, T value) const {
    rewrite<T>(file, path, type, [&](std::vector<T>& values) { values.at(index) = value; });
  }
  std::string refusal() const {
    const std::string text = error_of<FileError>([this] { LogContents log(file); });
    return text == "no error" ? text : text.substr(file.size() + 2);
  }

  TemporaryFolder folder;
  const std::string file = (folder / "log.h5").string();
};

TEST_F(LogSchema, AcceptsWhatIsWritten) { EXPECT_EQ(refusal(), "no error"); }

TEST_F(LogSchema, WantsSeriesForWhatIsCounted) {
  for (const std::string path : {"/steps/kkt", "/contacts/frame", "/trajectory/time"}) {
    replace(path, PredType::NATIVE_DOUBLE, {});
    EXPECT_EQ(refusal(), path + " is not a series");
    replace(path, PredType::NATIVE_DOUBLE, {0});
  }
}

TEST_F(LogSchema, WantsTheShapeOfModelAndFrames) {
  const std::tuple<std::string, std::vector<hsize_t>, std::string> cases[] = {
      {"/diagnostics/wall_time", {0}, "(0), not (4)"},
      {"/diagnostics/qp_time", {2}, "(2), not (4)"},
      {"/mean/forces/thigmotaxis", {3, 2}, "(3, 2), not (4, 17)"},
      {"/steps/penetration", {}, "(), not (15)"}};
  for (const auto& [path, extent, shapes] : cases) {
    replace(path, PredType::NATIVE_DOUBLE, extent);
    EXPECT_EQ(refusal(), path + " has the shape " + shapes + ", that of its model and frames");
    std::vector<hsize_t> right{4};
    if (path.starts_with("/mean")) right.push_back(17);
    replace(path, PredType::NATIVE_DOUBLE,
            path.starts_with("/steps") ? std::vector<hsize_t>{15} : right);
  }
}

TEST_F(LogSchema, WantsNumbersOfTheKindThatIsWritten) {
  replace("/trajectory/step", PredType::NATIVE_DOUBLE, {3});
  EXPECT_EQ(refusal(), "/trajectory/step holds floating-point numbers, not whole numbers");
  replace("/trajectory/step", H5::StrType(PredType::C_S1, H5T_VARIABLE), {3});
  EXPECT_EQ(refusal(), "/trajectory/step holds something else, not whole numbers");
}

TEST_F(LogSchema, WantsStepsThatAreThere) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  set<std::int64_t>("/trajectory/step", PredType::NATIVE_INT64, 2, most);
  EXPECT_EQ(refusal(), "/trajectory/step holds 9223372036854775807, not 0 to 9007199254740992");
  set<std::int64_t>("/trajectory/step", PredType::NATIVE_INT64, 2, 100);
  EXPECT_EQ(refusal(),
            "/trajectory/step goes from 5 to 100, but its scene has 5 steps between frames");
}

TEST_F(LogSchema, WantsBodiesFramesAndKindsThatThereAre) {
  set<int>("/thigmotaxis/body_b", PredType::NATIVE_INT, 0, std::numeric_limits<int>::max());
  EXPECT_EQ(refusal(), "/thigmotaxis/body_b holds 2147483647, not -1 to 7");
  set<int>("/thigmotaxis/body_b", PredType::NATIVE_INT, 0, -1);
  // HDF5 makes no enumeration of a number, so in its own type.
  const H5::DataType solve =
      H5::H5File(file, H5F_ACC_RDONLY).openDataSet("/steps/solve").getDataType();
  rewrite<std::uint8_t>(file, "/steps/solve", solve,
                        [](std::vector<std::uint8_t>& values) { values.at(1) = 3; });
  EXPECT_EQ(refusal(), "/steps/solve holds 3, not 0 to 2");
}

TEST_F(LogSchema, WantsMotionThatCanBe) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  set("/trajectory/q", PredType::NATIVE_DOUBLE, 10, none);
  EXPECT_EQ(refusal(), "/trajectory/q holds nan, not a number up to 1000");
  set("/trajectory/q", PredType::NATIVE_DOUBLE, 10, 0.0);
  set("/trajectory/q", PredType::NATIVE_DOUBLE, 0, 1e7);
  EXPECT_EQ(refusal(), "/trajectory/q holds 1e+07, not a number up to 1e+06");
  set("/trajectory/q", PredType::NATIVE_DOUBLE, 0, 0.0);
  set("/trajectory/q", PredType::NATIVE_DOUBLE, 3, 0.0);
  EXPECT_EQ(refusal(), "/trajectory/q has a quaternion of norm 0 at frame 0");
  set("/trajectory/q", PredType::NATIVE_DOUBLE, 3, 1.0);
  set("/trajectory/qdot", PredType::NATIVE_DOUBLE, 4, 1e300);
  EXPECT_EQ(refusal(), "/trajectory/qdot holds 1e+300, not a number up to 1e+09");
  set("/trajectory/qdot", PredType::NATIVE_DOUBLE, 4, 0.0);
  set("/trajectory/time", PredType::NATIVE_DOUBLE, 2, 0.0);
  EXPECT_EQ(refusal(), "/trajectory/time holds 0 s at frame 2: times must rise");
}

}  // namespace hagfish::log_schema_test
