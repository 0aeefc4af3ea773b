#include "cache/arithmetic.h"

#include <array>
#include <span>

#if __has_include(<gnu/libc-version.h>)
#include <gnu/libc-version.h>
#endif

#if defined(__x86_64__)
#include <cpuid.h>
#include <xmmintrin.h>
#endif

#include "base/error.h"
#include "base/hash.h"
#include "trace/embree_version.h"

namespace relook {
namespace {

std::string libc_version() {
#if defined(__GLIBC__)
  return std::string("glibc ") + gnu_get_libc_version();
#else
  return "unknown";
#endif
}

#if defined(__x86_64__)
/// F16C, RDRND and LZCNT, names that clang 16's __builtin_cpu_supports does not know.
bool has_small_extensions() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & bit_F16C) == 0 || (c & bit_RDRND) == 0) return false;
  return __get_cpuid(0x80000001U, &a, &b, &c, &d) != 0 && (c & bit_LZCNT) != 0;
}
#endif

/// The instructions by which Embree and libm choose their code. The tracer holds Embree to AVX2, so that machines with
/// AVX-512 run the same kernels as others; Embree asks for more flags than AVX2's own before it takes these. glibc has
/// variants of libm's functions with fused multiply-add, for AVX2 and FMA4.
std::string instruction_set() {
#if defined(__x86_64__)
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && has_small_extensions();
  if (has_avx2) return "avx2";
  if (__builtin_cpu_supports("avx")) return __builtin_cpu_supports("fma4") ? "avx+fma4" : "avx";
  return __builtin_cpu_supports("sse4.2") ? "sse4.2" : "sse2";
#else
  return "generic";
#endif
}

/// The processor's approximate reciprocals and reciprocal square roots, from which Embree goes on by Newton's method:
/// each vendor has tables of its own, and the last bit of a hit follows from them. A hash of those of 2^12 mantissas, of
/// roots with an even and an odd exponent: ", reciprocals 1a2b3c4d".
std::string reciprocals() {
#if defined(__x86_64__)
  constexpr int kMantissas = 1 << 12;
  std::array<float, std::size_t{3} * kMantissas> approximations{};
  float* next = approximations.data();
  for (int i = 0; i < kMantissas; ++i) {
    const float mantissa = 1.0F + static_cast<float>(i) / kMantissas;
    *next++ = _mm_cvtss_f32(_mm_rcp_ss(_mm_set_ss(mantissa)));
    *next++ = _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(mantissa)));
    *next++ = _mm_cvtss_f32(_mm_rsqrt_ss(_mm_set_ss(2.0F * mantissa)));
  }
  return ", reciprocals " + hash128(std::as_bytes(std::span(approximations))).substr(0, 8);
#else
  return "";
#endif
}

}  // namespace

const Arithmetic& own_arithmetic() {
  static const Arithmetic own{kArithmeticVersion, embree_version(), libc_version(), instruction_set() + reciprocals()};
  return own;
}

Json arithmetic_json(const Arithmetic& arithmetic) {
  return {{"version", arithmetic.version},
          {"embree", arithmetic.embree},
          {"libc", arithmetic.libc},
          {"instructions", arithmetic.instructions}};
}

Arithmetic read_arithmetic(const JsonView& view) {
  return {static_cast<std::uint32_t>(view.at("version").integer(0, UINT32_MAX)), view.at("embree").text(),
          view.at("libc").text(), view.at("instructions").text()};
}

std::string arithmetic_difference(const Arithmetic& written, const Arithmetic& own) {
  std::string differences;
  const auto compare = [&](const char* what, const std::string& theirs, const std::string& ours) {
    if (theirs == ours) return;
    differences += (differences.empty() ? "written with " : "; with ") + std::string(what) + printable(theirs) +
                   ", this is " + ours;
  };
  compare("arithmetic ", std::to_string(written.version), std::to_string(own.version));
  compare("Embree ", written.embree, own.embree);
  compare("", written.libc, own.libc);
  compare("instructions ", written.instructions, own.instructions);
  return differences;
}

std::string arithmetic_text(const Arithmetic& arithmetic) {
  return "arithmetic " + std::to_string(arithmetic.version) + ", Embree " + arithmetic.embree + ", " + arithmetic.libc +
         ", " + arithmetic.instructions;
}

}  // namespace relook
