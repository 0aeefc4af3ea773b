#include "frame/frame_tiles.h"

#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/tiles.h"
#include "frame/deflate.h"

namespace relook {
namespace {

std::int64_t read_from_memory(exr_const_context_t, void* userdata, void* buffer, std::uint64_t size,
                              std::uint64_t offset, exr_stream_error_func_ptr_t) {
  const Bytes& file = *static_cast<const Bytes*>(userdata);
  if (offset >= file.size()) return 0;
  const std::size_t here = std::min<std::size_t>(size, file.size() - offset);
  std::memcpy(buffer, file.data() + offset, here);
  return static_cast<std::int64_t>(here);
}

std::int64_t size_in_memory(exr_const_context_t, void* userdata) {
  return static_cast<std::int64_t>(static_cast<const Bytes*>(userdata)->size());
}

void ignore_message(exr_const_context_t, exr_result_t, const char*) {}

struct FinishContext {
  void operator()(exr_context_t context) const { exr_finish(&context); }
};

float value_of(const unsigned char* bytes, std::uint32_t size) {
  if (size == sizeof(float)) {
    float value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  half value;
  std::uint16_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  value.setBits(bits);
  return value;
}

ExrAttributes texts_of(exr_const_context_t file) {
  std::int32_t count = 0;
  ExrAttributes texts;
  if (exr_get_attribute_count(file, 0, &count) != EXR_ERR_SUCCESS) return texts;
  for (std::int32_t i = 0; i < count; ++i) {
    const exr_attribute_t* attribute = nullptr;
    if (exr_get_attribute_by_index(file, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) != EXR_ERR_SUCCESS) continue;
    if (attribute->type == EXR_ATTR_STRING && attribute->string->length > 0)
      texts.emplace_back(attribute->name,
                         std::string(attribute->string->str, static_cast<std::size_t>(attribute->string->length)));
  }
  return texts;
}

}  // namespace

FrameTiles::FrameTiles(Bytes bytes, std::string_view file) : file_(file), bytes_(std::move(bytes)) {
  const auto check = [&](exr_result_t result) {
    if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (result != EXR_ERR_SUCCESS) throw InputError(file_, "", exr_get_default_error_message(result));
  };
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.read_fn = read_from_memory;
  setup.size_fn = size_in_memory;
  setup.error_handler_fn = ignore_message;
  setup.user_data = &bytes_;
  exr_context_t opened = nullptr;
  check(exr_start_read(&opened, "frame", &setup));
  const std::unique_ptr<std::remove_pointer_t<exr_context_t>, FinishContext> context(opened);

  exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
  exr_compression_t compression = EXR_COMPRESSION_NONE;
  exr_attr_box2i_t window{};
  std::uint32_t tile_width = 0, tile_height = 0;
  exr_tile_level_mode_t levels = EXR_TILE_ONE_LEVEL;
  exr_tile_round_mode_t rounding = EXR_TILE_ROUND_DOWN;
  const exr_attr_chlist_t* channels = nullptr;
  check(exr_get_storage(opened, 0, &storage));
  check(exr_get_compression(opened, 0, &compression));
  if (storage != EXR_STORAGE_TILED || compression != EXR_COMPRESSION_ZIP)
    throw InputError(file_, "", "not a tiled frame with ZIP compression");
  check(exr_get_tile_descriptor(opened, 0, &tile_width, &tile_height, &levels, &rounding));
  check(exr_get_data_window(opened, 0, &window));
  check(exr_get_channels(opened, 0, &channels));
  if (tile_width != kTileSize || tile_height != kTileSize || levels != EXR_TILE_ONE_LEVEL)
    throw InputError(file_, "tiles", "not one level of tiles of " + std::to_string(kTileSize) + " pixels");
  texts_ = texts_of(opened);
  width_ = static_cast<std::uint32_t>(window.max.x - window.min.x + 1);
  height_ = static_cast<std::uint32_t>(window.max.y - window.min.y + 1);
  for (int i = 0; i < channels->num_channels; ++i) {
    const exr_attr_chlist_entry_t& entry = channels->entries[i];
    if (entry.x_sampling != 1 || entry.y_sampling != 1) throw InputError(file_, "channels", "subsampled");
    channels_.push_back({entry.name.str, entry.pixel_type == EXR_PIXEL_HALF ? 2U : 4U});
    pixel_bytes_ += channels_.back().bytes;
  }
  const auto columns = static_cast<int>(tiles_along(width_));
  chunks_.resize(tile_count(width_, height_));
  for (std::size_t tile = 0; tile < chunks_.size(); ++tile) {
    const auto index = static_cast<int>(tile);
    exr_chunk_info_t chunk{};
    check(exr_read_tile_chunk_info(opened, 0, index % columns, index / columns, 0, 0, &chunk));
    if (chunk.data_offset > bytes_.size() || chunk.packed_size > bytes_.size() - chunk.data_offset)
      throw InputError(file_, "tile " + std::to_string(tile), "cut short");
    chunks_[tile] = {chunk.data_offset, chunk.packed_size};
  }
}

BytesView FrameTiles::packed(std::size_t tile) const {
  return BytesView(bytes_).subspan(chunks_[tile].offset, chunks_[tile].size);
}

std::vector<unsigned char> FrameTiles::unpacked(std::size_t tile) const {
  const std::size_t raw_bytes = tile_rect(tile, width_, height_).pixels() * pixel_bytes_;
  const BytesView chunk = packed(tile);
  std::vector<unsigned char> raw(raw_bytes);
  if (chunk.size() == raw_bytes) {
    std::memcpy(raw.data(), chunk.data(), raw_bytes);
    return raw;
  }
  std::vector<unsigned char> split(raw_bytes);
  if (!inflate_zlib(chunk, split)) throw InputError(file_, "tile " + std::to_string(tile), "damaged");
  // Differences, first those of the bytes at even places.
  unsigned char value = 128;
  const unsigned char* next = split.data();
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}})
    for (std::size_t i = first; i < raw_bytes; i += 2)
      raw[i] = value = static_cast<unsigned char>(value + *next++ - 128);
  return raw;
}

std::vector<Rgba> FrameTiles::pixels(std::size_t tile) const {
  constexpr std::array<std::pair<std::string_view, float Rgba::*>, 4> kMembers{
      {{"R", &Rgba::r}, {"G", &Rgba::g}, {"B", &Rgba::b}, {"A", &Rgba::a}}};
  const TileRect rect = tile_rect(tile, width_, height_);
  const std::vector<unsigned char> raw = unpacked(tile);
  std::vector<Rgba> pixels(rect.pixels(), Rgba{0, 0, 0, 1});
  const std::size_t columns = rect.width();
  std::size_t channel_start = 0;  // bytes from the start of a row
  for (const Channel& channel : channels_) {
    const auto member = std::ranges::find(kMembers, channel.name, [](const auto& entry) { return entry.first; });
    for (std::size_t first = 0; member != kMembers.end() && first < pixels.size(); first += columns) {
      const unsigned char* value = &raw[first * pixel_bytes_ + channel_start];
      for (std::size_t i = first; i < first + columns; ++i, value += channel.bytes)
        pixels[i].*member->second = value_of(value, channel.bytes);
    }
    channel_start += columns * channel.bytes;
  }
  return pixels;
}

}  // namespace relook
