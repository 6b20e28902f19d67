# WebAssembly by Debian 12's clang: clang-16 lld-16 llvm-16 libc++-16-dev-wasm32 libc++abi-16-dev-wasm32
# libclang-rt-16-dev-wasm32 wasi-libc libsimde-dev.
set(CMAKE_SYSTEM_NAME WASI)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-16)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_AR llvm-ar-16)
set(CMAKE_RANLIB llvm-ranlib-16)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# Headers of libc++ and wasi-libc by name, and none else of /usr/include.
string(APPEND CMAKE_CXX_FLAGS_INIT " -nostdlibinc"
  " -isystem /usr/lib/llvm-16/include/wasm32-wasi/c++/v1 -isystem /usr/include/wasm32-wasi")
# Vector registers of 128 bits. Sums are those of SSE2: as the program for any x86-64 has them.
string(APPEND CMAKE_CXX_FLAGS_INIT " -msimd128 -ffp-contract=off -fno-math-errno -fexceptions")
