// A file under way: who may make it, what is left of it, and which name it gets.
#include "core/log/hdf5/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "tests/support/temporary_folder.hpp"

namespace hagfish::output_file_test {

namespace fs = std::filesystem;

void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What the reservation or `work` with it complains of.
template <class Work>
std::string complaint(const fs::path& file, bool replace, Work work) {
  try {
    OutputFile output(file, replaced_if(replace));
    work(output);
  } catch (const FileError& error) {
    return error.what();
  }
  return "nothing";
}
std::string complaint(const fs::path& file, bool replace) {
  return complaint(file, replace, [](OutputFile&) {});
}

class OutputFileTest : public testing::Test {
 protected:
  TemporaryFolder folder;
  fs::path file = folder / "run.h5";
  fs::path part = folder / "run.h5.part";
  fs::path lock = folder / "run.h5.lock";
};

TEST_F(OutputFileTest, NeedsAName) {
  EXPECT_EQ(complaint("", false), "'': names no file to write");
  EXPECT_EQ(complaint(folder / "new/", false),
            "'" + (folder / "new/").string() + "': names no file to write");
}

TEST_F(OutputFileTest, GetsItsNameWhenItIsWhole) {
  {
    OutputFile output(file, Existing::refuse);
    EXPECT_EQ(output.partial(), part);
    put(output.partial(), "whole");
    EXPECT_FALSE(fs::exists(file));
    output.publish();
  }
  EXPECT_EQ(text_of(file), "whole");
  EXPECT_FALSE(fs::exists(part));
  EXPECT_FALSE(fs::exists(lock));
}

TEST_F(OutputFileTest, KeepsWhatIsThereUnlessAsked) {
  put(file, "precious");
  EXPECT_EQ(complaint(file, false), file.string() + ": already exists (--force replaces it)");
  EXPECT_EQ(complaint(file, true,
                      [](OutputFile& output) {
                        put(output.partial(), "new");
                        output.publish();
                      }),
            "nothing");
  EXPECT_EQ(text_of(file), "new");
}

TEST_F(OutputFileTest, KeepsWhatACrashLeftUnlessAsked) {
  put(part, "680 frames");
  put(lock, "");  // of a process that is gone
  EXPECT_EQ(complaint(file, false).find(part.string() + ": left by a run that was interrupted"),
            0u);
  EXPECT_EQ(text_of(part), "680 frames");
  EXPECT_FALSE(fs::exists(lock));
  EXPECT_EQ(complaint(file, true), "nothing");
}

TEST_F(OutputFileTest, IsMadeByOneProcessAtATime) {
  const OutputFile output(file, Existing::replace);
  const pid_t child = fork();
  if (child == 0) {
    const bool refused =
        complaint(file, true) == file.string() + ": is being made by another process";
    std::_Exit(refused ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(fs::exists(lock)) << "the other one removed the lock";
}

TEST_F(OutputFileTest, DoesNotReplaceAFileThatAppearedMeanwhile) {
  const std::string message = complaint(file, false, [this](OutputFile& output) {
    put(output.partial(), "mine");
    put(file, "theirs");
    output.publish();
  });
  EXPECT_EQ(
      message,
      file.string() +
          ": another program created this file during the run; the output of this run is in " +
          part.string());
  EXPECT_EQ(text_of(file), "theirs");
  EXPECT_EQ(text_of(part), "mine");
}

TEST_F(OutputFileTest, FollowsSymbolicLinks) {
  const fs::path link = folder / "link.h5";
  fs::create_symlink("run.h5", link);
  {
    OutputFile output(link, Existing::refuse);
    put(output.partial(), "through the link");
    output.publish();
  }
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(text_of(file), "through the link");
  EXPECT_FALSE(complaint(link, false) == "nothing");
}

TEST_F(OutputFileTest, NamesAFolderThatTakesNoFiles) {
  const fs::path missing = folder / "missing/run.h5";
  EXPECT_EQ(complaint(missing, false),
            missing.string() + ": cannot be created: No such file or directory");
  EXPECT_EQ(complaint(folder.path(), true), folder.path().string() + ": is not a regular file");
}

}  // namespace hagfish::output_file_test
