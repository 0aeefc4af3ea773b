// What a replay under --memory will need beside pieces, foreseen from the scene: for the floor that it names, and for
// the first full render of --verify. Later renders are known from those before (cache/residency/RESIDENCY.md).
#pragma once
#include <cstddef>
#include <cstdint>

#include "cache/residency/residency.h"
#include "scene/scene.h"

namespace relook {

/// What writing report.html takes.
inline constexpr std::uint64_t kPageBytes = 18 << 20;

/// Does a replay build acceleration structures, render aside, and write report.html in the end?
struct ReplayWork {
  bool shoots_rays = false, renders_aside = false, writes_page = false;
};

[[nodiscard]] MemoryNeeds memory_needs(const Scene& scene, std::size_t threads, const ReplayWork& work);

}  // namespace relook
