// What Hdf5Writer saves and Hdf5Reader reads: every kind of dataset, and files that are not as they
// should be, in one line.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/log/hdf5/hdf5_writer.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::hdf5_test {

namespace fs = std::filesystem;

using Shape = std::vector<hsize_t>;

class Hdf5Test : public testing::Test {
 protected:
  Hdf5Reader saved() const {
    h5.save(file);
    return Hdf5Reader(file);
  }

  TemporaryFolder folder;
  const fs::path file = folder / "a.h5";
  Hdf5Writer h5;
};

std::string refusal(const std::function<void()>& action) { return error_of<FileError>(action); }

TEST_F(Hdf5Test, NumbersComeBackWithTheirMeaning) {
  const Eigen::Vector3d values(1.0 / 3, -0.0, 1e300);
  h5.group("/g");
  h5.numbers("/g/v", values, {"cm", "a length"});
  const Hdf5Reader in = saved();
  EXPECT_EQ(in.doubles("/g/v"), (std::vector<double>{1.0 / 3, -0.0, 1e300}));
  EXPECT_TRUE(std::signbit(in.doubles("/g/v")[1]));
  EXPECT_EQ(in.shape("/g/v"), Shape{3});
  EXPECT_EQ(in.attribute("/g/v", "unit"), "cm");
  EXPECT_EQ(in.attribute("/g/v", "description"), "a length");
}

TEST_F(Hdf5Test, MatricesAreStoredRowByRow) {
  const Eigen::MatrixXd m{{1, 2, 3}, {4, 5, 6}};
  h5.plain("/m", m);
  h5.plain("/v", Eigen::VectorXd(Eigen::Vector2d(7, 8)));
  const Hdf5Reader in = saved();
  EXPECT_EQ(in.doubles("/m"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(in.shape("/m"), (Shape{2, 3}));
  EXPECT_EQ(in.rows("/m"), m);
  EXPECT_EQ(in.rows("/v"), Eigen::MatrixXd(Eigen::Vector2d(7, 8)));
}

TEST_F(Hdf5Test, TextsAndAttributesComeBack) {
  const std::string text = "q\u0307, two\nlines and \"quotes\"";
  h5.root_attribute("title", "first");
  h5.root_attribute("title", text);  // the last one counts
  h5.root_attribute("version", 12);
  h5.group("/b");
  h5.attribute("/b", "sequence", std::int64_t{1} << 40);
  h5.text("/b/one", text);
  h5.texts("/b/all", {"", "x", text});
  const Hdf5Reader in = saved();
  EXPECT_EQ(in.root_text("title"), text);
  EXPECT_EQ(in.root_int("version"), 12);
  EXPECT_EQ(in.attribute_int("/b", "sequence"), std::int64_t{1} << 40);
  EXPECT_EQ(in.attribute_int("/b", "other"), std::nullopt);
  EXPECT_EQ(in.texts("/b/one"), std::vector<std::string>{text});
  EXPECT_EQ(in.texts("/b/all"), (std::vector<std::string>{"", "x", text}));
  EXPECT_EQ(in.names("/b"), (std::vector<std::string>{"all", "one"}));
}

TEST_F(Hdf5Test, WhatIsNotThereIsNamedWithItsFile) {
  h5.group("/g");
  h5.texts("/texts", {"x"});
  h5.plain("/v", Eigen::VectorXd(Eigen::Vector2d(1, 2)));
  const Hdf5Reader in = saved();
  const std::string name = file.string() + ": ";
  EXPECT_EQ(refusal([&] { in.doubles("/none"); }), name + "has no /none");
  EXPECT_EQ(refusal([&] { in.texts("/no/such"); }), name + "has no /no/such");
  EXPECT_EQ(refusal([&] { in.names("/none"); }), name + "has no /none");
  EXPECT_EQ(refusal([&] { in.doubles("/texts"); }), name + "/texts does not hold numbers");
  EXPECT_EQ(refusal([&] { in.attribute_int("/none", "sequence"); }), name + "has no /none");
  for (const auto& read : std::vector<std::function<void()>>{[&] { in.root_text("none"); },
                                                             [&] { in.root_int("none"); },
                                                             [&] { in.attribute("/v", "unit"); }}) {
    EXPECT_EQ(refusal(read).rfind(name + "cannot read ", 0), 0u) << refusal(read);
  }
}

TEST_F(Hdf5Test, FilesThatAreNoneAreRefused) {
  EXPECT_EQ(refusal([&] { Hdf5Reader in(file); }), file.string() + ": no such file");
  std::ofstream(file) << "not HDF5";
  EXPECT_EQ(refusal([&] { Hdf5Reader in(file); }), file.string() + ": is not an HDF5 file");
  std::ofstream(file) << "\x89HDF\r\n\x1a\nand then something else";
  EXPECT_TRUE(
      refusal([&] { Hdf5Reader in(file); }).starts_with(file.string() + ": cannot read as HDF5: "));
}

TEST_F(Hdf5Test, SavesAgainOverWhatItSavedAndLeavesNothingElse) {
  for (const char* value : {"one", "another"}) {
    h5.root_attribute("title", value);
    EXPECT_EQ(saved().root_text("title"), value);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator{}), 1);
}

TEST_F(Hdf5Test, AFileOnTheDiskIsChangedThere) {
  h5.root_attribute("title", "before");
  h5.save(file);
  {
    Hdf5Writer again(file);
    again.root_attribute("title", "after");
    again.close();
  }
  const Hdf5Reader in(file);
  EXPECT_EQ(in.root_text("title"), "after");
  EXPECT_TRUE(in.has_root_attribute("title"));
  EXPECT_FALSE(in.has_root_attribute("b"));
  EXPECT_EQ(
      refusal([&] { Hdf5Writer none(folder / "none.h5"); }).find((folder / "none.h5").string()),
      0u);
}

TEST_F(Hdf5Test, WhatCannotBeSavedLeavesTheFileBefore) {
  h5.text("/t", "kept");
  h5.save(file);
  fs::create_directory(folder / "a.h5.new");  // in the way of the second file
  EXPECT_EQ(refusal([&] { h5.save(file); }), file.string() + ": cannot be created: Is a directory");
  EXPECT_EQ(Hdf5Reader(file).texts("/t"), std::vector<std::string>{"kept"});
  EXPECT_EQ(refusal([&] { h5.save(folder / "none/a.h5"); }),
            (folder / "none/a.h5").string() + ": cannot be created: No such file or directory");
  fs::create_directory(folder / "b.h5");
  EXPECT_EQ(refusal([&] { h5.save(folder / "b.h5"); }),
            (folder / "b.h5").string() + ": cannot be given its name: Is a directory");
  EXPECT_FALSE(fs::exists(folder / "b.h5.new"));
}

}  // namespace hagfish::hdf5_test
