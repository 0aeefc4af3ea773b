// Writes frames: tiles in OpenEXR's layout, compressed when they change, handed to frame/exr_tiles.
#include <array>
#include <cstring>
#include <numeric>

#include "base/error.h"
#include "base/json.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "base/system/memory.h"
#include "base/vector_clones.h"
#include "frame/exr_tiles.h"
#include "frame/frame_file.h"
#include "frame/half_bits.h"

namespace relook {
namespace {

constexpr std::size_t kStride = sizeof(Rgba) / sizeof(float);  // from a channel's value to that of the next pixel

/// `count`: kTileSize at most.
RELOOK_VECTOR_CLONES
void put_halves(const float* values, std::size_t count, unsigned char* out) {
  std::array<std::uint16_t, kTileSize> halves;
  for (std::size_t i = 0; i < count; ++i) halves[i] = half_bits(values[i * kStride]);
  std::memcpy(out, halves.data(), count * sizeof halves[0]);
}

/// The tile as OpenEXR lays it out before compression: row by row, channel by channel in alphabetical order.
std::vector<unsigned char> tile_bytes(const Frame& frame, const TileRect& rect, PixelFormat format) {
  constexpr std::array<float Rgba::*, 4> kChannels{&Rgba::a, &Rgba::b, &Rgba::g, &Rgba::r};
  const std::size_t value_bytes = format == PixelFormat::half ? 2 : 4;
  std::vector<unsigned char> bytes(std::size_t{rect.pixels()} * kChannels.size() * value_bytes);
  unsigned char* out = bytes.data();
  const std::size_t columns = rect.width();
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
    const Rgba* row = &frame.pixels[std::size_t{y} * frame.width + rect.x0];
    for (const auto channel : kChannels) {
      const float* values = &(row->*channel);
      if (format == PixelFormat::half)
        put_halves(values, columns, out);
      else
        for (std::size_t x = 0; x < columns; ++x)
          std::memcpy(out + x * sizeof(float), values + x * kStride, sizeof(float));
      out += columns * value_bytes;
    }
  }
  return bytes;
}

RELOOK_VECTOR_CLONES
std::uint32_t clipped_in_row(const Rgba* pixels, std::size_t count) {
  std::uint32_t clipped = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Rgba& pixel = pixels[i];
    const bool is_clipped =
        is_beyond_half(pixel.r) | is_beyond_half(pixel.g) | is_beyond_half(pixel.b) | is_beyond_half(pixel.a);
    clipped += is_clipped ? 1 : 0;
  }
  return clipped;
}

std::uint32_t clipped_in(const Frame& frame, const TileRect& rect) {
  std::uint32_t clipped = 0;
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y)
    clipped += clipped_in_row(&frame.pixels[std::size_t{y} * frame.width + rect.x0], rect.width());
  return clipped;
}

}  // namespace

std::string exposure_text(double exposure) { return exposure == 0 ? "" : Json(exposure).dump(); }

ExrAttributes frame_attributes(const FrameMeta& meta) {
  ExrAttributes attributes;
  for (const auto& [name, member] : kFrameAttributes)
    if (!(meta.*member).empty()) attributes.emplace_back(name, meta.*member);
  return attributes;
}

FrameEncoder::FrameEncoder(std::uint32_t width, std::uint32_t height, PixelFormat format)
    : width_(width),
      height_(height),
      format_(format),
      taken_(tile_count(width, height)),
      chunks_(tile_count(width, height)),
      clipped_(tile_count(width, height)) {}

void FrameEncoder::take(const Frame& frame, std::span<const std::uint32_t> tiles) {
  require(frame.width == width_ && frame.height == height_, "a frame encoder keeps one size");
  parallel_for(tiles.size(), [&](std::size_t i) {
    const TileRect rect = tile_rect(tiles[i], width_, height_);
    taken_[tiles[i]] = tile_bytes(frame, rect, format_);
    if (format_ == PixelFormat::half) clipped_[tiles[i]] = clipped_in(frame, rect);
  });
}

std::uint64_t FrameEncoder::clipped_pixels() const {
  return std::accumulate(clipped_.begin(), clipped_.end(), std::uint64_t{0});
}

void FrameEncoder::update(const Frame& frame) {
  std::vector<std::uint32_t> all(chunks_.size());
  std::iota(all.begin(), all.end(), 0U);
  take(frame, all);
}

void FrameEncoder::update(const Frame& frame, const ChangedPixels& changed_pixels) {
  std::vector<std::uint32_t> tiles;
  for (const ChangedPixels::Tile& tile : changed_pixels.tiles()) tiles.push_back(tile.tile);
  take(frame, tiles);
}

void FrameEncoder::compress_taken() {
  Pool<TileCompressor> compressors;
  parallel_for(taken_.size(), [&](std::size_t tile) {
    if (taken_[tile].empty()) return;
    const auto compressor = compressors.take([] { return std::make_unique<TileCompressor>(); });
    chunks_[tile] = compressor->zip(taken_[tile]);
    give_back(taken_[tile]);
  });
}

Bytes FrameEncoder::exr(const FrameMeta& meta) {
  compress_taken();
  const std::array<ExrChannel, 4> channels{{{"R", format_}, {"G", format_}, {"B", format_}, {"A", format_}}};
  return tiled_exr(width_, height_, channels, frame_attributes(meta), chunks_);
}

std::uint64_t clipped_pixels(const Frame& frame) {
  std::uint64_t clipped = 0;
  for (std::uint32_t y = 0; y < frame.height; ++y)
    clipped += clipped_in_row(&frame.pixels[std::size_t{y} * frame.width], frame.width);
  return clipped;
}

std::string clipping_sentence(std::uint64_t pixels) {
  return std::to_string(pixels) + (pixels == 1 ? " pixel is" : " pixels are") +
         " beyond half's range (65504); --float keeps " + (pixels == 1 ? "it" : "them");
}

Bytes encode_exr(const Frame& frame, const FrameMeta& meta, PixelFormat format) {
  FrameEncoder encoder(frame.width, frame.height, format);
  encoder.update(frame);
  return encoder.exr(meta);
}

}  // namespace relook
