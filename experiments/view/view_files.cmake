# hagfish_view_files(OUT) writes a source file that defines hagfish::view_file() over the page, style and
# scripts beside it and puts its path in OUT. A change to one of them runs CMake again.
function(hagfish_view_files OUT)
  set(entries "")
  set(folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  foreach(file page.html style.css quantities.js body.js plots.js viewer.js)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/${file})
    file(READ ${folder}/${file} text)
    string(APPEND entries "  if (name == \"${file}\") return R\"HAGFISH(${text})HAGFISH\";\n")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/view_files.cpp)
  # By way of a second file, so that an unchanged text recompiles nothing.
  file(WRITE ${source}.new "// Written by view_files.cmake from experiments/view/.
#include \"experiments/view/view_page.hpp\"

#include <stdexcept>
#include <string>

namespace hagfish {

std::string_view view_file(std::string_view name) {
${entries}  throw std::out_of_range(std::string(name));
}

}  // namespace hagfish
")
  file(COPY_FILE ${source}.new ${source} ONLY_IF_DIFFERENT)
  set(${OUT} ${source} PARENT_SCOPE)
endfunction()
