# Run at every build (cmake -P): writes OUT with the git revision of SOURCE, and touches it only when
# the revision has changed, so that a log always names the code that made it.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=12 --dirty=+ --exclude=*
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(revision "unknown")
endif()
file(WRITE ${OUT}.new "// Written by git_revision.cmake at every build.
#include \"core/log/build_info.hpp\"

namespace hagfish {

std::string build_revision() { return \"${revision}\"; }

}  // namespace hagfish
")
file(COPY_FILE ${OUT}.new ${OUT} ONLY_IF_DIFFERENT)
