// Included before all else: toml11 asks for <filesystem> where this macro is set.
#include <version>
#undef __cpp_lib_filesystem
