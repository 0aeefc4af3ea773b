// Tunnels of a cache against the ray trees that they are to enclose: lost ones are built again, stored ones checked.
#pragma once
#include <span>

#include "cache/cache.h"
#include "cache/stored_tunnels.h"
#include "frame/image.h"
#include "scene/compile/state.h"

namespace relook {

/// Builds the tunnels of some tiles again as preprocess() built them. Requires: the trees of `content` are whole.
void build_tunnels_again(const SceneState& state, std::span<const std::size_t> tiles, CacheContent& content);

/// Encloses a sample of the cells of every stored tile again. Returns how many tiles have tunnels that are not those.
[[nodiscard]] std::size_t count_wrong_tunnels(const SceneState& state, const Image& image, StoredTunnels& stored);

}  // namespace relook
