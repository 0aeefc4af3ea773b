#include "image/layers/layered_frame.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "frame/half_bits.h"
#include "image/layers/layer_tile.h"

namespace relook {
namespace {

/// Places of the channels in the order of the file.
std::vector<std::size_t> file_order(const std::vector<ExrChannel>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) -> const std::string& { return channels[i].name; });
  return order;
}

std::vector<unsigned char> tile_bytes(const LayerColumns& columns, const TileRect& rect, const FrameLayers& layers,
                                      std::span<const std::size_t> order) {
  std::vector<unsigned char> bytes;
  bytes.reserve(std::size_t{rect.pixels()} * order.size() * sizeof(float));
  const auto append = [&](const auto& value) {
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  const std::uint32_t width = rect.width();
  for (std::uint32_t first = 0; first < rect.pixels(); first += width)
    for (const std::size_t channel : order)
      for (std::uint32_t pixel = first; pixel < first + width; ++pixel) {
        const float value = columns[channel][pixel];
        if (layers.channels[channel].format == PixelFormat::half)
          append(half_bits(value));
        else
          append(value);
      }
  return bytes;
}

/// By tile; null where nothing has changed.
std::vector<const TileMask*> masks_by_tile(const ChangedPixels& changed, std::size_t tiles) {
  std::vector<const TileMask*> masks(tiles, nullptr);
  for (const ChangedPixels::Tile& tile : changed.tiles()) masks[tile.tile] = &tile.mask;
  return masks;
}

/// Where the sums of a tile's first half are kept, empty if what is there is of other samples; null: nowhere.
PackedSums* kept_half(const LayeredFrame& layered, std::size_t tile) {
  if (layered.halves == nullptr || layered.versions == nullptr || layered.versions->empty()) return nullptr;
  PackedSums& half = layered.halves->sums[tile];
  std::uint32_t& version = layered.halves->versions[tile];
  if (version != (*layered.versions)[tile]) half = PackedSums();
  version = (*layered.versions)[tile];
  return &half;
}

}  // namespace

Bytes encode_layered_exr(const LayeredFrame& layered, const FrameMeta& meta, const Progress& progress) {
  const Frame& frame = layered.frame;
  const FrameLayers layers(layered.scene, layered.view.samples, layered.format);
  const std::vector<std::size_t> order = file_order(layers.channels);
  const LayerScene scene(layered.scene, layered.view, layers);
  std::vector<Bytes> tiles(tile_count(frame.width, frame.height));
  const std::vector<const TileMask*> masks = masks_by_tile(layered.changed, tiles.size());

  const bool is_path = layered.scene.integrator == Integrator::path;
  require(!is_path || (layered.light_sums != nullptr && layered.light_sums->size() == tiles.size()),
          "layers of path need the sums of light of all tiles");

  if (layered.halves != nullptr) {
    layered.halves->sums.resize(tiles.size());
    layered.halves->versions.resize(tiles.size());
  }
  ProgramTable programs;
  Pool<LayerTile> workers;
  Pool<TileCompressor> compressors;
  std::size_t done = 0;
  std::mutex progress_mutex;
  parallel_for(tiles.size(), [&](std::size_t tile) {
    const TileRect rect = tile_rect(tile, frame.width, frame.height);
    const auto worker = workers.take([&] { return std::make_unique<LayerTile>(scene, programs); });
    const auto compressor = compressors.take([] { return std::make_unique<TileCompressor>(); });
    const Residency::Lease lease = is_path && layered.residency != nullptr
                                       ? layered.residency->use(PieceKind::light_sums, tile)
                                       : Residency::Lease();
    const PackedSums* const sums = is_path ? &(*layered.light_sums)[tile] : nullptr;
    PackedSums traced;
    PackedSums* const kept = kept_half(layered, tile);
    const LayerColumns& columns = worker->columns(rect, frame, masks[tile], sums, kept != nullptr ? *kept : traced);
    tiles[tile] = compressor->zip(tile_bytes(columns, rect, layers, order));
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(static_cast<double>(++done) / static_cast<double>(tiles.size()));
  });
  ExrAttributes attributes = frame_attributes(meta);
  attributes.insert(attributes.end(), layers.attributes.begin(), layers.attributes.end());
  return tiled_exr(frame.width, frame.height, layers.channels, attributes, tiles);
}

}  // namespace relook
