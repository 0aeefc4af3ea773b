#include "frame/exr_tiles.h"

#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>

#include "base/error.h"
#include "base/tiles.h"
#include "base/vector_clones.h"
#include "frame/half_bits.h"

namespace relook {
namespace {

/// Even bytes first, then odd ones; each as its difference from the one before, offset by 128.
RELOOK_VECTOR_CLONES
void split_bytes(const unsigned char* raw, std::size_t size, unsigned char* split) {
  constexpr unsigned kOffset = 128;
  const std::size_t odd_bytes = size / 2, even_bytes = size - odd_bytes;
  for (std::size_t i = 1; i < even_bytes; ++i)
    split[i] = static_cast<unsigned char>(raw[2 * i] - raw[2 * i - 2] + kOffset);
  unsigned char* odd = split + even_bytes;
  for (std::size_t i = 1; i < odd_bytes; ++i)
    odd[i] = static_cast<unsigned char>(raw[2 * i + 1] - raw[2 * i - 1] + kOffset);
  if (size > 0) split[0] = raw[0];
  if (odd_bytes > 0) odd[0] = static_cast<unsigned char>(raw[1] - raw[2 * even_bytes - 2] + kOffset);
}

static_assert(std::endian::native == std::endian::little, "OpenEXR files are little-endian");

struct MemoryFile {
  Bytes bytes;
  bool is_short_of_memory = false;
};

/// Called by C, through which nothing may be thrown.
std::int64_t write_to_memory(exr_const_context_t, void* userdata, const void* buffer, std::uint64_t size,
                             std::uint64_t offset, exr_stream_error_func_ptr_t) {
  auto& file = *static_cast<MemoryFile*>(userdata);
  try {
    if (file.bytes.size() < offset + size) file.bytes.resize(offset + size);
  } catch (const std::exception&) {
    file.is_short_of_memory = true;
    return -1;
  }
  std::memcpy(file.bytes.data() + offset, buffer, size);
  return static_cast<std::int64_t>(size);
}

void ignore_message(exr_const_context_t, exr_result_t, const char*) {}

void check(exr_result_t result) {
  if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result != EXR_ERR_SUCCESS)
    throw IoError("", std::string("OpenEXR cannot hold the frame: ") + exr_get_default_error_message(result));
}

/// Bytes of the name of a channel or attribute, without the zero at its end, in a file that does not announce long
/// ones. Only files that have some announce them.
constexpr std::size_t kLongestShortName = 31;
bool has_long_names(std::span<const ExrChannel> channels, const ExrAttributes& attributes) {
  const auto is_long = [](const std::string& name) { return name.size() > kLongestShortName; };
  return std::ranges::any_of(channels, is_long, &ExrChannel::name) ||
         std::ranges::any_of(attributes, is_long,
                             [](const auto& attribute) -> const std::string& { return attribute.first; });
}

class Writer {
 public:
  explicit Writer(MemoryFile& memory) : memory_(memory) {
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.user_data = &memory;
    setup.write_fn = write_to_memory;
    setup.error_handler_fn = ignore_message;
    relook::check(exr_start_write(&file_, "frame", EXR_WRITE_FILE_DIRECTLY, &setup));
  }
  ~Writer() {
    if (file_ != nullptr) exr_finish(&file_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  [[nodiscard]] exr_context_t context() const { return file_; }
  void check(exr_result_t result) const {
    if (memory_.is_short_of_memory) throw std::bad_alloc();
    relook::check(result);
  }
  void finish() { check(exr_finish(&file_)); }

 private:
  MemoryFile& memory_;
  exr_context_t file_ = nullptr;
};

void write_header(const Writer& writer, std::uint32_t width, std::uint32_t height, std::span<const ExrChannel> channels,
                  const ExrAttributes& attributes) {
  const exr_context_t file = writer.context();
  const auto check = [&](exr_result_t result) { writer.check(result); };
  int part = 0;
  if (has_long_names(channels, attributes)) check(exr_set_longname_support(file, 1));
  check(exr_add_part(file, nullptr, EXR_STORAGE_TILED, &part));
  check(exr_initialize_required_attr_simple(file, part, static_cast<std::int32_t>(width),
                                            static_cast<std::int32_t>(height), EXR_COMPRESSION_ZIP));
  check(exr_set_tile_descriptor(file, part, kTileSize, kTileSize, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN));
  for (const ExrChannel& channel : channels) {
    const exr_pixel_type_t type = channel.format == PixelFormat::half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    check(exr_add_channel(file, part, channel.name.c_str(), type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
  }
  const exr_attr_chromaticities_t rec709{0.64F, 0.33F, 0.30F, 0.60F, 0.15F, 0.06F, 0.3127F, 0.3290F};
  check(exr_attr_set_chromaticities(file, part, "chromaticities", &rec709));
  for (const auto& [name, text] : attributes) check(exr_attr_set_string(file, part, name.c_str(), text.c_str()));
  check(exr_write_header(file));
}

}  // namespace

float stored_value(float value, PixelFormat format) {
  if (format == PixelFormat::float32) return value;
  half stored;
  stored.setBits(half_bits(value));
  return stored;
}

Bytes TileCompressor::zip(std::span<const unsigned char> raw) {
  split_.resize(raw.size());
  split_bytes(raw.data(), raw.size(), split_.data());
  Bytes packed = deflater_.zlib(split_);
  if (packed.size() < raw.size()) return packed;
  const BytesView bytes = std::as_bytes(raw);
  return {bytes.begin(), bytes.end()};
}

Bytes tiled_exr(std::uint32_t width, std::uint32_t height, std::span<const ExrChannel> channels,
                const ExrAttributes& attributes, std::span<const Bytes> tiles) {
  MemoryFile memory;
  constexpr std::size_t kHeaderBytes = 2048, kChunkHeaderBytes = 32;  // more than most have
  std::size_t size = kHeaderBytes;
  for (const Bytes& tile : tiles) size += tile.size() + kChunkHeaderBytes;
  memory.bytes.reserve(size);
  Writer writer(memory);
  write_header(writer, width, height, channels, attributes);
  const std::uint32_t tiles_across = tiles_along(width);
  for (std::uint32_t tile = 0; tile < tiles.size(); ++tile)
    writer.check(exr_write_tile_chunk(writer.context(), 0, static_cast<int>(tile % tiles_across),
                                      static_cast<int>(tile / tiles_across), 0, 0, tiles[tile].data(),
                                      tiles[tile].size()));
  writer.finish();
  return std::move(memory.bytes);
}

}  // namespace relook
