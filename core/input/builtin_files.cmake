# hagfish_builtin_files(OUT) writes a source file that defines hagfish::builtin_file() over
# data/ and puts its path in OUT. A change to data/ runs CMake again.
function(hagfish_builtin_files OUT)
  set(data ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../../data)
  file(GLOB files CONFIGURE_DEPENDS RELATIVE ${data} ${data}/*.toml ${data}/specimens/*.toml ${data}/programs/*.csv)
  set(entries "")
  set(scenes "")
  foreach(file IN LISTS files)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${data}/${file})
    file(READ ${data}/${file} text)
    if(NOT file MATCHES "/" AND NOT file STREQUAL "presets.toml")
      get_filename_component(name ${file} NAME_WE)
      string(APPEND scenes "\"${name}\", ")
    endif()
    string(APPEND entries "  if (name == \"${file}\") return R\"HAGFISH(${text})HAGFISH\";\n")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/builtin_files.cpp)
  # By way of a second file, so that an unchanged text recompiles nothing.
  file(WRITE ${source}.new "// Written by builtin_files.cmake from data/.
#include \"core/input/builtin_files.hpp\"

namespace hagfish {

std::optional<std::string_view> builtin_file(std::string_view name) {
${entries}  return std::nullopt;
}

std::vector<std::string_view> builtin_scene_names() { return {${scenes}}; }

}  // namespace hagfish
")
  file(COPY_FILE ${source}.new ${source} ONLY_IF_DIFFERENT)
  set(${OUT} ${source} PARENT_SCOPE)
endfunction()
