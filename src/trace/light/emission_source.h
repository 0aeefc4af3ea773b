// The surfaces of an emitting material as a light: its triangles in the world, which object and primitive each is, and
// what it sends out there.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/emission_light.h"
#include "trace/light/light_sample.h"
#include "trace/ray_object.h"

namespace relook {

class EmissionSource {
 public:
  struct Placed {
    ObjectId id;
    std::shared_ptr<const RayObject> object;  // alive
  };
  /// `image`: that multiplies the emission. `objects`: increasing by key, so that samples do not depend on ids.
  EmissionSource(const TextureSlot& image, std::vector<Placed> objects);

  /// A point that shines towards `from`.
  [[nodiscard]] std::optional<LightSample> sample(const Point& from, Uv u) const;
  /// What a sample's point sends out for unit colour and intensity.
  [[nodiscard]] Color radiance(std::uint32_t place, const Hit& hit) const;
  /// With which sample() gives the point that a ray meets; 0 for objects that it does not know.
  [[nodiscard]] float density(ObjectId object, std::uint32_t primitive, const Point& from, const Direction& way,
                              float distance) const;
  /// Is it never sampled?
  [[nodiscard]] bool empty() const { return light_.empty(); }
  /// Is it made of these?
  [[nodiscard]] bool is_of(const TextureSlot& image, std::span<const Placed> objects) const;

 private:
  TextureSlot image_;
  std::vector<Placed> objects_;
  std::vector<std::uint32_t> first_;                    // by place in objects_: its first triangle
  std::vector<std::pair<ObjectId, std::uint32_t>> place_of_;  // by id, increasing: its place in objects_
  EmissionLight light_;
};

/// The radiance of an emitting surface at a hit for unit colour and intensity, at the image's level 0.
[[nodiscard]] Color emission_at(const TextureSlot& image, const RayObject& object, const Hit& hit, const Point& local);

}  // namespace relook
