# The libraries that are headers alone, for WebAssembly: by a folder of links, so that no other
# header of /usr/include is seen.
set(headers ${CMAKE_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${headers})
foreach(header eigen3/Eigen fmt toml toml.hpp simde)
  get_filename_component(name ${header} NAME)
  if(NOT EXISTS /usr/include/${header})
    message(FATAL_ERROR "/usr/include/${header} is missing: HAGFISH_WEB=1 bash experiments/setup.sh")
  endif()
  file(CREATE_LINK /usr/include/${header} ${headers}/${name} SYMBOLIC)
endforeach()

add_library(wasm_headers INTERFACE)
target_include_directories(wasm_headers SYSTEM INTERFACE ${CMAKE_CURRENT_LIST_DIR}/sse2 ${headers})
# libc++ 16 says that it has <filesystem>, of which it has nothing here.
target_compile_options(wasm_headers INTERFACE
  "SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/sse2/no_filesystem.hpp")
foreach(library Eigen3::Eigen fmt::fmt toml11::toml11)
  add_library(${library} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(${library} INTERFACE wasm_headers)
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
# Eigen's code for SSE2, over the intrinsics of sse2/emmintrin.h: sums are then added up in the
# order in which the native program adds them, and so are equal to the last bit.
target_compile_definitions(Eigen3::Eigen INTERFACE __SSE__ __SSE2__ EIGEN_MAX_STATIC_ALIGN_BYTES=16
  EIGEN_MALLOC_ALREADY_ALIGNED=1 EIGEN_ARCH_DEFAULT_NUMBER_OF_REGISTERS=16)
# For Eigen a GCC 6.3 or later, which needs no assembler in minima, but not GCC 6, for which it has
# some elsewhere: it reads 10 times the first number plus the second in the one place only.
target_compile_options(Eigen3::Eigen INTERFACE -fgnuc-version=5.13 -Wno-pass-failed)
