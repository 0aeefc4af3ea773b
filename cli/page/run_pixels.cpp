#include "page/run_pixels.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "frame/exr_tiles.h"
#include "frame/frame_file.h"
#include "frame/sheet/contact_sheet.h"
#include "trace/tree/ray_tree.h"

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

std::vector<FrameTiles::Channel> colors_among(const std::vector<FrameTiles::Channel>& channels) {
  std::vector<FrameTiles::Channel> colors;
  std::ranges::copy_if(channels, std::back_inserter(colors), is_color);
  return colors;
}

bool are_equal(const std::vector<FrameTiles::Channel>& a, const std::vector<FrameTiles::Channel>& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return x.name == y.name && x.bytes == y.bytes; });
}

}  // namespace

Bytes scaled_frame(Bytes file, std::string_view name, std::uint32_t scale) {
  const Frame frame = decode_exr(file, name);
  const FrameTiles stored(std::move(file), name);
  const bool is_float = std::ranges::any_of(
      stored.channels(), [](const FrameTiles::Channel& channel) { return channel.name == "R" && channel.bytes == 4; });
  const std::uint32_t width = std::max(1U, (frame.width + scale - 1) / scale);
  return encode_exr(scaled_down(frame, width), {}, is_float ? PixelFormat::float32 : PixelFormat::half);
}

std::vector<Bytes> RunPixels::packed_colors() const {
  std::vector<Bytes> packed(current_.count());
  if (channels_.size() < current_.channels().size()) {  // there are layers
    parallel_for(packed.size(),
                 [&](std::size_t tile) { packed[tile] = TileCompressor().zip(colors_of(current_, tile)); });
  } else {
    for (std::size_t tile = 0; tile < packed.size(); ++tile) {
      const BytesView stored = current_.packed(tile);
      packed[tile].assign(stored.begin(), stored.end());
    }
  }
  return packed;
}

void RunPixels::load(Bytes file, std::string_view name) {
  FrameTiles frame(std::move(file), name);
  const bool is_first = current_.count() == 0;
  // Layers may come and go with the lights of the scene: the page does not have them.
  std::vector<FrameTiles::Channel> colors = colors_among(frame.channels());
  if (!is_first &&
      (frame.width() != current_.width() || frame.height() != current_.height() || !are_equal(colors, channels_)))
    throw InputError(name, "", "not like the frames before it");
  channels_ = std::move(colors);
  current_ = std::move(frame);
  packed_ = packed_colors();
  changed_.clear();
  for (std::size_t tile = 0; tile < packed_.size(); ++tile)
    if (kept_.empty() || packed_[tile] != kept_[tile]) changed_.push_back(tile);
}

std::size_t RunPixels::packed_bytes() const {
  std::size_t bytes = 0;
  for (const Bytes& tile : packed_) bytes += tile.size();
  return bytes;
}

void RunPixels::keep() {
  kept_.resize(packed_.size());
  for (const std::size_t tile : changed_) kept_[tile] = packed_[tile];
  changed_.clear();
}

Bytes RunPixels::thumbnail() {
  if (shown_.empty()) {
    while (current_.width() / shrink_ > kThumbnailWidth && shrink_ < kTileSize) shrink_ *= 2;
    thumbnail_.width = (current_.width() + shrink_ - 1) / shrink_;
    thumbnail_.height = (current_.height() + shrink_ - 1) / shrink_;
    thumbnail_.pixels.resize(std::size_t{thumbnail_.width} * thumbnail_.height);
    shown_.resize(packed_.size());
  }
  parallel_for(packed_.size(), [&](std::size_t tile) {
    if (shown_[tile] == packed_[tile]) return;
    shrink(tile);
    shown_[tile] = packed_[tile];
  });
  return encode_png(thumbnail_);
}

void RunPixels::shrink(std::size_t tile) {
  const TileRect rect = tile_rect(tile, current_.width(), current_.height());
  const std::vector<Rgba> pixels = current_.pixels(tile);
  const std::uint32_t columns = rect.x1 - rect.x0;
  for (std::uint32_t y0 = rect.y0; y0 < rect.y1; y0 += shrink_) {
    for (std::uint32_t x0 = rect.x0; x0 < rect.x1; x0 += shrink_) {
      Rgba sum(0, 0, 0, 0);
      float count = 0;
      for (std::uint32_t y = y0; y < std::min(y0 + shrink_, rect.y1); ++y) {
        for (std::uint32_t x = x0; x < std::min(x0 + shrink_, rect.x1); ++x, ++count) {
          const Rgba& pixel = pixels[std::size_t{y - rect.y0} * columns + x - rect.x0];
          // Pixels count as they are shown, 1 at the most: one bright pixel is not to bleach its neighbours.
          sum.r += std::min(pixel.r * gain_, 1.0F);
          sum.g += std::min(pixel.g * gain_, 1.0F);
          sum.b += std::min(pixel.b * gain_, 1.0F);
        }
      }
      thumbnail_.pixels[std::size_t{y0 / shrink_} * thumbnail_.width + x0 / shrink_] = {sum.r / count, sum.g / count,
                                                                                        sum.b / count, 1};
    }
  }
}

}  // namespace relook
