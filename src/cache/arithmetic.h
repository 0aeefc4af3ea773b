// What decides the bits of a pixel beside the scene. Programs and machines that agree in all of it may exchange caches;
// a cache of another arithmetic is refused, since stored hits and colours would be mixed with other bits. Written to
// and compared with the manifest; `relook --version` prints it.
#pragma once
#include <cfloat>
#include <cstdint>
#include <string>

#include "base/json.h"

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "flags like -ffast-math change the bits of pixels"
#endif
#if FLT_EVAL_METHOD != 0
#error "floats are computed as floats: no x87 arithmetic"
#endif

namespace relook {

/// Raised by hand with every change to the bits of anything that a cache stores or a frame shows: any pixel, colour of
/// a sample, hit, ray path, shadow counter, displaced vertex or texel of a pyramid, for any scene, edit or option. Then
/// tests/golden_bits is written anew. Not raised for what leaves all of these as they were: speed, messages,
/// comments, new features that no scene could use before. No macro tells of contraction (-ffp-contract=off in
/// CMakeLists.txt); the golden test does.
inline constexpr std::uint32_t kArithmeticVersion = 5;

struct Arithmetic {
  std::uint32_t version = 0;  // kArithmeticVersion
  std::string embree;         // "3.13.5": of the library that was loaded
  std::string libc;           // "glibc 2.36": its libm computes what is uniform in a scene
  std::string instructions;   // what Embree and libm choose their code by, and how the processor approximates
                              // reciprocals: "avx2, reciprocals 1a2b3c4d"
  bool operator==(const Arithmetic&) const = default;
};

/// Of this program on this machine.
[[nodiscard]] const Arithmetic& own_arithmetic();

[[nodiscard]] Json arithmetic_json(const Arithmetic& arithmetic);
/// Throws InputError.
[[nodiscard]] Arithmetic read_arithmetic(const JsonView& view);

/// How the arithmetic that something was written with differs from this program's: "written with Embree 3.12.1, this is
/// 3.13.5"; "" if it does not.
[[nodiscard]] std::string arithmetic_difference(const Arithmetic& written, const Arithmetic& own = own_arithmetic());

/// "arithmetic 1, Embree 3.13.5, glibc 2.36, avx2, reciprocals 1a2b3c4d"
[[nodiscard]] std::string arithmetic_text(const Arithmetic& arithmetic);

}  // namespace relook
