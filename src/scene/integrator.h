// The two definitions of a picture. `whitted`: lamps without size, sharp shadows and mirrors (color/SHADING.md).
// `path`: every light of the look document, estimated by samples. Chosen when a scene is opened, kept by its cache.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace relook {

enum class Integrator : std::uint8_t { whitted, path };
/// By Integrator: on the command line, in reports and in caches.
inline constexpr std::array<std::string_view, 2> kIntegratorWords{"whitted", "path"};

[[nodiscard]] constexpr std::string_view integrator_word(Integrator integrator) {
  return kIntegratorWords[static_cast<std::size_t>(integrator)];
}

}  // namespace relook
