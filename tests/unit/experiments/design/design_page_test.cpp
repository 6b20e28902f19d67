// What is told of a found program says which law and which runs its counts are of.
#include "experiments/design/design_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/input/csv/delimited_text.hpp"
#include "core/input/files/scene_reader.hpp"

namespace hagfish::design_page_test {

/// A candidate whose counts all differ.
DesignOutcome outcome() {
  Candidate best;
  best.number = 7;
  best.judged = 20;
  best.slower = 1.5;
  std::ranges::copy(std::array{20, 19}, best.passed);
  std::ranges::copy(std::array{8, 9}, best.animals);
  DesignOutcome outcome;
  outcome.best = best;
  return outcome;
}

/// A field of the only row, by its heading.
std::string field(const std::string& csv, const std::string& name) {
  const DelimitedText table(csv);
  for (std::size_t k = 0; k < table.cells(0); ++k) {
    if (table.cell(0, k) == name) return std::string(table.cell(1, k));
  }
  return "no such column";
}

TEST(DesignRow, HasTheCountsOfEachLaw) {
  DesignOptions options;
  const auto of = [&](const char* name) { return field(design_row(options, outcome(), {}), name); };
  EXPECT_EQ(of("slower"), "1.5");
  EXPECT_EQ(of("starts_by_eq6"), "20");
  EXPECT_EQ(of("starts_by_reflex"), "19");
  EXPECT_EQ(of("animals_by_eq6"), "");
  options.animals = true;
  EXPECT_EQ(of("animals_by_eq6"), "8");
  EXPECT_EQ(of("animals_by_reflex"), "9");
}

TEST(DesignPage, HasTheCountsOfEachLaw) {
  const ResolvedScene scene = read_scene_text("base = \"living_overhand\"\n", "design");
  DesignOptions options;
  const auto page = [&] { return design_page(options, outcome(), scene, {}, ""); };
  EXPECT_EQ(page().find("Other animals"), std::string::npos);
  options.animals = true;
  EXPECT_NE(page().find("| Eq. 6 | 20 of 20 |\n| reflex | 19 of 20 |"), std::string::npos);
  EXPECT_NE(page().find("over that of the soft body | 1.5 |"), std::string::npos);
  EXPECT_NE(page().find("--out reflex.h5 --set \"controller.law=reflex\" --set"),
            std::string::npos);
  EXPECT_NE(
      page().find("Other animals are 0.6 to 1.4 times as long. Their girth for the length and "
                  "their limits are changed by up to 20 %."),
      std::string::npos);
  EXPECT_NE(page().find("| Eq. 6 | 8 of 10 |\n| reflex | 9 of 10 |"), std::string::npos);
}

TEST(DesignPage, SaysOfAFoundKnotAloneThatItIsAudited) {
  const ResolvedScene scene = read_scene_text("base = \"living_overhand\"\n", "design");
  const std::string said = "succeeds at steps of 1 and 2 ms, too. Its log passes `hagfish check`.";
  DesignOutcome of = outcome();
  EXPECT_EQ(design_page({}, of, scene, {}, "").find(said), std::string::npos);
  of.found = true;
  EXPECT_NE(design_page({}, of, scene, {}, "").find(said), std::string::npos);
}

TEST(DesignPage, ShowsTheStripOfWhatHappened) {
  const ResolvedScene scene = read_scene_text("base = \"living_overhand\"\n", "design");
  RunSummary run;
  run.slide_from = 12;
  run.release_from = 20;
  EXPECT_EQ(strip_times(run), (std::vector<double>{3, 6, 9, 12, 20}));  // it never came off
  const std::string page = design_page({}, outcome(), scene, run, "strip.png");
  EXPECT_NE(page.find("](strip.png)"), std::string::npos);
  EXPECT_NE(page.find(" --time 12.00 --time 20.00\n"), std::string::npos);
}

}  // namespace hagfish::design_page_test
