#include "page/run_pixels.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "engine/exr_tiles.h"
#include "engine/preview.h"
#include "trace/ray_tree.h"

namespace relook {
namespace {

constexpr std::uint32_t kThumbnailWidth = 256;  // at the most

bool is_color(const FrameTiles::Channel& channel) {
  return channel.name.size() == 1 && std::string_view("RGBA").find(channel.name[0]) != std::string_view::npos;
}

/// The colour channels of a tile, row by row and channel by channel.
std::vector<unsigned char> colors_of(const FrameTiles& frame, std::size_t tile) {
  const std::vector<unsigned char> raw = frame.unpacked(tile);
  const TileRect rect = tile_rect(tile, frame.width(), frame.height());
  const std::size_t columns = rect.x1 - rect.x0;
  std::vector<unsigned char> colors;
  std::size_t from = 0;
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
    for (const FrameTiles::Channel& channel : frame.channels()) {
      const std::size_t bytes = columns * channel.bytes;
      if (is_color(channel)) colors.insert(colors.end(), &raw[from], &raw[from] + bytes);
      from += bytes;
    }
  }
  return colors;
}

bool has_same_layout(const FrameTiles& a, const FrameTiles& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::ranges::equal(a.channels(), b.channels(),
                            [](const auto& x, const auto& y) { return x.name == y.name && x.bytes == y.bytes; });
}

}  // namespace

std::vector<Bytes> RunPixels::packed_colors(const FrameTiles& frame) const {
  std::vector<Bytes> packed(frame.count());
  const bool has_layers = channels_.size() < frame.channels().size();
  parallel_for(frame.count(), [&](std::size_t tile) {
    const BytesView stored = frame.packed(tile);
    packed[tile] = has_layers ? TileCompressor().zip(colors_of(frame, tile)) : Bytes(stored.begin(), stored.end());
  });
  return packed;
}

FramePixels RunPixels::take(Bytes file, std::string_view name) {
  FrameTiles frame(std::move(file), name);
  const bool is_first = last_.count() == 0;
  if (!is_first && !has_same_layout(frame, last_)) throw InputError(name, "", "not like the frames before it");
  if (is_first) std::ranges::copy_if(frame.channels(), std::back_inserter(channels_), is_color);
  std::vector<Bytes> all_packed = packed_colors(frame);
  FramePixels pixels;
  for (std::size_t tile = 0; tile < frame.count(); ++tile) {
    const Bytes& packed = all_packed[tile];
    if (!is_first && packed == packed_[tile]) continue;
    pixels.tiles.push_back(tile);
    pixels.sizes.push_back(packed.size());
    pixels.bytes.insert(pixels.bytes.end(), packed.begin(), packed.end());
  }
  if (is_first) {
    while (frame.width() / shrink_ > kThumbnailWidth && shrink_ < kTileSize) shrink_ *= 2;
    thumbnail_.width = (frame.width() + shrink_ - 1) / shrink_;
    thumbnail_.height = (frame.height() + shrink_ - 1) / shrink_;
    thumbnail_.pixels.resize(std::size_t{thumbnail_.width} * thumbnail_.height);
  }
  last_ = std::move(frame);
  packed_ = std::move(all_packed);
  shrink(pixels.tiles);
  pixels.thumbnail = encode_png(thumbnail_);
  return pixels;
}

void RunPixels::shrink(const std::vector<std::size_t>& tiles) {
  parallel_for(tiles.size(), [&](std::size_t i) {
    const TileRect rect = tile_rect(tiles[i], last_.width(), last_.height());
    const std::vector<Rgba> pixels = last_.pixels(tiles[i]);
    const std::uint32_t columns = rect.x1 - rect.x0;
    for (std::uint32_t y0 = rect.y0; y0 < rect.y1; y0 += shrink_) {
      for (std::uint32_t x0 = rect.x0; x0 < rect.x1; x0 += shrink_) {
        Rgba sum(0, 0, 0, 0);
        float count = 0;
        for (std::uint32_t y = y0; y < std::min(y0 + shrink_, rect.y1); ++y) {
          for (std::uint32_t x = x0; x < std::min(x0 + shrink_, rect.x1); ++x, ++count) {
            const Rgba& pixel = pixels[std::size_t{y - rect.y0} * columns + x - rect.x0];
            // As they are shown: one bright pixel is not to bleach its neighbours.
            sum.r += std::min(pixel.r, 1.0F);
            sum.g += std::min(pixel.g, 1.0F);
            sum.b += std::min(pixel.b, 1.0F);
          }
        }
        thumbnail_.pixels[std::size_t{y0 / shrink_} * thumbnail_.width + x0 / shrink_] = {sum.r / count, sum.g / count,
                                                                                          sum.b / count, 1};
      }
    }
  });
}

}  // namespace relook
