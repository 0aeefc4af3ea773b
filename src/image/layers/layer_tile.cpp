#include "image/layers/layer_tile.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "frame/exact_sum.h"

namespace relook {
namespace {

Uv first_uv(const Mesh& mesh, const Hit& hit) {
  if (mesh.uv[0].empty()) return Uv(0, 0);
  const auto& triangle = mesh.triangles[hit.primitive];
  const auto at = [&](std::size_t corner) { return mesh.uv[0][triangle[corner]]; };
  return at(0) * (1.0F - hit.u - hit.v) + at(1) * hit.u + at(2) * hit.v;
}

/// `scene` as its first hits need it, and with it nothing that only rays of Integrator::path reach.
Scene scene_of_first_hits(const Scene& scene) {
  Scene hits = scene;
  hits.integrator = Integrator::whitted;
  hits.light_order.clear();
  hits.ambient = Color(0, 0, 0);
  hits.environment = {};
  return hits;
}

}  // namespace

LayerScene::LayerScene(const Scene& scene, const ViewOptions& options, const FrameLayers& frame_layers)
    : view(options),
      layers(frame_layers),
      first_hits(scene.integrator == Integrator::path ? std::optional(scene_of_first_hits(scene)) : std::nullopt),
      rays(first_hits ? *first_hits : scene),
      level(tracer.build(rays)),
      grow{rays, &level, first_hits ? 1U : options.max_depth, 0} {
  if (has_halves(options)) halves.emplace(scene, options);
  for (const Object& object : scene.objects) {
    object_ids.push_back(cryptomatte_id(object.node));
    material_ids.push_back(object.material.is_none() ? 0 : cryptomatte_id(matte_name(scene.material(object.material))));
  }
}

LayerTile::LayerTile(const LayerScene& scene, ProgramTable& programs)
    : s_(scene),
      primary_(scene.rays.camera(), scene.view),
      shader_(scene.rays, programs, scene.layers.parts),
      columns_(scene.layers.channels.size()) {
  if (scene.halves) half_light_.emplace(*scene.halves);
}

const LayerColumns& LayerTile::columns(const TileRect& rect, const Frame& frame, const TileMask* changed,
                                       const PackedSums* sums, PackedSums& half) {
  const std::uint32_t samples = s_.view.samples;
  ChunkSize chunk(s_.grow.layout().lights);
  for (std::vector<float>& column : columns_) column.assign(rect.pixels(), 0.0F);
  for (std::uint32_t first = 0, last = 0; first < rect.pixels(); first = last) {
    last = std::min(first + std::max(1U, chunk.samples() / samples), rect.pixels());
    trace(rect, first, last);
    chunk.learn(block_, (last - first) * samples);
    for (std::uint32_t pixel = first; pixel < last; ++pixel) {
      const std::uint32_t sample = (pixel - first) * samples;
      set_parts(pixel, sample);
      set_first_hit(pixel, sample);
      set_mattes(pixel, sample);
    }
  }
  set_beauty(rect, frame, changed);
  settle_sums(rect.pixels());
  if (sums != nullptr) set_lights(*sums);
  if (half_light_) set_variance(rect, frame, half);
  return columns_;
}

void LayerTile::trace(const TileRect& rect, std::uint32_t first_pixel, std::uint32_t last_pixel) {
  const std::uint32_t first = first_pixel * s_.view.samples, last = last_pixel * s_.view.samples;
  block_.clear();
  roots_.clear();
  rays_.clear();
  primary_.append(rect, first, last, rays_);
  GrowCounters counters;
  trace_trees(s_.grow, rays_, first, block_, roots_, counters);
  shader_.shade(block_, roots_, colors_);
}

void LayerTile::put(std::size_t column, std::uint32_t pixel, std::initializer_list<float> values) {
  for (const float value : values) columns_[column++][pixel] = value;
}

void LayerTile::set_parts(std::uint32_t pixel, std::uint32_t first_sample) {
  const auto mean = [&](std::size_t part) { return pixel_color(colors_[part].data() + first_sample, s_.view.samples); };
  const Rgba albedo = mean(0);
  put(kAlbedoColumn, pixel, {albedo.r, albedo.g, albedo.b});
  for (const LayerSum& sum : s_.layers.sums)
    for (std::size_t k = 0; k < sum.parts; ++k) {
      const Rgba color = mean(sum.first_part + k);
      put(sum.first_column + 3 * k, pixel, {color.r, color.g, color.b});
    }
}

void LayerTile::set_first_hit(std::uint32_t pixel, std::uint32_t first_sample) {
  const RayNode* nearest = nullptr;
  std::uint32_t nearest_sample = 0;
  for (std::uint32_t sample = first_sample; sample < first_sample + s_.view.samples; ++sample) {
    const RayNode& node = block_.nodes[roots_[sample]];
    if (node.object.is_none() || (nearest != nullptr && nearest->length <= node.length)) continue;
    nearest = &node;
    nearest_sample = sample;
  }
  put(kDepthColumn, pixel, {kFarDepth});
  if (nearest == nullptr) return;
  const Camera& camera = s_.rays.camera();
  const Point& position = nearest->point.position;
  const Rgba normal = colors_[1][nearest_sample];
  const Uv uv = first_uv(*s_.rays.object(nearest->object).mesh, nearest->hit);
  put(kNormalColumn, pixel, {normal.r, normal.g, normal.b});
  const Point in_world(WidePoint(position) + camera.eye);
  put(kPositionColumn, pixel, {in_world.x, in_world.y, in_world.z});
  put(kDepthColumn, pixel, {position.dot(camera.forward)});
  put(kUvColumn, pixel, {uv.x, uv.y});
}

void LayerTile::set_mattes(std::uint32_t pixel, std::uint32_t first_sample) {
  std::array<float, 12> ranks{};
  const auto set = [&](const Cryptomatte& matte, std::size_t first_column, const std::vector<std::uint32_t>& id_of) {
    ids_.clear();
    for (std::uint32_t k = 0; k < s_.view.samples; ++k) {
      const RayNode& node = block_.nodes[roots_[first_sample + k]];
      if (!node.object.is_none()) ids_.push_back(id_of[node.object.index()]);
    }
    const std::span<float> values = std::span(ranks).first(matte.channel_count());
    matte.rank(ids_, values);
    for (std::size_t i = 0; i < values.size(); ++i) columns_[first_column + i][pixel] = values[i];
  };
  set(s_.layers.objects, s_.layers.object_column, s_.object_ids);
  set(s_.layers.materials, s_.layers.material_column, s_.material_ids);
}

void LayerTile::set_beauty(const TileRect& rect, const Frame& frame, const TileMask* changed) {
  const PixelFormat format = s_.layers.channels[kBeautyColumn].format;
  std::uint32_t pixel = 0;
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y)
    for (std::uint32_t x = rect.x0; x < rect.x1; ++x, ++pixel) {
      const Rgba& color = frame.pixels[std::size_t{y} * frame.width + x];
      for (int channel = 0; channel < 4; ++channel)
        put(kBeautyColumn + static_cast<std::size_t>(channel), pixel, {stored_value(color[channel], format)});
      if (changed != nullptr && ((*changed)[y - rect.y0] >> (x - rect.x0) & 1U) != 0)
        put(kChangedColumn, pixel, {1.0F});
    }
}

// Without a -0, which would be the sum of layers that are all -0, and of the frame never.
void LayerTile::set_lights(const PackedSums& sums) {
  const std::vector<LightColor>& colors = s_.layers.light_colors;
  require(sums.sums() == colors.size(), "a sum a light");
  for (std::size_t light = 0; light < colors.size(); ++light) {
    if (sums.is_zero(light)) continue;
    for (std::uint32_t pixel = 0; pixel < sums.pixels(); ++pixel) {
      const Color color = layer(sums, light, pixel, colors[light], s_.view.samples);
      put(s_.layers.light_column + 3 * light, pixel, {color.x + 0.0F, color.y + 0.0F, color.z + 0.0F});
    }
  }
}

void LayerTile::set_variance(const TileRect& rect, const Frame& frame, PackedSums& half) {
  if (half.empty()) half = PackedSums::pack(half_light_->trace(rect));
  std::uint32_t pixel = 0;
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y)
    for (std::uint32_t x = rect.x0; x < rect.x1; ++x, ++pixel) {
      const Rgba difference =
          half_light_->mean(half, pixel, s_.layers.light_colors) - frame.pixels[std::size_t{y} * frame.width + x];
      const Rgba variance = difference * difference * half_light_->scale();
      put(*s_.layers.variance_column, pixel, {variance.r, variance.g, variance.b});
    }
}

void LayerTile::settle_sums(std::uint32_t pixels) {
  for (const LayerSum& sum : s_.layers.sums) {
    terms_.resize(sum.parts + 1);
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel)
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const auto term = [&](std::size_t k) -> float& { return columns_[sum.first_column + 3 * k + channel][pixel]; };
        for (std::size_t k = 0; k < sum.parts; ++k) terms_[k] = term(k);
        settle_sum(terms_, columns_[kBeautyColumn + channel][pixel]);
        for (std::size_t k = 0; k < terms_.size(); ++k) term(k) = terms_[k];
      }
  }
}

}  // namespace relook
