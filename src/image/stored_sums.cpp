// Sums of light of a stored image, tile by tile, and the pixels that they give.
#include <cstring>

#include "frame/light_sums.h"
#include "image/stored_image.h"

namespace relook {

void StoredImage::keep_sums(std::size_t tile, PackedSums sums) {
  const auto lease = residency_.use(PieceKind::light_sums, tile);
  image_.light_sums[tile] = std::move(sums);
  note_sums(residency_, tile, image_.light_sums[tile]);
}

void StoredImage::refresh_from_sums(std::size_t tile, std::span<const LightColor> colors, TileMask& changed) {
  const auto lease = residency_.use(PieceKind::light_sums, tile);
  const TileRect rect = tile_rect(tile, image_.frame.width, image_.frame.height);
  std::vector<Rgba> pixels(rect.pixels());
  compose_tile(image_.light_sums[tile], colors, image_.view.samples, pixels);
  const Rgba* pixel = pixels.data();
  for (std::uint32_t y = 0; y < rect.height(); ++y) {
    Rgba* row = &image_.frame.pixels[std::size_t{rect.y0 + y} * image_.frame.width + rect.x0];
    for (std::uint32_t x = 0; x < rect.width(); ++x, ++pixel) {
      if (std::memcmp(&row[x], pixel, sizeof(Rgba)) == 0) continue;
      row[x] = *pixel;
      changed[y] |= std::uint64_t{1} << x;
    }
  }
}

}  // namespace relook
