// A search for a knot: it repeats whatever the threads, goes on where it was, and refuses what
// cannot be.
#include "experiments/design/design.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "core/input/files/scene_reader.hpp"
#include "core/input/files/text_file.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "experiments/design/length_bound.hpp"
#include "experiments/design/living_body.hpp"
#include "experiments/design/tries.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::design_test {

namespace fs = std::filesystem;

std::vector<std::string> sorted_lines(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::ranges::sort(lines);
  return lines;
}

/// One batch in search of a knot that it will not tie.
DesignOptions one_batch(const fs::path& folder, int threads) {
  DesignOptions options;
  options.knot = "7_7";
  options.folder = folder;
  options.budget = 1e-6;
  options.threads = threads;
  options.interrupted = [] { return false; };
  options.progress = [](const std::string&) {};
  return options;
}

/// One batch by one thread, in the folder `one`.
class OneBatch : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder.emplace();
    one = design(one_batch(folder->path() / "one", 1));
  }
  static void TearDownTestSuite() { folder.reset(); }

  static inline std::optional<TemporaryFolder> folder;
  static inline DesignOutcome one;
};

TEST_F(OneBatch, TriesAreTheSameWhateverTheThreadsAndStops) {
  EXPECT_FALSE(one.found);
  EXPECT_EQ(one.tries, batch_size);
  const std::vector<std::string> lines = sorted_lines(folder->path() / "one/tries.csv");
  EXPECT_EQ(lines.size(), batch_size);

  const fs::path three = folder->path() / "three";
  design(one_batch(three, 3));
  EXPECT_EQ(sorted_lines(three / "tries.csv"), lines);

  // Two lines of it are lost, one of them in part.
  std::ofstream cut(three / "tries.csv");
  for (std::size_t k = 0; k + 2 < lines.size(); ++k) cut << lines[k] << "\n";
  cut << lines.back().substr(0, lines.back().size() / 2);
  cut.close();
  EXPECT_THROW(design(one_batch(three, 1)), FileError);
  DesignOptions again = one_batch(three, 1);
  again.resume = true;
  std::ofstream(three / "times.csv") << "1000.0,2000.0\n3000.0,40";
  const DesignOutcome mended_one = design(again);
  EXPECT_EQ(mended_one.in_words(), one.in_words());
  EXPECT_GE(mended_one.time.wall, 1000);
  EXPECT_GE(mended_one.time.cpu, 2000);
  EXPECT_LT(mended_one.time.wall, 3000);
  const std::string times = read_text_file((three / "times.csv").string());
  EXPECT_TRUE(
      times.ends_with(fmt::format("\n{:.1f},{:.1f}\n", mended_one.time.wall, mended_one.time.cpu)));
  const std::vector<std::string> mended = sorted_lines(three / "tries.csv");
  EXPECT_TRUE(std::ranges::includes(mended, lines));
  again.seed = 2;
  EXPECT_THROW(design(again), FileError);
}

TEST(Design, ForOtherAnimalsTheThickestOfTheseIsLedByTurns) {
  const TemporaryFolder folder;
  DesignOptions options = one_batch(folder.path(), 1);
  options.animals = true;
  options.interrupted = [&] { return sorted_lines(folder.path() / "tries.csv").size() >= 4; };
  design(options);
  const SoftBody own = soft_body("");
  const SoftBody thickest = soft_body(other_animal(own.specimen, thickest_animal));
  const Archive archive(options.seed, options.knot);
  bool differs = false;  // turns about strands do; others are laid beforehand
  for (const std::string& line : sorted_lines(folder.path() / "tries.csv")) {
    const int number = std::stoi(line);
    const auto path_in = [&](const SoftBody& body) {
      Draw draw(options.seed + 1, static_cast<unsigned>(number));
      const Tying tying =
          *try_plan(body, archive.plan_of(number), options.knot, draw, [] { return false; });
      return tying_text({.seen = {}, .path = tying.path});
    };
    const std::string path =
        tying_text({.seen = {}, .path = tying_of(line.substr(line.find(',') + 1))->path});
    EXPECT_EQ(path, path_in(number % 2 == 0 ? own : thickest));
    differs |= path != path_in(number % 2 == 0 ? thickest : own);
  }
  EXPECT_TRUE(differs);
}

TEST_F(OneBatch, IsWhatAnotherSearchStartsFrom) {
  DesignOptions options = one_batch(folder->path() / "second", 2);
  options.seed = 3;
  options.start = folder->path() / "one";
  EXPECT_EQ(design(options).tries, batch_size);
  const std::vector<std::string> lines = sorted_lines(options.folder / "tries.csv");
  // Its own tries are numbered behind those; some of them go on from what was seen there.
  EXPECT_EQ(std::ranges::count_if(
                lines, [](const std::string& line) { return std::stoi(line) < batch_size; }),
            0);
  options.resume = true;
  options.start.clear();
  design(options);
  EXPECT_EQ(sorted_lines(options.folder / "tries.csv"), lines);
  options = one_batch(folder->path() / "third", 2);
  options.start = folder->path() / "none";
  EXPECT_THROW(design(options), FileError);
  EXPECT_FALSE(fs::exists(options.folder / "search.toml"));
}

TEST(Design, InterruptedSearchKeepsItsTries) {
  const TemporaryFolder folder;
  DesignOptions options = one_batch(folder.path() / "stopped", 1);
  int asked = 0;
  options.interrupted = [&asked] { return ++asked > 2000; };
  const DesignOutcome outcome = design(options);
  EXPECT_TRUE(outcome.interrupted);
  const std::size_t kept = sorted_lines(folder.path() / "stopped/tries.csv").size();
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, batch_size);
}

/// The file of an animal three times as thick.
std::string thick_text() {
  std::string text = read_text_file(HAGFISH_DATA_DIR "/specimens/pacific_hagfish.toml");
  const std::string girth = "[5.6, 5.5, 5.6, 4.3]";
  return text.replace(text.find(girth), girth.size(), "[16.8, 16.5, 16.8, 12.9]");
}

TEST(Design, AnimalTooShortIsRefusedWithTheLengthItNeeds) {
  const Specimen table1 = read_specimen(HAGFISH_DATA_DIR "/specimens/pacific_hagfish.toml");
  EXPECT_EQ(too_short_for(table1, "4_1"), "");
  Specimen thick = table1;
  for (double& around : thick.circumference) around *= 3;
  const std::string why = too_short_for(thick, "4_1");
  EXPECT_TRUE(why.starts_with("4_1 needs at least 62.")) << why;
  EXPECT_TRUE(why.ends_with("yours has 42.4")) << why;
  const TemporaryFolder folder;
  DesignOptions options = one_batch(folder.path() / "short", 1);
  options.specimen = thick_text();
  EXPECT_THROW(design(options), InputError);
  EXPECT_FALSE(fs::exists(options.folder));
  EXPECT_DOUBLE_EQ(*least_diameters("3_1#-4_1"), *least_diameters("3_1") + *least_diameters("4_1"));
  EXPECT_FALSE(least_diameters("det=9,v2=10"));
}

TypeSeen seen(const KnotInvariants& type, double from, double to) {
  return {.type = type, .from = from, .to = to};
}

TEST(Design, TyingsAreReadBackAsTheyWereWritten) {
  Tying tying;
  tying.seen = {seen({}, 0, 8.4), seen({3, 1}, 8.8, 11.2), seen({9, 2}, 11.6, 13.2)};
  tying.seen[1].at = 9.6;
  tying.seen[1].left = 0.2;
  tying.seen[1].repeats = true;
  tying.path.swing = {{0, {1, 0, 0}}, {4.5, {0.1, 0.2, 1.0 / 3}}};
  tying.path.pull = {{13.2, {0, 0, 0}}};
  const std::string text = tying_text(tying);
  const std::optional<Tying> back = tying_of(text);
  ASSERT_TRUE(back);
  EXPECT_EQ(tying_text(*back), text);
  EXPECT_EQ(*back->tied(), (KnotInvariants{9, 2}));
  for (std::size_t cut = 0; cut < text.size(); ++cut) EXPECT_FALSE(tying_of(text.substr(0, cut)));
  tying.failed = true;
  EXPECT_FALSE(tying_of(tying_text(tying))->tied());
}

/// A try on which that type was seen, with so much of the tail left. Paths differ by number.
Tying tying_with(const KnotInvariants& type, double left, unsigned number) {
  Draw draw(2, number);  // other paths than the archive's
  Tying tying;
  tying.path.swing = random_plan(draw).path.swing;
  tying.path.turns = {
      {5, {0.3, 0.1, 0}}, {6, {0.3, 0, 0.1}}, {7, {0.3, -0.1, 0}}, {8, {0.3, 0, -0.1}}};
  tying.seen = {seen({}, 0, 4), seen(type, 4.4, 6)};
  tying.seen[1].at = 4.8;
  tying.seen[1].left = left;
  tying.seen[1].repeats = true;
  return tying;
}

/// How many of a thousand plans go on from that try.
int led_on(const Archive& archive, const Tying& tying, int first) {
  int count = 0;
  for (int number = first; number < first + 1000; ++number) {
    const PathPlan plan = archive.plan_of(number);
    count += plan.path.swing.back().place == tying.path.swing.back().place ? 1 : 0;
  }
  return count;
}

TEST(Design, OnlyTypesOfFewerCrossingsThanWantedAreLedOnFrom) {
  const Tying tying = tying_with({7, 2}, 0.2, 1);
  Archive four(1, "4_1"), five(1, "5_1"), six(1, "6_1");
  four.add(0, {}, tying);
  five.add(0, {}, tying);
  six.add(0, {}, tying);
  EXPECT_EQ(led_on(four, tying, 1), 0);
  EXPECT_EQ(led_on(five, tying, 1), 0);
  EXPECT_GT(led_on(six, tying, 1), 500);
}

TEST(Design, ASumIsTiedFromItsSummands) {
  const Tying trefoil = tying_with({3, 1}, 0.2, 1), other = tying_with({5, -1}, 0.3, 2);
  Archive square(1, "3_1#-3_1");
  square.add(0, {}, trefoil);
  square.add(1, {}, other);
  EXPECT_GT(led_on(square, trefoil, 2), 500);
  EXPECT_EQ(led_on(square, other, 2), 0);
}

TEST(Design, PathsThatLeaveMostOfTheTailAreKept) {
  Archive archive(1, "6_1");
  const Tying least = tying_with({7, 2}, 0.1, 0);
  archive.add(0, {}, least);
  for (int number = 1; number <= 200; ++number) {
    archive.add(number, {}, tying_with({7, 2}, 0.2, static_cast<unsigned>(number)));
  }
  const Tying most = tying_with({7, 2}, 0.3, 201);
  archive.add(201, {}, most);
  EXPECT_EQ(led_on(archive, least, 300), 0);
  EXPECT_GT(led_on(archive, most, 300), 0);
}

TEST(Design, PathsThatTheLivingBodyDoesNotRepeatAreNotKept) {
  Archive archive(1, "6_1");
  Tying tying = tying_with({7, 2}, 0.2, 1);
  EXPECT_TRUE(archive.would_keep(tying.path, tying.seen[1]));
  tying.seen[1].repeats = false;
  archive.add(0, {}, tying);
  EXPECT_EQ(led_on(archive, tying, 1), 0);
  tying.seen[1].repeats = true;
  archive.add(1, {}, tying);
  EXPECT_GT(led_on(archive, tying, 2), 500);
  // It is there already.
  EXPECT_FALSE(archive.would_keep(tying.path, tying.seen[1]));
}

TEST(Design, PathsWhoseProgramsFailAreLedOnFromLessOften) {
  Archive archive(1, "6_1");
  const Tying bad = tying_with({7, 2}, 0.2, 1), good = tying_with({7, 2}, 0.2, 2),
              of_bad = tying_with({5, -1}, 0.2, 3);
  PathPlan from_bad;
  from_bad.parent = 0;
  archive.add(0, {}, bad);
  archive.add(1, {}, good);
  archive.add(2, from_bad, of_bad);
  for (int k = 0; k < 10; ++k) archive.judged(2, 0);
  const int seldom = led_on(archive, bad, 10);
  EXPECT_GT(seldom, 0);
  EXPECT_GT(led_on(archive, good, 10), 5 * seldom);
  archive.judged(2, 30);  // of 40 runs
  EXPECT_GT(led_on(archive, bad, 10), led_on(archive, good, 10));
}

TEST(Design, PathsThatTiedTheKnotAreDisplaced) {
  Draw draw(1, 1);
  TailPath path = random_plan(draw).path;
  path.turns = {{5, {0.3, 0.1, 0}}};
  path.pull = {{6, {0.3, 0.1, 0.1}}, {7, {0.3, 0.1, 0.2}}};
  Archive archive(1, "3_1");
  Tying tying;
  tying.seen = {seen({}, 0, 4), seen({3, 1}, 4.4, 7)};
  tying.path = path;
  archive.add(0, {}, tying);
  int displaced = 0;
  for (int number = 1; number <= 100; ++number) {
    const TailPath tried = archive.plan_of(number).path;
    if (tried.pull.empty()) continue;
    ++displaced;
    EXPECT_LT((tried.turns[0].place - path.turns[0].place).norm(), 0.1);
  }
  EXPECT_GT(displaced, 30);
}

}  // namespace hagfish::design_test
