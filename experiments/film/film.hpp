// Midlines of an animal as digitised from a film: points along the body through time.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hagfish {

/// One midline. What the film lacks is not here.
struct FilmFrame {
  double time = 0;            ///< s
  std::vector<double> place;  ///< each point's share of the length from the head, 0 to 1, rising
  Eigen::Matrix3Xd point;     ///< the film's unit and axes; z is 0 in two dimensions
};

struct Film {
  std::vector<FilmFrame> frames;  ///< times rising
  bool planar = false;            ///< it has no z
  /// Of the animal, by s, or by the points' distances where there is no s: then a fit finds it.
  double length = 0;
  bool length_known = false;  ///< known by s
  std::string unit = "cm";    ///< unit of points and length: "px" if nothing says their size
  std::string format;         ///< what it was read as, for the user
  std::string turned;         ///< what was done to its axes; empty where nothing was
  std::size_t expected = 0;   ///< points that it would have if none were missing
  std::size_t present() const;
};

/// How a film is to be read.
struct FilmReading {
  double pixels_per_cm = 0;  ///< scale of columns in px; 0 where not given
  double unit_cm = 0;        ///< cm in the unit of columns that name none; 0 where not given
  double fps = 0;            ///< frame rate of films that count frames; 0 where not given
  double likelihood = 0.6;   ///< points that their tracker is less sure of are missing
  double length = 0;         ///< length of the film's animal, cm; 0: its last point is its tail
  double first = 0;          ///< way from the tip of the head to the first of numbered points, cm
  std::string individual;    ///< the one to read in films of several
  bool y_up = false;         ///< y of one camera's px runs up; else down, as rows of images do
  bool y_down = false;       ///< y of all others runs down
};

/// Reads midlines as they come: a table with a row for each time and point (`time_s` or `frame`;
/// `s_cm` or `point`; `x_cm`, `y_cm`, perhaps `z_cm`, or _mm, _m, _px; perhaps `likelihood`,
/// `individual`), with a row for each time ("X NAME", "Y NAME", as EthoVision writes them),
/// DeepLabCut's CSV, DLTdv's xyzpts.csv, Anipose's CSV ("NAME_x", "NAME_y", "NAME_z"; rows are
/// frames), SLEAP's analysis HDF5. Commas, semicolons or tabs; decimal points or commas;
/// rows in any order. Empty cells and words such as NaN are missing, and so are points below the
/// likelihood. A point is where its s or its number says; numbers are even from head to tail, or as
/// far apart as the points are. y is turned in pictures of one camera alone. Throws InputError, one
/// line, for what it cannot read so: columns, units or times that are missing, names found twice,
/// what is no number, one point twice with other numbers, points farther apart than s says, fewer
/// than two midlines or five points; FileError where the file cannot be read.
Film read_film(const std::string& file, const FilmReading& reading);

}  // namespace hagfish
