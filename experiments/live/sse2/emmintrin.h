// Intel's SSE2 intrinsics, which Eigen's code for vector registers is written in, by SIMDe's plain
// code for any compiler: clang makes WebAssembly's vector instructions of it. (SIMDe's own code for
// WebAssembly gives vectors of all kinds one type, and Eigen needs them told apart.)
#pragma once

#define SIMDE_ENABLE_NATIVE_ALIASES
#define SIMDE_WASM_SIMD128_NO_NATIVE
#define SIMDE_X86_SSE2_NO_NATIVE
#define SIMDE_X86_SSE_NO_NATIVE
#define SIMDE_X86_MMX_NO_NATIVE
#include <simde/x86/sse2.h>
