// What was built, from what, with what, and what runs it: written to every log.
#pragma once

#include <string>

namespace hagfish {

std::string build_version();  ///< version of the project
std::string
build_revision();  ///< git revision, "+" where the tree had changes, "unknown" outside git
std::string build_compiler();  ///< name, version, flags

/// Name of the processor that this runs on, from the system; empty where it does not say.
std::string cpu_name();

/// "name version; ..." of the libraries that bear on results.
std::string build_libraries();

}  // namespace hagfish
