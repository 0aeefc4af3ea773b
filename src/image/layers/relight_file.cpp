#include "image/layers/relight_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "frame/exr_tiles.h"
#include "frame/half_bits.h"
#include "scene/light_sums.h"

namespace relook {
namespace {

constexpr std::size_t kColors = 3;

/// The largest power of four that is not above a colour's brightest channel; 1 for black.
double scale_for(const std::array<double, 3>& color) {
  const double most = std::ranges::max(color);
  if (!(most > 0)) return 1;
  int exponent = 0;
  (void)std::frexp(most, &exponent);  // most = m 2^exponent, m in [1/2, 1)
  return std::ldexp(1.0, 2 * static_cast<int>(std::floor((exponent - 1) / 2.0)));
}

Json value_json(const std::string& pointer, const Json& value) {
  if (pointer.empty()) return nullptr;
  return {{"path", pointer}, {"value", value}};
}

/// Channels by place in 3 * layer + colour, in the order of the file.
std::vector<std::size_t> relight_order(const std::vector<ExrChannel>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) -> const std::string& { return channels[i].name; });
  return order;
}

std::vector<ExrChannel> relight_channels(const std::vector<RelightLayer>& layers) {
  std::vector<ExrChannel> channels;
  for (const RelightLayer& layer : layers)
    for (const char* color : {".R", ".G", ".B"}) channels.push_back({layer.name + color, PixelFormat::half});
  return channels;
}

/// Row by row, in a row channel by channel.
class LayerRows {
 public:
  LayerRows(const std::vector<RelightLayer>& layers, std::span<const std::size_t> order, std::uint32_t samples)
      : layers_(layers), order_(order), samples_(samples) {}

  [[nodiscard]] std::span<const unsigned char> bytes(const PackedSums& sums, const TileRect& rect) {
    const std::size_t pixels = rect.pixels(), width = rect.width();
    values_.resize(pixels);
    bytes_.assign(pixels * order_.size() * sizeof(std::uint16_t), 0);
    for (std::size_t place = 0; place < order_.size(); ++place) {
      const RelightLayer& layer = layers_[order_[place] / kColors];
      if (sums.is_zero(layer.sum)) continue;
      sums.channel_values(layer.sum, order_[place] % kColors, values_);
      put(layer.scale, place, pixels, width);
    }
    return bytes_;
  }

 private:
  void put(double scale, std::size_t place, std::size_t pixels, std::size_t width) {
    for (std::size_t row = 0; row * width < pixels; ++row) {
      unsigned char* out = &bytes_[(row * order_.size() + place) * width * sizeof(std::uint16_t)];
      for (std::size_t x = 0; x < width; ++x, out += sizeof(std::uint16_t)) {
        const std::uint16_t half =
            half_bits(static_cast<float>(scale * values_[row * width + x] / samples_) + 0.0F);  // no -0
        std::memcpy(out, &half, sizeof half);
      }
    }
  }

  const std::vector<RelightLayer>& layers_;
  std::span<const std::size_t> order_;
  std::uint32_t samples_;
  std::vector<double> values_;
  std::vector<unsigned char> bytes_;
};

}  // namespace

RelightTable::RelightTable(const SceneState& state) {
  const std::vector<LightSum> sums = light_sums(state.scene());
  controls = light_controls(state, sums);
  for (LightControl& control : controls)
    for (std::size_t& sum : control.sums) {
      layers.push_back({sums[sum].name, sum, scale_for(sums[sum].color)});
      sum = layers.size() - 1;
    }
  if (!layers.empty()) return;
  // A file has at least a channel.
  layers.push_back({sums.back().name, sums.size() - 1, 1});
  controls.push_back({LightControl::Kind::fixed, "", {0}, {1, 1, 1}, {}});
}

Json relight_json(const RelightTable& table) {
  Json layers = Json::array(), controls = Json::array();
  for (const RelightLayer& layer : table.layers) layers.push_back({{"name", layer.name}, {"scale", layer.scale}});
  for (const LightControl& control : table.controls) {
    Json settings = Json::array();
    for (const LightSetting& setting : control.settings)
      settings.push_back({{"color", value_json(setting.color_pointer, setting.color)},
                          {"intensity", value_json(setting.intensity_pointer, setting.intensity)}});
    controls.push_back({{"kind", control_kind_name(control.kind)},
                        {"name", control.name},
                        {"layers", control.sums},
                        {"unit", control.unit},
                        {"settings", std::move(settings)}});
  }
  return {{"layers", std::move(layers)}, {"controls", std::move(controls)}};
}

Bytes RelightEncoder::exr(const SceneState& state, const Image& image, const std::vector<std::uint32_t>& versions,
                          Residency& residency, const FrameMeta& meta) {
  const RelightTable table(state);
  const std::uint32_t width = image.frame.width, height = image.frame.height;
  const std::size_t count = tile_count(width, height);
  require(image.light_sums.size() == count, "relighting needs the sums of light of all tiles");
  const bool knows_versions = versions.size() == count;
  const std::vector<std::uint32_t> kept_versions = std::exchange(versions_, {});
  const bool may_share = knows_versions && layers_ == table.layers && kept_versions.size() == count;
  std::vector<Bytes> tiles = may_share ? std::move(tiles_) : std::vector<Bytes>(count);
  const std::vector<ExrChannel> channels = relight_channels(table.layers);
  const std::vector<std::size_t> order = relight_order(channels);
  Pool<TileCompressor> compressors;
  Pool<LayerRows> rows;
  parallel_for(count, [&](std::size_t tile) {
    if (may_share && kept_versions[tile] == versions[tile]) return;
    const auto worker = rows.take([&] { return std::make_unique<LayerRows>(table.layers, order, image.view.samples); });
    const auto compressor = compressors.take([] { return std::make_unique<TileCompressor>(); });
    const Residency::Lease lease = residency.use(PieceKind::light_sums, tile);
    tiles[tile] = compressor->zip(worker->bytes(image.light_sums[tile], tile_rect(tile, width, height)));
  });
  ExrAttributes attributes = frame_attributes(meta);
  attributes.emplace_back(kRelightAttribute, json_text(relight_json(table)));
  Bytes file = tiled_exr(width, height, channels, attributes, tiles);
  layers_ = table.layers;
  versions_ = keeps_tiles_ && knows_versions ? versions : std::vector<std::uint32_t>();
  tiles_ = keeps_tiles_ && knows_versions ? std::move(tiles) : std::vector<Bytes>();
  return file;
}

}  // namespace relook
