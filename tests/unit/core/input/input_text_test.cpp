#include "core/input/input_text.hpp"
#include "core/input/files/text_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::input_text_test {

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

TEST(Printable, LeavesTextAloneAndShowsOtherBytes) {
  for (const std::string text : {"", "plain", "q\u0307 \u00e9 \u20ac \U0001F40D", "back\\slash"}) {
    EXPECT_EQ(printable(text), text);
  }
  EXPECT_EQ(printable("a\x1b]0;b\x07\r\n\t\x7f"), "a\\x1b]0;b\\x07\\x0d\\x0a\\x09\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"
                      "1m"),
            "\\xc2\\x9b1m")
      << "U+009B begins a command too";
  EXPECT_EQ(printable("\x9b\xff\xc3"), "\\x9b\\xff\\xc3") << "no UTF-8";
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82") << "half a character";
}

TEST(Printable, CutsAndCounts) {
  EXPECT_EQ(printable(std::string(2000, 'a')), std::string(2000, 'a'));
  EXPECT_EQ(printable(std::string(60000, 'a')), std::string(2000, 'a') + "... (58000 more bytes)");
}

TEST(ReadTextFile, RefusesWhatIsNoFileOrTooLarge) {
  EXPECT_EQ(error_of([] { read_text_file("/dev/zero"); }), "/dev/zero: is not a regular file");
  const TemporaryFolder folder;
  const std::string size = std::to_string(1 << 20);
  const std::string full = folder.write("full.toml", std::string(1 << 20, '#'));
  EXPECT_EQ(read_text_file(full).size(), std::size_t{1} << 20);
  const std::string more = folder.write("more.toml", std::string((1 << 20) + 1, '#'));
  EXPECT_EQ(error_of([&] { read_text_file(more); }), more + ": is larger than " + size + " bytes");
}

}  // namespace hagfish::input_text_test
