# Runs the tests of one source file: cmake -DPROGRAM=... -DFILE=... -P run_file.cmake. A program for each file would have
# to be linked, and one for each test to be started, which takes longer than most tests.
file(READ ${FILE} text)
string(REGEX MATCHALL "TEST(_F|_P)?\\([A-Za-z0-9_]+,[ \n]*[A-Za-z0-9_]+\\)" tests "${text}")
if(NOT tests)
  message(FATAL_ERROR "no tests in ${FILE}")
endif()
list(TRANSFORM tests REPLACE "TEST(_F)?\\(([A-Za-z0-9_]+),[ \n]*([A-Za-z0-9_]+)\\)" "\\2.\\3")
list(TRANSFORM tests REPLACE "TEST_P\\(([A-Za-z0-9_]+),[ \n]*([A-Za-z0-9_]+)\\)" "*/\\1.\\2/*")
list(JOIN tests ":" filter)
execute_process(COMMAND ${PROGRAM} --gtest_filter=${filter} --gtest_brief=1 RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${FILE}: ${failed}")
endif()
