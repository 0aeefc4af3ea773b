// Numbers for choices along a sample's way. Each (pixel, history, purpose, name) has a point set of its own, a sequence
// over the pixel's samples 0, 1, 2...: Sobol's (0,2)-sequence with Owen's nested uniform scrambling, its index
// scrambled likewise (Burley 2020, "Practical Hash-based Owen Scrambling"). So samples of a pixel are stratified within
// a set (each 2^m of them, from a multiple of 2^m on, are a (0,m,2)-net) and sets are independent of each other. A
// number follows from its key alone, in integers: whatever order samples are made in, on every machine.
#pragma once
#include <cstdint>
#include <string_view>

#include "base/math.h"

namespace relook {

/// What a sample is known by.
struct SampleKey {
  std::uint32_t pixel = 0;   // pixel_key
  std::uint32_t sample = 0;  // its number within the pixel
};
/// Of a pixel's place in the image, not in a tile. Different for different places below 65536.
[[nodiscard]] std::uint32_t pixel_key(std::uint32_t x, std::uint32_t y);

/// What a number decides. Enumerators keep their values: they are hashed.
enum class Purpose : std::uint8_t { pixel = 0, lens = 1, lobe = 2, light = 3, coverage = 4 };

/// In [0, 1)^2, multiples of 2^-24. `history`: of the branch that asks, from child_history; `name`: tells apart what
/// one purpose asks for at one vertex (a light by its name_hash).
[[nodiscard]] Uv sample_point(const SampleKey& key, std::uint64_t history, Purpose purpose, std::uint64_t name = 0);
/// A single number, likewise stratified, independent of sample_point of the same arguments.
[[nodiscard]] float sample_number(const SampleKey& key, std::uint64_t history, Purpose purpose, std::uint64_t name = 0);

/// What is left of a number that chose the interval [first, first + share) and is uniform in it: uniform in [0, 1).
/// Always below 1, and 0 for an empty share.
[[nodiscard]] float remapped(float number, float first, float share);

/// The same on every machine.
[[nodiscard]] std::uint64_t name_hash(std::string_view name);
/// The history of child `branch`; that of a sample's first vertex is 0.
[[nodiscard]] std::uint64_t child_history(std::uint64_t history, std::uint32_t branch);

}  // namespace relook
