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

// Where SIMDe's plain code is a loop over numbers or several instructions, and WebAssembly has one. Of
// two numbers that are equal or not a number SSE2 gives the second.
#undef _mm_sqrt_ps
#undef _mm_sqrt_pd
#undef _mm_max_pd
#undef _mm_min_pd
#undef _mm_max_ps
#undef _mm_min_ps
#define _mm_sqrt_ps(a) ((__m128)__builtin_wasm_sqrt_f32x4(a))
#define _mm_sqrt_pd(a) ((__m128d)__builtin_wasm_sqrt_f64x2(a))
#define _mm_max_pd(a, b) ((__m128d)__builtin_wasm_pmax_f64x2(b, a))
#define _mm_min_pd(a, b) ((__m128d)__builtin_wasm_pmin_f64x2(b, a))
#define _mm_max_ps(a, b) ((__m128)__builtin_wasm_pmax_f32x4(b, a))
#define _mm_min_ps(a, b) ((__m128)__builtin_wasm_pmin_f32x4(b, a))
