#include "image/overlay.h"

#include <algorithm>

namespace relook {
namespace {

void outline(Frame& frame, const TileRect& rect, const RegionSquare& square) {
  const std::uint32_t x0 = rect.x0 + square.x, y0 = rect.y0 + square.y;
  const std::uint32_t x1 = std::min(x0 + square.size, rect.x1), y1 = std::min(y0 + square.size, rect.y1);
  const auto paint = [&](std::uint32_t x, std::uint32_t y) {
    frame.pixels[std::size_t{y} * frame.width + x] = Rgba(1, 1, 1, 1);
  };
  if (x0 >= x1 || y0 >= y1) return;  // outside of the image
  for (std::uint32_t x = x0; x < x1; ++x) {
    paint(x, y0);
    paint(x, y1 - 1);
  }
  for (std::uint32_t y = y0; y < y1; ++y) {
    paint(x0, y);
    paint(x1 - 1, y);
  }
}

/// Outlines the topmost regions for which `holds`.
template <class Holds>
void outline_largest(Frame& frame, std::size_t tile, const Holds& holds) {
  const TileRect rect = tile_rect(tile, frame.width, frame.height);
  const auto descend = [&](const auto& self, std::uint32_t region) -> void {
    if (holds(region)) {
      outline(frame, rect, square_of(region));
      return;
    }
    if (is_leaf(region)) return;
    for (std::uint32_t child : children_of(region)) self(self, child);
  };
  descend(descend, kRoot);
}

}  // namespace

void draw_regions(Frame& frame, std::size_t tile, const Leaves& leaves) {
  const TileRect rect = tile_rect(tile, frame.width, frame.height);
  const auto is_inside = [&](std::uint32_t leaf) {
    const RegionSquare square = square_of(leaf);
    return rect.x0 + square.x < rect.x1 && rect.y0 + square.y < rect.y1;
  };
  const auto holds = [&](const auto& self, std::uint32_t region) -> bool {
    if (is_leaf(region)) return leaves.test(region) || !is_inside(region);
    const auto children = children_of(region);
    return std::ranges::all_of(children, [&](std::uint32_t child) { return self(self, child); });
  };
  if (leaves.any()) outline_largest(frame, tile, [&](std::uint32_t region) { return holds(holds, region); });
}

void draw_groups(Frame& frame, std::size_t tile, const PathGroups& groups) {
  outline_largest(frame, tile,
                  [&](std::uint32_t region) { return groups.is_group(region) && groups.classes(region).size() <= 1; });
}

}  // namespace relook
