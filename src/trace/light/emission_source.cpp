#include "trace/light/emission_source.h"

#include <algorithm>

#include "scene/texture/texture_mapping.h"
#include "trace/surface.h"

namespace relook {
namespace {

/// Second and third corner change places where the transform mirrors, so that the front shines.
std::array<std::uint32_t, 3> corners(const RayObject& object, std::uint32_t primitive) {
  std::array<std::uint32_t, 3> corners = object.mesh->triangles[primitive];
  if (object.flipped) std::swap(corners[1], corners[2]);
  return corners;
}

std::vector<EmissionTriangle> triangles_of(const TextureSlot& image, std::span<const EmissionSource::Placed> objects) {
  std::vector<EmissionTriangle> triangles;
  for (const EmissionSource::Placed& placed : objects) {
    const RayObject& object = *placed.object;
    const Mesh& mesh = *object.mesh;
    const Mapping mapping = effective_mapping(mesh, image);
    const bool has_image = image.kind == TextureKind::image && mapping != Mapping::solid;
    for (std::uint32_t primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
      const std::array<std::uint32_t, 3> at = corners(object, primitive);
      EmissionTriangle triangle;
      std::array<Uv, 3> uv;
      for (std::size_t c = 0; c < 3; ++c) {
        object.to_world.multVecMatrix(mesh.positions[at[c]], triangle.at[c]);
        if (has_image) uv[c] = transformed_uv(image, vertex_coordinates(mesh, image, mapping, at[c]));
      }
      if (has_image) triangle.mean = mean_luminance(*image.pyramid, uv, image.sampler);
      triangle.two_sided = !object.optics.culls_back;
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

std::vector<std::uint32_t> first_triangles(std::span<const EmissionSource::Placed> objects) {
  std::vector<std::uint32_t> first;
  std::size_t next = 0;
  for (const EmissionSource::Placed& placed : objects) {
    first.push_back(static_cast<std::uint32_t>(next));
    next += placed.object->mesh->triangles.size();
  }
  return first;
}

}  // namespace

EmissionSource::EmissionSource(const TextureSlot& image, std::vector<Placed> objects)
    : image_(image),
      objects_(std::move(objects)),
      first_(first_triangles(objects_)),
      light_(triangles_of(image_, objects_)) {
  for (std::uint32_t place = 0; place < objects_.size(); ++place) place_of_.emplace_back(objects_[place].id, place);
  std::ranges::sort(place_of_);
}

std::optional<LightSample> EmissionSource::sample(const Point& from, Uv u) const {
  const auto emitter = light_.sample(from, u);
  if (!emitter) return std::nullopt;
  const auto place = static_cast<std::size_t>(std::ranges::upper_bound(first_, emitter->triangle) - first_.begin()) - 1;
  Hit hit{emitter->triangle - first_[place], emitter->b1, emitter->b2};
  if (objects_[place].object->flipped) std::swap(hit.u, hit.v);
  return LightSample{emitter->way, emitter->distance, emitter->density, static_cast<std::uint32_t>(place), hit};
}

Color EmissionSource::radiance(std::uint32_t place, const Hit& hit) const {
  if (image_.kind == TextureKind::none) return {1, 1, 1};
  const RayObject& object = *objects_[place].object;
  const Mesh& mesh = *object.mesh;
  const std::array<std::uint32_t, 3>& corner = mesh.triangles[hit.primitive];
  const Point local = mesh.positions[corner[0]] * (1.0F - hit.u - hit.v) + mesh.positions[corner[1]] * hit.u +
                      mesh.positions[corner[2]] * hit.v;
  return emission_at(image_, object, hit, local);
}

float EmissionSource::density(ObjectId object, std::uint32_t primitive, const Point& from, const Direction& way,
                              float distance) const {
  const auto found = std::ranges::lower_bound(place_of_, object, {}, &std::pair<ObjectId, std::uint32_t>::first);
  if (found == place_of_.end() || found->first != object) return 0;
  return light_.density(first_[found->second] + primitive, from, way, distance);
}

bool EmissionSource::is_of(const TextureSlot& image, std::span<const Placed> objects) const {
  return image_ == image && std::ranges::equal(objects_, objects, [](const Placed& a, const Placed& b) {
           return a.id == b.id && a.object->mesh == b.object->mesh && a.object->to_world == b.object->to_world &&
                  a.object->optics.culls_back == b.object->optics.culls_back;
         });
}

Color emission_at(const TextureSlot& image, const RayObject& object, const Hit& hit, const Point& local) {
  if (image.kind == TextureKind::none) return {1, 1, 1};
  const Rgba value = texture_value(image, texture_coordinates(object, hit, local, image), 0);
  return {value.r, value.g, value.b};
}

}  // namespace relook
