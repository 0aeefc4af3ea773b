#include "image/tile_light.h"

#include "image/sampling.h"

namespace relook {

GrowScene grow_scene(const RayScene& scene, const Tracer::TopLevel* level, const ViewOptions& view,
                     std::uint32_t shadow_bits, const ObjectLevels* objects) {
  return {scene,           level,           view.max_depth,     shadow_bits,
          objects,         view.integrator, view.diffuse_depth, view.glossy_depth,
          view.transmission_depth};
}

std::vector<LightColor> colors_of(std::span<const LightSum> sums) {
  std::vector<LightColor> colors;
  colors.reserve(sums.size());
  for (const LightSum& sum : sums) colors.push_back(sum.color);
  return colors;
}

TilePrograms::TilePrograms(const ColorScene& scene)
    : scene_(scene),
      sums_(is_path() ? light_sums(scene.scene()) : std::vector<LightSum>()),
      places_(scene.scene(), sums_),
      colors_(colors_of(sums_)) {}

void TilePrograms::set_pixels(const TileRect& rect, const TileLight& light, std::uint32_t samples,
                              Frame& frame) const {
  std::uint32_t pixel = 0;
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
    Rgba* row = &frame.pixels[std::size_t{y} * frame.width];
    for (std::uint32_t x = rect.x0; x < rect.x1; ++x, ++pixel) row[x] = this->pixel(light, pixel, samples);
  }
}

Rgba TilePrograms::pixel(const TileLight& light, std::size_t pixel, std::uint32_t samples) const {
  return is_path() ? compose(light.sums, pixel, colors_, samples)
                   : pixel_color(&light.colors[pixel * samples], samples);
}

TileShading::TileShading(const TilePrograms& programs, std::uint32_t samples)
    : programs_(programs), samples_(samples) {
  if (programs.is_path())
    path_shader_.emplace(programs.scene(), programs.path(), programs.places());
  else
    shader_.emplace(programs.scene(), programs.whitted());
}

void TileShading::begin(const TileRect& rect, TileLight& light) const {
  if (programs_.is_path())
    light.sums = TileSums(programs_.places().count, rect.pixels());
  else
    light.colors.resize(sample_count(rect, samples_));
}

void TileShading::add(const TreeBlock& block, std::span<const std::uint32_t> roots, std::uint32_t first,
                      TileLight& light) {
  if (path_shader_)
    path_shader_->shade(block, samples_, TermSign::add, light.sums);
  else
    shader_->shade(block, roots, std::span(light.colors).subspan(first, roots.size()));
}

}  // namespace relook
