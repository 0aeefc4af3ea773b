#include "bare_rays.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <chrono>
#include <map>

#include "base/parallel.h"
#include "image/sampling.h"
#include "image/tile_light.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/grow.h"

namespace relook {
namespace {

struct TileRays {
  std::vector<Ray> rays, shadows;
};

/// The rays and shadow segments of one tile, sample by sample, in the order in which the full render shoots them.
TileRays rays_of(const RayScene& ray_scene, const Image& image, std::size_t tile) {
  const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
  const GrowScene grow = grow_scene(ray_scene, nullptr, image.view, image.view.shadow_bits);
  const PrimaryRays primaries(ray_scene.camera(), image.view);
  TileRays result;
  GrowCounters counters;
  TreeBlock block;
  for (std::uint32_t sample = 0; sample < sample_count(rect, image.view.samples); ++sample) {
    const TileTrees& trees = image.trees[tile];
    const StoredTree stored{PathCursor(image.paths.words(trees.paths[sample]), grow.layout()),
                            trees.hits_of(sample)};
    block.clear();
    expand_tree(grow, primaries.ray(rect, sample), sample, stored, block, counters);
    for (const RayNode& node : block.nodes) {
      result.rays.push_back({node.ray.origin, node.ray.direction});
      for (std::size_t light = 0; !node.object.is_none() && light < ray_scene.light_order().size(); ++light) {
        if (block.lights[node.first_light + light].state == ShadowState::facing_away) continue;
        const ShadowSegment segment = shadow_segment(node, ray_scene.light(light));
        result.shadows.push_back({segment.origin, segment.direction, segment.t_max});
      }
    }
  }
  return result;
}

RTCScene bottom_level(RTCDevice device, const Mesh& mesh) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
  auto* triangles = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangles.size()));
  for (const Point& p : mesh.positions) positions = std::copy_n(&p.x, 3, positions);
  for (const auto& t : mesh.triangles) triangles = std::copy_n(t.data(), 3, triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

RTCScene top_level(RTCDevice device, const RayScene& ray_scene) {
  std::map<const Mesh*, RTCScene> meshes;
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (std::uint32_t i = 0; i < ray_scene.size(); ++i) {
    const RayObject& object = ray_scene.object(ObjectId(i));
    if (!object.alive) continue;
    RTCScene& mesh = meshes[object.mesh.get()];
    if (mesh == nullptr) mesh = bottom_level(device, *object.mesh);
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, mesh);
    float columns[12];
    for (int column = 0; column < 4; ++column)
      std::copy_n(object.to_world[column], 3, columns + std::ptrdiff_t{3} * column);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(instance);
    rtcAttachGeometry(scene, instance);
    rtcReleaseGeometry(instance);
  }
  for (auto& [mesh, bottom] : meshes) rtcReleaseScene(bottom);
  rtcCommitScene(scene);
  return scene;
}

RTCRay embree_ray(const Ray& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0,
          ray.t_max,
          0xFFFFFFFFU,
          0,
          0};
}

void shoot(RTCScene scene, const TileRays& tile) {
  for (const Ray& ray : tile.rays) {
    RTCRayHit hit{};
    hit.ray = embree_ray(ray);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(scene, &hit, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect1(scene, &context, &hit);
#endif
  }
  for (const Ray& ray : tile.shadows) {
    RTCRay shadow = embree_ray(ray);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(scene, &shadow, nullptr);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &shadow);
#endif
  }
}

}  // namespace

BareRays time_bare_rays(const Scene& scene, const Image& image, int passes) {
  const RayScene ray_scene(scene);
  std::vector<TileRays> tiles(image.trees.size());
  parallel_for(tiles.size(), [&](std::size_t tile) { tiles[tile] = rays_of(ray_scene, image, tile); });
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene level = top_level(device, ray_scene);
  BareRays result;
  for (const TileRays& tile : tiles) {
    result.rays += tile.rays.size();
    result.shadow_segments += tile.shadows.size();
  }
  for (int pass = 0; pass < passes; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    parallel_for(tiles.size(), [&](std::size_t tile) { shoot(level, tiles[tile]); });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (pass == 0 || seconds < result.seconds) result.seconds = seconds;
  }
  rtcReleaseScene(level);
  rtcReleaseDevice(device);
  return result;
}

}  // namespace relook
