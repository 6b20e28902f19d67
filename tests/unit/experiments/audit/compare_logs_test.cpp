// Every dataset of a log has something that goes red when it is false: each is changed in turn by
// its last bit, and the comparison with the run made again must name it.
#include "experiments/audit/compare_logs.hpp"

#include <gtest/gtest.h>
#include <hdf5_hl.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "tests/support/stored_states.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::compare_logs_test {

namespace fs = std::filesystem;

/// Changes one entry of a dataset in the middle: a number by as little as can be, a text by a word.
void falsify(const fs::path& file, const std::string& path) {
  H5::H5File h5(file.string(), H5F_ACC_RDWR);
  const H5::DataSet set = h5.openDataSet(path);
  const auto count = static_cast<std::size_t>(set.getSpace().getSimpleExtentNpoints());
  const H5T_class_t kind = set.getTypeClass();
  if (kind == H5T_STRING) {
    const H5::StrType text = set.getStrType();
    std::vector<char*> texts(count);
    set.read(texts.data(), text);
    std::vector<const char*> other(texts.begin(), texts.end());
    other[count / 2] = "another";
    set.write(other.data(), text);
    H5::DataSet::vlenReclaim(texts.data(), text, set.getSpace());
  } else if (kind == H5T_FLOAT) {
    std::vector<double> values(count);
    set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
    double& value = values[count / 2];
    const bool single = set.getFloatType().getSize() == sizeof(float);
    const double next =
        single ? std::nextafter(static_cast<float>(value), 1e30F) : std::nextafter(value, 1e300);
    value = std::isfinite(value) ? next : 1;
    set.write(values.data(), H5::PredType::NATIVE_DOUBLE);
  } else if (kind == H5T_ENUM) {
    std::vector<std::uint8_t> values(count);
    set.read(values.data(), set.getDataType());
    std::uint8_t& value = values[count / 2];
    value = value == 1 ? 2 : 1;
    set.write(values.data(), set.getDataType());
  } else {
    std::vector<std::int64_t> values(count);
    set.read(values.data(), H5::PredType::NATIVE_INT64);
    std::int64_t& value = values[count / 2];
    value += value > 0 ? -1 : 1;
    set.write(values.data(), H5::PredType::NATIVE_INT64);
  }
}

class CompareLogs : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<TemporaryFolder>();
    again = *folder / "again.h5";
    file = *folder / "log.h5";
    write_log(again, scene());
  }
  static void TearDownTestSuite() { folder.reset(); }
  void SetUp() override { fs::copy_file(again, file, fs::copy_options::overwrite_existing); }

  /// The whole Table 1 run, as coarse as can be.
  static ResolvedScene scene(const std::vector<std::string>& more = {}) {
    std::vector<std::string> set = {"time.step=0.01", "time.frame_interval=0.2", "knot.votes=5"};
    set.insert(set.end(), more.begin(), more.end());
    return stored_scene(set);
  }
  /// What differs, or why the log is not read.
  static std::string differences(bool own_build = true) try {
    std::string text;
    for (const std::string& difference :
         compare_logs(LogContents(file), again, own_build).differences) {
      text += difference + "\n";
    }
    return text;
  } catch (const FileError& error) {
    return error.what();
  }
  static std::string reach(bool own_build) {
    return compare_logs(LogContents(file), again, own_build).reach;
  }

  static inline std::unique_ptr<TemporaryFolder> folder;
  static inline fs::path again, file;
};

TEST_F(CompareLogs, TheSameRunIsTheSame) {
  EXPECT_EQ(differences(true) + differences(false), "");
  EXPECT_EQ(reach(false), "to the end, bit by bit");
}

TEST_F(CompareLogs, EachDatasetIsWatchedWhoeverIsSaidToHaveMadeIt) {
  std::vector<std::string> others;
  const auto expect_named = [](const std::string& path, const std::string& text) {
    EXPECT_NE(text.find(path.substr(path.rfind('/'))), std::string::npos) << path << ": " << text;
  };
  for (const std::string& path : Hdf5Reader(again).datasets()) {
    if (path.ends_with("qp_time") || path.ends_with("wall_time")) continue;
    if (!path.starts_with("/model/") && !path.starts_with("/trajectory/")) {
      others.push_back(path);
      continue;
    }
    // Of these some are refused before anything is compared.
    fs::copy_file(again, file, fs::copy_options::overwrite_existing);
    falsify(file, path);
    expect_named(path, differences(false));
  }
  fs::copy_file(again, file, fs::copy_options::overwrite_existing);
  for (const std::string& path : others) falsify(file, path);
  for (const bool own_build : {true, false}) {
    const std::string text = differences(own_build);
    for (const std::string& path : others) expect_named(path, text);
  }
  EXPECT_GT(others.size(), 80u);
}

// Earlier versions had no moments; this one has, and what all had must be there.
TEST_F(CompareLogs, OnlyAnotherBuildMayLackWhatCameLater) {
  for (const auto& [path, later] : {std::pair{"/mean/moments/contact", true},
                                    {"/trajectory/curvature", true},
                                    {"/mean/thigmotaxis/sum", true},
                                    {"/mean/thigmotaxis/lambda", false}}) {
    fs::copy_file(again, file, fs::copy_options::overwrite_existing);
    H5::H5File(file.string(), H5F_ACC_RDWR).unlink(path);
    EXPECT_NE(differences(true).find(path), std::string::npos) << differences(true);
    EXPECT_EQ(differences(false).empty(), later) << differences(false);
  }
}

TEST_F(CompareLogs, UnitsWordsAndLabelsAreWatched) {
  for (const std::string path : {"/trajectory/q", "/steps/kkt", "/model/mass", "/contacts/force"}) {
    for (const std::string word : {"unit", "description"}) {
      fs::copy_file(again, file, fs::copy_options::overwrite_existing);
      H5::H5File(file.string(), H5F_ACC_RDWR).openDataSet(path).removeAttr(word);
      EXPECT_NE(differences().find(path + ": " + word), std::string::npos) << differences();
    }
    fs::copy_file(again, file, fs::copy_options::overwrite_existing);
    {
      H5::H5File h5(file.string(), H5F_ACC_RDWR);
      const H5::DataSet set = h5.openDataSet(path);
      H5DSdetach_scale(set.getId(),
                       h5.openDataSet(path == "/steps/kkt"      ? "/steps/time"
                                      : path == "/model/mass"   ? "/model/arc"
                                      : path == "/trajectory/q" ? "/trajectory/time"
                                                                : "/contacts/frame")
                           .getId(),
                       0);
    }
    EXPECT_NE(differences(false).find(path + ": labels of axis 0"), std::string::npos)
        << differences(false);
  }
}

TEST_F(CompareLogs, WhatIsGoneOrNewIsNamed) {
  {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    h5.move("/diagnostics/work_tip", "/elsewhere");
  }
  const std::string text = differences();
  EXPECT_NE(text.find("/diagnostics/work_tip is not there"), std::string::npos) << text;
  EXPECT_NE(text.find("/elsewhere is not of this run"), std::string::npos) << text;
}

TEST_F(CompareLogs, ExchangedColumnsAreSeen) {
  {
    const H5::H5File h5(file.string(), H5F_ACC_RDWR);
    h5.move("/diagnostics/work_tip", "/elsewhere");
    h5.move("/diagnostics/work_contact", "/diagnostics/work_tip");
    h5.move("/elsewhere", "/diagnostics/work_contact");
  }
  EXPECT_NE(differences().find("/diagnostics/work_tip, row"), std::string::npos) << differences();
}

// A start that is off by rounding stands for a machine that rounds otherwise: motions part, and by
// how little counts.
TEST_F(CompareLogs, WhatAnotherMachineRoundsOtherwiseIsNotFalse) {
  write_log(file, scene({"start.noise_deg=1e-11"}));
  write_scene(file, Hdf5Reader(again).root_text("scene"));
  EXPECT_NE(differences(true), "");
  EXPECT_EQ(differences(false), "");
  EXPECT_NE(reach(false).find("parted the two"), std::string::npos) << reach(false);
  rewrite<double>(file, "/steps/penetration", H5::PredType::NATIVE_DOUBLE,
                  [](std::vector<double>& values) { values[3] = 1; });
  EXPECT_NE(differences(false).find("/steps/penetration, step 3"), std::string::npos);
}

}  // namespace hagfish::compare_logs_test
