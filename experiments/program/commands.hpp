// The subcommands of `hagfish`. Each returns the program's exit code: 0 done, 1 the run or the
// audit failed, 2 bad input (thrown as InputError or FileError, or returned), 3 the knot is not the
// scene's.
#pragma once

#include <string>
#include <vector>

namespace hagfish {

inline constexpr const char* default_scene = "table1";

struct RunOptions {
  std::string scene = default_scene;  ///< a built-in scene's name or a file
  std::string out;                    ///< log to write; SCENE.h5 where empty
  std::string preset;                 ///< settings by name (presets.hpp); none where empty
  std::string qp;                     ///< QP back end; the preset's, or Ipopt, where empty
  std::vector<std::string> set;       ///< KEY=VALUE overrides, after the preset's
  std::string until;                  ///< ends with this phase: time.until; the scene's where empty
  bool force = false;                 ///< replace an existing log
  bool quiet = false;
  std::string command;  ///< as typed, for the log
};

struct RecordQpOptions {
  std::string scene = default_scene;
  std::string out;               ///< HDF5 file to write
  std::string qp = "ipopt";      ///< QP back end of the run
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  int every = 1;                 ///< steps from one that is recorded to the next
  bool primal = false;           ///< as {H, g, G, e, C, d} instead of {A, b, l, u}
  bool force = false;            ///< replace an existing file
  bool quiet = false;
  std::string command;  ///< as typed, for that file
};

struct QpOptions {
  std::string set;                     ///< HDF5 file of QPs
  std::vector<std::string> back_ends;  ///< those of measured_back_ends() where empty
  std::vector<double> tolerances;      ///< of Ipopt, each in turn; its own where empty
  int repeat = 3;                      ///< times that each QP is solved
  std::string csv;                     ///< table as a file; none where empty
};

struct MjcfOptions {
  std::string scene = default_scene;
  std::string out;               ///< folder to write to, made where it is missing
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  bool clamp = false;            ///< weld the head to the world
  bool force = false;            ///< replace existing files
};

struct CompareOptions {
  std::string scene = default_scene;
  std::string out;               ///< HDF5 file for the figure; none where empty
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  std::string command;           ///< as typed, for that file
};

struct IntegrateOptions {
  std::string scene = default_scene;
  std::string motion = "coil";   ///< which start (motions.hpp)
  std::string out;               ///< HDF5 file for the figure
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  std::string command;           ///< as typed, for that file
};

struct PictureOptions {
  std::string log;
  std::string out;            ///< PNG to write; numbered where there are several times
  std::vector<double> times;  ///< s; the last frame where empty
  double pitch = -70;         ///< of the view, degrees; see view_of in picture.hpp
  double yaw = 22;            ///< degrees
};

struct PlaybackOptions {
  std::string log;      ///< with restart intervals of whole frames
  std::string out;      ///< HDF5 file for the figure
  std::string command;  ///< as typed, for that file
};

struct StressOptions {
  std::string scene;
  std::string method = "default";  ///< of stress_methods()
  std::string level = "as is";     ///< what the row calls the scene's level
  double step = 0;                 ///< h, s; the scene's where 0
  double cpu_limit = 60;           ///< s
  std::vector<std::string> set;    ///< KEY=VALUE overrides, after the method's
  std::string out;                 ///< CSV to write; standard output where empty
};

int run(const RunOptions& options);
/// Runs a scene and saves its QPs.
int record_qp(const RecordQpOptions& options);
/// Solves a set of QPs with each back end. Exit code 1 where one fails.
int qp(const QpOptions& options);
/// Back ends that `qp` takes by name.
std::vector<std::string> measured_back_ends();
int mjcf(const MjcfOptions& options);
/// Exit code 1 where a difference is beyond its bound.
int compare(const CompareOptions& options);
/// Error against CPU time of the core's and MuJoCo's steps along a smooth motion.
int integrate(const IntegrateOptions& options);
/// The slide of a log in MuJoCo under f_thigmo alone, the log's mean from frame to frame.
int playback(const PlaybackOptions& options);
/// One cell of the failure map: runs a scene by one method at one step and writes a row of what
/// became of it (stress_judge.hpp).
int stress(const StressOptions& options);
/// Methods that `stress` takes by name.
std::vector<std::string> stress_methods();
int list_scenes();
int info(const std::string& file);
int check(const std::string& file);
/// Prints a table: for each picture its file, time, lower left corner and scale.
int picture(const PictureOptions& options);

}  // namespace hagfish
