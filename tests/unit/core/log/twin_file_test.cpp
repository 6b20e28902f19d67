// TwinFile: the file is whole at every moment, and a full disk is found in time.
#include "core/log/twin_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "core/log/hdf5_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::twin_file_test {

namespace fs = std::filesystem;

class TwinFileTest : public testing::Test {
 protected:
  TwinFileTest() { put(file, "one"); }

  static void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string text_of(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  int count_files() const {
    return static_cast<int>(
        std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator{}));
  }

  TemporaryFolder folder;
  fs::path file = folder / "a";
};

TEST_F(TwinFileTest, TheOlderCopyIsChangedAndBecomesTheFile) {
  TwinFile twin(file);
  EXPECT_TRUE(twin.prepare());
  EXPECT_FALSE(twin.prepare());
  for (const char* text : {"two", "three", "four"}) {
    const std::string before = text_of(file);
    const fs::path& next = twin.begin(10);
    EXPECT_GE(fs::file_size(next), 13u) << "room behind what there is";
    put(next, text);
    EXPECT_EQ(text_of(file), before) << "until it is done";
    twin.commit();
    EXPECT_EQ(text_of(file), text);
    EXPECT_EQ(count_files(), 2);
  }
  EXPECT_EQ(text_of(twin.begin(0)), "three");
}

TEST_F(TwinFileTest, OnlyTheFileStays) {
  put(folder / "a.next", "left by a process that was killed");
  {
    TwinFile twin(file);
    EXPECT_EQ(count_files(), 1);
    twin.prepare();
    put(twin.begin(0), "half");
    twin.abandon();
    EXPECT_EQ(count_files(), 1);
    EXPECT_TRUE(twin.prepare());
    EXPECT_EQ(text_of(twin.begin(0)), "one");
  }
  EXPECT_EQ(count_files(), 1);
  EXPECT_EQ(text_of(file), "one");
}

TEST_F(TwinFileTest, WhoHasItOpenKeepsWhatItOpened) {
  TwinFile twin(file);
  twin.prepare();
  std::ifstream reader(file);
  for (const char* text : {"two", "three", "four"}) {
    twin.prepare();
    put(twin.begin(0), text);
    twin.commit();
    EXPECT_EQ(text_of(file), text);
  }
  const std::string read{std::istreambuf_iterator<char>(reader), {}};
  EXPECT_EQ(read, "one");
  EXPECT_EQ(count_files(), 2);
}

TEST_F(TwinFileTest, AFullDiskIsFoundBeforeAnythingIsChanged) {
  // In a child: a limit on file size stands for a full disk and cannot be taken back.
  const auto fill = [&] {
    const rlimit limit{100000, 100000};
    std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    TwinFile twin(file);
    twin.prepare();
    try {
      twin.begin(200000);
    } catch (const FileError& error) {
      fprintf(stderr, "%s\n", error.what());
      std::_Exit(fs::exists(folder / "a.next") ? 2 : 1);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(fill(), testing::ExitedWithCode(1), "/a: cannot be saved: File too large");
  EXPECT_EQ(text_of(file), "one");
}

TEST_F(TwinFileTest, AFileThatIsGoneIsTold) {
  TwinFile twin(file);
  fs::remove(file);
  EXPECT_THROW(twin.prepare(), FileError);
  put(file, "one");
  twin.prepare();
  twin.begin(0);
  fs::remove(file);
  EXPECT_THROW(twin.commit(), FileError);
}

}  // namespace hagfish::twin_file_test
