// Files that were made to do harm, or were damaged: Hdf5Reader refuses them in one line, before it
// asks for memory, and opens no other file.
#include <H5Cpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <functional>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::hdf5_hostile_test {

const H5::PredType& number() { return H5::PredType::NATIVE_DOUBLE; }

class HostileHdf5 : public testing::Test {
 protected:
  using Change = std::function<void(H5::H5File&)>;

  void make(const Change& change) const {
    H5::H5File h5(file, H5F_ACC_TRUNC);
    change(h5);
  }
  /// What reading is refused with, without the file's name.
  std::string refusal(const std::function<void(const Hdf5Reader&)>& read) const {
    const std::string text = error_of<FileError>([&] { read(Hdf5Reader(file)); });
    EXPECT_TRUE(text.starts_with(file + ": ")) << text;
    return text.substr(std::min(text.size(), file.size() + 2));
  }
  std::string refusal_of(const std::string& path) const {
    return refusal([&](const Hdf5Reader& in) { in.doubles(path); });
  }

  TemporaryFolder folder;
  const std::string file = (folder / "a.h5").string();
};

TEST_F(HostileHdf5, LinksAreNotFollowed) {
  make([](H5::H5File& h5) {
    h5.createDataSet("real", number(), H5::DataSpace());
    H5Lcreate_external("/dev/zero", "/x", h5.getId(), "out", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/real", h5.getId(), "soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/loop", h5.getId(), "loop", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external("/dev/zero", "/", h5.getId(), "group", H5P_DEFAULT, H5P_DEFAULT);
  });
  for (const std::string path : {"/out", "/soft", "/loop", "/group"}) {
    EXPECT_EQ(refusal_of(path), path + " is a link; only what the file itself has is read");
  }
  EXPECT_EQ(refusal_of("/group/x"), "/group is a link; only what the file itself has is read");
  EXPECT_EQ(Hdf5Reader(file).doubles("/real").size(), 1u);
}

TEST_F(HostileHdf5, NumbersInOtherFilesAreNotRead) {
  const hsize_t extent = 2;
  const H5::DataSpace two(1, &extent);
  make([&](H5::H5File& h5) {
    H5::DSetCreatPropList outside;
    outside.setExternal("/etc/passwd", 0, 2 * sizeof(double));
    h5.createDataSet("outside", number(), two, outside);
    H5::DSetCreatPropList elsewhere;
    elsewhere.setVirtual(two, "/tmp/other.h5", "x", two);
    h5.createDataSet("elsewhere", number(), two, elsewhere);
  });
  EXPECT_EQ(refusal_of("/outside"), "the numbers of /outside are in another file");
  EXPECT_EQ(refusal_of("/elsewhere"), "the numbers of /elsewhere are in another file");
}

TEST_F(HostileHdf5, MoreThanTheFileCanHoldIsNotAskedFor) {
  make([&](H5::H5File& h5) {
    H5::DSetCreatPropList chunked;
    const hsize_t chunk = 4, most = H5S_UNLIMITED;
    chunked.setChunk(1, &chunk);
    for (const auto& [name, rows] :
         {std::pair("rows", hsize_t{1} << 31), {"more", hsize_t{1} << 61}}) {
      h5.createDataSet(name, number(), H5::DataSpace(1, &rows, &most), chunked);
    }
    const hsize_t square[] = {hsize_t{1} << 32, hsize_t{1} << 32};
    const hsize_t square_chunk[] = {4, 4};
    chunked.setChunk(2, square_chunk);
    h5.createDataSet("overflow", number(), H5::DataSpace(2, square), chunked);
  });
  for (const std::string path : {"/rows", "/more", "/overflow"}) {
    EXPECT_EQ(refusal_of(path), path + " says that it holds more than a file of this size can");
  }
}

TEST_F(HostileHdf5, AttributesAreOneTextOrOneWholeNumber) {
  make([](H5::H5File& h5) {
    H5::Group root = h5.openGroup("/");
    const hsize_t many = 500, none = 0;
    const H5::StrType text(H5::PredType::C_S1, H5T_VARIABLE), fixed(H5::PredType::C_S1, 8);
    const std::vector<int> numbers(many, 7);
    root.createAttribute("numbers", H5::PredType::NATIVE_INT, H5::DataSpace(1, &many))
        .write(H5::PredType::NATIVE_INT, numbers.data());
    root.createAttribute("no_texts", text, H5::DataSpace(1, &none));
    root.createAttribute("null", fixed, H5::DataSpace(H5S_NULL));
    root.createAttribute("fixed", fixed, H5::DataSpace()).write(fixed, "abc\0\0\0\0\0");
    root.createAttribute("unset", text, H5::DataSpace());
    const std::int64_t large = std::int64_t{1} << 40;
    root.createAttribute("large", H5::PredType::NATIVE_INT64, H5::DataSpace())
        .write(H5::PredType::NATIVE_INT64, &large);
  });
  for (const std::string name : {"numbers", "no_texts", "null", "large"}) {
    EXPECT_EQ(refusal([&](const Hdf5Reader& in) { in.root_text(name); }),
              "attribute " + name + " is not one text");
  }
  for (const std::string name : {"numbers", "fixed"}) {
    EXPECT_EQ(refusal([&](const Hdf5Reader& in) { in.root_int(name); }),
              "attribute " + name + " is not one whole number");
  }
  EXPECT_EQ(refusal([&](const Hdf5Reader& in) { in.root_int("large"); }),
            "attribute large is 1099511627776");
  EXPECT_EQ(Hdf5Reader(file).root_text("fixed"), "abc");
  EXPECT_EQ(Hdf5Reader(file).root_text("unset"), "");
}

TEST_F(HostileHdf5, TextsOfAnyKindAreReadAndNothingElseIsTakenForOne) {
  make([](H5::H5File& h5) {
    const H5::StrType fixed(H5::PredType::C_S1, 4), text(H5::PredType::C_S1, H5T_VARIABLE);
    const hsize_t two = 2, none = 0;
    h5.createDataSet("fixed", fixed, H5::DataSpace(1, &two)).write("ab\0\0wxyz", fixed);
    h5.createDataSet("unset", text, H5::DataSpace());
    h5.createDataSet("none", text, H5::DataSpace(1, &none));
    h5.createDataSet("numbers", number(), H5::DataSpace(1, &two));
  });
  const Hdf5Reader in(file);
  EXPECT_EQ(in.texts("/fixed"), (std::vector<std::string>{"ab", "wxyz"}));
  EXPECT_EQ(in.text("/unset"), "");
  for (const std::string path : {"/fixed", "/none"}) {
    EXPECT_EQ(refusal([&](const Hdf5Reader& h5) { h5.text(path); }), path + " is not one text");
  }
  EXPECT_EQ(refusal([](const Hdf5Reader& h5) { h5.texts("/numbers"); }),
            "/numbers does not hold texts");
  EXPECT_EQ(refusal([](const Hdf5Reader& h5) { h5.integers("/numbers"); }),
            "/numbers does not hold whole numbers");
}

TEST_F(HostileHdf5, WhatIsNoDatasetOrGroupIsSaidToBeNone) {
  make([](H5::H5File& h5) {
    h5.createGroup("g");
    h5.createDataSet("v", number(), H5::DataSpace());
    H5::DataType type(H5::PredType::NATIVE_DOUBLE);
    type.commit(h5, "type");
  });
  EXPECT_EQ(refusal_of("/g"), "/g is not a dataset");
  EXPECT_EQ(refusal_of("/type"), "/type is not a dataset");
  EXPECT_EQ(refusal_of("/v/x"), "/v is not a group");
  EXPECT_EQ(refusal([](const Hdf5Reader& in) { in.names("/v"); }), "/v is not a group");
  EXPECT_EQ(refusal([](const Hdf5Reader& in) { in.attribute_int("/v", "x"); }),
            "/v is not a group");
}

TEST_F(HostileHdf5, PipesDevicesAndFoldersAreNotOpened) {
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);  // to open it would wait for a writer
  EXPECT_EQ(refusal([](const Hdf5Reader&) {}), "is not a regular file");
  EXPECT_EQ(error_of<FileError>([] { Hdf5Reader in("/dev/zero"); }),
            "/dev/zero: is not a regular file");
  EXPECT_EQ(error_of<FileError>([this] { Hdf5Reader in(folder.path()); }),
            folder.path().string() + ": is a directory");
}

}  // namespace hagfish::hdf5_hostile_test
