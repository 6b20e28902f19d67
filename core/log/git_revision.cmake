# Run at every build (cmake -P): writes OUT with the git revision of SOURCE, and touches it only when
# the revision has changed, so that a log always names the code that made it. A "+" says that files
# differ from that commit; results are made by the program and do not count.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(revision "unknown")
else()
  execute_process(COMMAND git -C ${SOURCE} diff --quiet HEAD -- .
    ":(exclude)experiments/results/*.csv" ":(exclude)experiments/results/*.md"
    ":(exclude)experiments/results/*.png" ":(exclude)README.md"
    ERROR_QUIET RESULT_VARIABLE changed)
  if(changed)
    string(APPEND revision "+")
  endif()
endif()
file(WRITE ${OUT}.new "// Written by git_revision.cmake at every build.
#include \"core/log/build_info.hpp\"

namespace hagfish {

std::string build_revision() { return \"${revision}\"; }

}  // namespace hagfish
")
file(COPY_FILE ${OUT}.new ${OUT} ONLY_IF_DIFFERENT)
