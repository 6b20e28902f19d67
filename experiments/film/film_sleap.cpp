#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_reader.hpp"
#include "experiments/film/film_table.hpp"

namespace hagfish {
namespace {

enum TrackAxis : std::size_t { track, coordinate, node, frame, axes };
using Places =
    std::array<std::size_t, axes>;  // of each axis in a dataset; `axes` where it has none

/// Places that a dataset's words name; `usual` where it has no such words.
Places places_of(const Hdf5Reader& h5, const std::string& path, const Places& usual) {
  const auto words = h5.words(path);
  auto named = words.find("dims");                              // SLEAP's
  if (named == words.end()) named = words.find("Description");  // sleap-anipose's
  if (named == words.end()) return usual;
  const std::string& text = named->second;
  Places places;
  places.fill(axes);
  std::size_t from = 0;
  for (std::size_t k = 0; k < h5.shape(path).size(); ++k) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    const std::string word = text.substr(from, end - from);
    const auto says = [&](const char* name) { return word.find(name) != word.npos; };
    places[says("track") ? track : says("node") ? node : says("frame") ? frame : coordinate] = k;
    from = std::min(end + 1, text.size());
  }
  return places;
}

/// Place of a value among all of a dataset's.
std::size_t index_of(const std::vector<hsize_t>& shape, const Places& places, const Places& at) {
  std::array<std::size_t, axes + 1> by_place{};
  for (std::size_t axis = 0; axis < axes; ++axis) by_place[places[axis]] = at[axis];
  std::size_t index = 0;
  for (std::size_t k = 0; k < shape.size(); ++k) index = index * shape[k] + by_place[k];
  return index;
}

}  // namespace

FilmTable read_sleap(const std::string& file, const FilmReading& reading) {
  const Hdf5Reader h5(file);
  const auto fail = [&](const std::string& why) { throw_input_error(file + ": " + why); };
  if (!h5.has("tracks")) {
    fail("has no dataset tracks: is it SLEAP's analysis HDF5? Of DeepLabCut give the CSV");
  }
  const std::vector<hsize_t> shape = h5.shape("tracks");
  const Places unnamed = {0, 1, 2, 3};
  const Places places = shape.size() == axes ? places_of(h5, "tracks", unnamed) : unnamed;
  const auto is_space = [](std::size_t size) { return size == 2 || size == 3; };
  // Of two axes that may be x and y, a file without names does not say which.
  if (shape.size() != axes || std::ranges::count(places, axes) > 0 ||
      !is_space(shape[places[coordinate]]) || (places == unnamed && is_space(shape[frame]))) {
    fail(
        "tracks: must be individuals x 2 (or 3) x points x frames, or name its axes in an "
        "attribute dims");
  }
  Places size;
  for (std::size_t axis = 0; axis < axes; ++axis) size[axis] = shape[places[axis]];
  if (size[track] == 0) fail("tracks: holds no animal");
  std::vector<std::string> names;
  if (h5.has("track_names")) names = h5.texts("track_names");
  if (names.size() != size[track]) {  // of one animal SLEAP may not name it
    names.clear();
    for (std::size_t k = 0; k < size[track]; ++k) names.push_back(fmt::format("{}", k));
  }
  const std::size_t who = chosen_individual(file, names, reading.individual);
  const std::vector<double> tracks = h5.doubles("tracks");
  std::vector<double> scores;
  std::vector<hsize_t> scores_shape;
  Places scores_places = places;
  if (h5.has("point_scores")) {
    for (std::size_t& place : scores_places) place -= place > places[coordinate] ? 1 : 0;
    scores_places[coordinate] = axes;
    scores_places = places_of(h5, "point_scores", scores_places);
    scores_shape = h5.shape("point_scores");
    for (const std::size_t axis : {track, node, frame}) {
      if (scores_shape.size() != axes - 1 || scores_places[axis] >= scores_shape.size() ||
          scores_shape[scores_places[axis]] != size[axis]) {
        fail("point_scores: must be individuals x points x frames, as tracks has them");
      }
    }
    scores = h5.doubles("point_scores");
  }
  FilmTable table;
  table.format = "SLEAP's analysis HDF5";
  table.planar = size[coordinate] == 2;
  if (!table.planar) ask_unit(file, reading);
  table.pixels = reading.unit_cm <= 0;
  table.unit = "cm";
  const double unit = table.pixels ? pixel_size(reading, table.unit) : reading.unit_cm;
  for (std::size_t f = 0; f < size[frame]; ++f) {
    for (std::size_t k = 0; k < size[node]; ++k) {
      FilmPoint point{frame_time(file, reading, static_cast<double>(f)), static_cast<double>(k + 1),
                      Eigen::Vector3d::Zero()};
      for (std::size_t d = 0; d < size[coordinate]; ++d) {
        point.place[static_cast<Eigen::Index>(d)] =
            unit * tracks[index_of(shape, places, {who, d, k, f})];
      }
      const bool sure =
          scores.empty() ||
          scores[index_of(scores_shape, scores_places, {who, 0, k, f})] >= reading.likelihood;
      if (!sure || !point.place.allFinite()) {
        point.place.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      table.points.push_back(point);
    }
  }
  return table;
}

}  // namespace hagfish
