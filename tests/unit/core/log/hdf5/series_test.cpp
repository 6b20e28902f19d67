// Series: rows come out as those that were appended, whatever was saved when.
#include "core/log/hdf5/series.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <stdexcept>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/log/log_table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::series_test {

using Shape = std::vector<hsize_t>;

template <class T>
void append_value(Series& series, T value) {
  series.append(&value, sizeof value);
}

/// One series of each kind in a file.
class SeriesTest : public testing::Test {
 protected:
  SeriesTest() {
    Hdf5Writer h5;
    for (Series* s : all) {
      s->create(h5);
    }
    h5.save(file);
  }

  /// Row k of each.
  void append(int k) {
    std::vector<double> row(600);
    std::iota(row.begin(), row.end(), 600.0 * k);
    dense.append(row.data(), 6 * sizeof(double));
    sparse.append(row.data(), row.size() * sizeof(double));
    blocks.append(row.data(), 70 * sizeof(double));
    append_value(ints, std::int32_t{-k});
    append_value(longs, std::int64_t{k} << 33);
    append_value(choices, static_cast<std::uint8_t>(k % 3));
  }

  void save() {
    std::size_t room = 65536;
    for (Series* s : all) room += s->room();
    const auto before = std::filesystem::file_size(file);
    Hdf5Writer h5(file);
    for (Series* s : all) s->write(h5);
    h5.close();
    EXPECT_LE(std::filesystem::file_size(file), before + room);
    for (Series* s : all) s->written();
  }

  /// Rows 0 to `count` - 1 are in the file, and no others.
  void expect_rows(int count) const {
    const Hdf5Reader in(file);
    const auto rows = static_cast<hsize_t>(count);
    ASSERT_EQ(in.shape("/a/dense"), (Shape{rows, 2, 3}));
    ASSERT_EQ(in.shape("/a/b/sparse"), (Shape{rows, 600}));
    ASSERT_EQ(in.shape("/a/blocks"), (Shape{rows, 70}));
    for (const char* path : {"/ints", "/longs", "/choices"}) {
      ASSERT_EQ(in.shape(path), Shape{rows}) << path;
    }
    const auto dense_rows = in.rows("/a/dense");
    const auto sparse_rows = in.rows("/a/b/sparse");
    const auto rows_of_blocks = in.rows("/a/blocks");
    const auto small = in.integers("/ints");
    const auto large = in.integers("/longs");
    const auto chosen = in.integers("/choices");
    for (int k = 0; k < count; ++k) {
      EXPECT_EQ(dense_rows.row(k), Eigen::RowVectorXd::LinSpaced(6, 600 * k, 600 * k + 5)) << k;
      EXPECT_EQ(sparse_rows.row(k), Eigen::RowVectorXd::LinSpaced(600, 600 * k, 600 * k + 599))
          << k;
      EXPECT_EQ(rows_of_blocks.row(k), Eigen::RowVectorXd::LinSpaced(70, 600 * k, 600 * k + 69))
          << k;
      EXPECT_EQ(small[k], -k);
      EXPECT_EQ(large[k], std::int64_t{k} << 33);
      EXPECT_EQ(chosen[k], k % 3);
    }
  }

  static SeriesLayout chunked(SeriesLayout layout) {
    layout.chunk_rows = 7;
    return layout;
  }

  TemporaryFolder folder;
  std::filesystem::path file = folder / "a.h5";
  Series dense{chunked(layout_of("/a/dense", {2, 3}, {"1", "rows of six"}, stored_type<double>()))};
  Series sparse{layout_of("/a/b/sparse", {600}, {"dyn", "compressed", Storage::packed},
                          stored_type<double>())};
  Series blocks{chunked(
      layout_of("/a/blocks", {70}, {"dyn", "blocks", Storage::blocks}, stored_type<double>()))};
  Series ints{chunked(layout_of("/ints", {}, {"1", "ints"}, stored_type<std::int32_t>()))};
  Series longs{layout_of("/longs", {}, {"1", "longs"}, stored_type<std::int64_t>())};
  Series choices{layout_of("/choices", {}, {"1", "c"}, choice_type({"zero", "one", "two"}))};
  std::vector<Series*> all = {&dense, &sparse, &blocks, &ints, &longs, &choices};
};

TEST_F(SeriesTest, EverySaveHasAllRowsSoFar) {
  expect_rows(0);
  std::mt19937 random(1);
  int count = 0;
  for (int k = 0; k < 25; ++k) {
    for (auto more = random() % 12; more > 0; --more) {
      append(count++);
    }
    save();
    expect_rows(count);
  }
}

// Chunks of zeros are not written: the rows read as 0 wherever saves fall, and take no room.
TEST_F(SeriesTest, RowsOfZerosComeBack) {
  std::mt19937 random(2);
  std::vector<double> expected;
  bool zero = true;
  for (int k = 0; k < 200; ++k) {
    if (random() % 9 == 0) zero = !zero;
    std::vector<double> row(600, zero ? 0.0 : k);
    expected.push_back(row[0]);
    dense.append(row.data(), 6 * sizeof(double));
    sparse.append(row.data(), row.size() * sizeof(double));
    if (random() % 5 == 0) save();
  }
  save();
  const Hdf5Reader in(file);
  for (const char* path : {"/a/dense", "/a/b/sparse"}) {
    const Hdf5Reader::Rows rows = in.rows(path);
    ASSERT_EQ(rows.rows(), static_cast<Eigen::Index>(expected.size()));
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      EXPECT_TRUE((rows.row(k).array() == expected[static_cast<std::size_t>(k)]).all())
          << path << " " << k;
    }
  }
}

TEST_F(SeriesTest, ZerosTakeNoRoom) {
  constexpr int rows = 7000;  // of six numbers
  const auto size_after = [&](double value) {
    const std::vector<double> row(6, value);
    for (int k = 0; k < rows; ++k) dense.append(row.data(), row.size() * sizeof(double));
    save();
    return std::filesystem::file_size(file);
  };
  const auto zeros = size_after(0);
  EXPECT_LE(zeros, rows * 6 * sizeof(double) / 2);
  EXPECT_GE(size_after(1), zeros + rows * 6 * sizeof(double));
}

// Of a force that acts on some columns, only these are stored, wherever saves fall.
TEST_F(SeriesTest, ColumnsOfZerosTakeNoRoomInBlocks) {
  constexpr int rows = 700, columns = 70, acting = 50;  // of three blocks, the last one acts
  const auto size_after = [&](double elsewhere) {
    std::vector<double> row(columns, elsewhere);
    for (int k = 0; k < rows; ++k) {
      row[acting] = k + 1;
      blocks.append(row.data(), row.size() * sizeof(double));
      if (k % 100 == 0) save();
    }
    save();
    return std::filesystem::file_size(file);
  };
  const auto before = std::filesystem::file_size(file);
  const auto sparse_size = size_after(0) - before;
  {
    const Hdf5Reader in(file);
    const Hdf5Reader::Rows read = in.rows("/a/blocks");
    for (Eigen::Index k = 0; k < rows; ++k) {
      EXPECT_EQ(read(k, acting), static_cast<double>(k + 1));
      EXPECT_EQ(read.row(k).cwiseAbs().sum(), read(k, acting)) << k;
    }
  }
  EXPECT_GE(size_after(1) - before - sparse_size, 2 * sparse_size);
}

TEST_F(SeriesTest, ATableHasNoRowOfWhichAColumnThrows) {
  LogTable<int> table({.level = LogLevel::full, .labels = "", .chunk_rows = 4});
  table.number("/steps/kkt", {"1", "first"}, [](int k) { return 1.0 * k; });
  table.count("/steps/rows", "second", [](int k) {
    if (k == 2) throw std::runtime_error("no such row");
    return k;
  });
  for (int k = 0; k < 2; ++k) table.append(k);
  EXPECT_THROW(table.append(2), std::runtime_error);
  for (const auto& series : table.series()) EXPECT_EQ(series->rows(), 2u) << series->layout().path;
  table.append(3);
  for (const auto& series : table.series()) EXPECT_EQ(series->rows(), 3u) << series->layout().path;
}

TEST_F(SeriesTest, RefusesRowsOfAnotherSize) {
  const std::vector<double> row(2);
  EXPECT_THROW(dense.append(row.data(), row.size() * sizeof(double)), std::logic_error);
  EXPECT_THROW(append_value(dense, 1.0), std::logic_error);
}

// A row of two axes would be told to be zero by its last axis alone, and left out.
TEST(SeriesLayout, BlocksAreOfRowsOfOneAxis) {
  const Meaning blocks{"1", "", Storage::blocks};
  EXPECT_NO_THROW(layout_of("/a", {70}, blocks, stored_type<double>()));
  EXPECT_THROW(layout_of("/a", {70, 3}, blocks, stored_type<double>()), std::logic_error);
}

}  // namespace hagfish::series_test
