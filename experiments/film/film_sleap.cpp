#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/input/input_text.hpp"
#include "core/log/hdf5/hdf5_reader.hpp"
#include "experiments/film/film_table.hpp"

namespace hagfish {

FilmTable read_sleap(const std::string& file, const FilmReading& reading) {
  const Hdf5Reader h5(file);
  const auto fail = [&](const std::string& why) { throw_input_error(file + ": " + why); };
  if (!h5.has("tracks")) fail("has no dataset tracks: is it SLEAP's analysis HDF5?");
  const std::vector<hsize_t> shape = h5.shape("tracks");
  if (shape.size() != 4 || shape[1] < 2 || shape[1] > 3) {
    fail("tracks: must be individuals x 2 (or 3) x points x frames");
  }
  const std::size_t animals = shape[0], dims = shape[1], nodes = shape[2], frames = shape[3];
  if (animals == 0) fail("tracks: holds no animal");
  std::vector<std::string> names;
  if (h5.has("track_names")) names = h5.texts("track_names");
  if (names.size() != animals) {  // of one animal SLEAP may not name it
    names.clear();
    for (std::size_t k = 0; k < animals; ++k) names.push_back(fmt::format("{}", k));
  }
  const std::size_t who = chosen_individual(file, names, reading.individual);
  const std::vector<double> tracks = h5.doubles("tracks");
  std::vector<double> scores;
  if (h5.has("point_scores")) {
    if (h5.shape("point_scores") != std::vector<hsize_t>{animals, nodes, frames}) {
      fail("point_scores: must be individuals x points x frames");
    }
    scores = h5.doubles("point_scores");
  }
  FilmTable table;
  table.format = "SLEAP's analysis HDF5";
  table.pixels = true;
  table.planar = dims == 2;
  table.unit = "cm";
  const double px = pixel_size(reading, table.unit);
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t k = 0; k < nodes; ++k) {
      FilmPoint point{frame_time(file, reading, static_cast<double>(f)), static_cast<double>(k + 1),
                      Eigen::Vector3d::Zero()};
      for (std::size_t d = 0; d < dims; ++d) {
        point.place[static_cast<Eigen::Index>(d)] =
            px * tracks[((who * dims + d) * nodes + k) * frames + f];
      }
      const bool sure =
          scores.empty() || scores[(who * nodes + k) * frames + f] >= reading.likelihood;
      if (!sure || !point.place.allFinite()) {
        point.place.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      table.points.push_back(point);
    }
  }
  return table;
}

}  // namespace hagfish
