// What a tracker's file says, by whichever program it was written: points by time and number.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "experiments/film/film.hpp"

namespace hagfish {

/// A point at a time, as the file has it.
struct FilmPoint {
  double time = 0;        ///< s
  double number = 0;      ///< number of the point, or its s, in FilmTable::unit
  Eigen::Vector3d place;  ///< NaN where missing, in FilmTable::unit
};

struct FilmTable {
  std::vector<FilmPoint> points;  ///< points in any order
  bool planar = true;
  bool by_arc = false;  ///< numbers are s
  std::string unit;     ///< "cm" or "px"
  bool pixels = false;  ///< points were in px, whatever their unit is now
  std::string format;
};

/// Units of length that columns or --unit may name, each in cm.
inline constexpr std::pair<const char*, double> length_units[] = {
    {"cm", 1}, {"mm", 0.1}, {"m", 100}};

/// Throws as read_film().
FilmTable read_film_table(const std::string& file, const FilmReading& reading);

/// SLEAP's analysis HDF5: `tracks`, `track_names` and `point_scores`, or sleap-anipose's. The axes
/// of `tracks` are those that its attribute `dims` or `Description` names, else individuals x 2 (or
/// 3) x points x frames. Throws as read_film().
FilmTable read_sleap(const std::string& file, const FilmReading& reading);

/// Index of the individual `asked` for, or of the only one. Throws InputError where there is none.
std::size_t chosen_individual(const std::string& file, const std::vector<std::string>& names,
                              const std::string& asked);

/// The time of a film's frame, s. Throws InputError where there is no --fps.
double frame_time(const std::string& file, const FilmReading& reading, double frame);

/// Throws InputError where no --unit says that of a file in space.
void ask_unit(const std::string& file, const FilmReading& reading);

/// cm in a px, or 1 where nothing says it: then `unit` is px.
double pixel_size(const FilmReading& reading, std::string& unit);

}  // namespace hagfish
