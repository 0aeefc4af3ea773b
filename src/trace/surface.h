// Points on surfaces: everything that follows from an object, a hit and the incoming direction (the paper's PDI, 2.2).
// Pure functions: the same bits whether the hit was just traced or comes out of a cache.
#pragma once
#include "base/math.h"
#include "physics/normal_map.h"
#include "scene/texture/texel_taps.h"
#include "trace/ray_scene.h"
#include "trace/tree/ray_tree.h"

namespace relook {

struct SurfacePoint {
  Point position{0, 0, 0};    // world
  Point local{0, 0, 0};       // object space
  Normal geometric{0, 0, 1};  // unit, turned against the incoming direction
  Normal shading{0, 0, 1};    // unit, interpolated, on the side of `geometric`; no normal map yet
  bool inside = false;        // the back of the triangle was met
  float offset = 0;           // metres along `geometric` that clear the surface of rounding errors
  Direction lift{0, 0, 0};    // from `position` to the smooth surface that the vertex normals stand for, world
};

/// `direction`: unit, the way the ray travels.
[[nodiscard]] SurfacePoint surface_point(const RayObject& object, const Hit& hit, Direction direction);

/// Where a texture slot is read at a hit, before its KHR_texture_transform. `area_ratio`: area in texture coordinates
/// over area in the world, of the triangle.
struct TextureCoordinates {
  Point position{0, 0, 0};  // uv in x and y; solid mapping: object-space position
  float area_ratio = 0;
};
[[nodiscard]] TextureCoordinates texture_coordinates(const RayObject& object, const Hit& hit, const Point& local,
                                                     const TextureSlot& slot);

/// The value of a texture slot. `footprint`: ray-cone width over the cosine of incidence, metres. Requires kind !=
/// none.
[[nodiscard]] Rgba texture_value(const TextureSlot& slot, const TextureCoordinates& at, float footprint);

/// Finds its texels and their shares. Requires kind image.
void find_taps(const TextureSlot& slot, const TextureCoordinates& at, float footprint, TexelTaps& taps);

/// Where a procedural texture is evaluated. Requires kind procedural.
[[nodiscard]] Point procedural_position(const TextureSlot& slot, const TextureCoordinates& at);

/// The axes of a normal map at a hit, world space.
using TangentFrame = MapAxes<Direction>;
[[nodiscard]] TangentFrame tangent_frame(const RayObject& object, const Hit& hit, const SurfacePoint& point,
                                         const TextureSlot& slot);

/// The shading normal bent by a normal map: `texel` is the map's value, `scale` its strength.
[[nodiscard]] Normal mapped_normal(const TangentFrame& frame, const SurfacePoint& point, Rgba texel, float scale);

/// COLOR_0 at a hit, (1, 1, 1, 1) without vertex colours.
[[nodiscard]] Rgba vertex_color(const Mesh& mesh, const Hit& hit);

/// Does a ray meet the triangle from behind? `direction`: of any length, the way the ray travels.
[[nodiscard]] bool is_back_face(const RayObject& object, std::uint32_t primitive, Direction direction);

/// Coverage of a cut-out (alpha MASK) at a hit: false where there is a hole. Texture level 0.
[[nodiscard]] bool is_covered(const RayObject& object, const Hit& hit);

}  // namespace relook
