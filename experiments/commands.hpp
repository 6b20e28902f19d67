// The subcommands of `hagfish`. Each returns the program's exit code: 0 done, 1 the run or the
// audit failed, 2 bad input (thrown as InputError or FileError, or returned).
#pragma once

#include <string>
#include <vector>

namespace hagfish {

inline constexpr const char* default_scene = "table1";

struct RunOptions {
  std::string scene = default_scene;  ///< a built-in scene's name or a file
  std::string out;                    ///< log to write; SCENE.h5 where empty
  std::string qp = "ipopt";           ///< QP back end
  std::vector<std::string> set;       ///< KEY=VALUE overrides
  bool force = false;                 ///< replace an existing log
  bool quiet = false;
  std::string command;  ///< as typed, for the log
};

int run(const RunOptions& options);
int list_scenes();
int info(const std::string& file);
int check(const std::string& file);

}  // namespace hagfish
