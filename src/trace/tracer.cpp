#include "trace/tracer.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/error.h"
#include "base/parallel.h"
#include "trace/surface.h"

namespace relook {

struct Tracer::TopLevel::Impl {
  RTCScene scene = nullptr;
  std::vector<Placed> placed;                       // by instance id
  std::vector<std::shared_ptr<const Mesh>> meshes;  // keeps what the bottom levels point into
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

namespace {

using TopLevelImpl = Tracer::TopLevel;

/// What a filter callback needs, hung on Embree's context.
struct Query
#if RTC_VERSION_MAJOR >= 4
    : RTCRayQueryContext {
#else
    : RTCIntersectContext {
#endif
  const std::vector<Tracer::Placed>* placed = nullptr;
  const Ray* ray = nullptr;                    // intersect(): unit direction
  Meeting nearest;                             // intersect()
  std::vector<Crossing>* crossings = nullptr;  // passes()
};

void start(Query& query, const std::vector<Tracer::Placed>& placed) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query);
#else
  rtcInitIntersectContext(&query);
#endif
  query.placed = &placed;
}

/// Candidates up to this much further are still offered, so that equal distances always reach the tie rule: a box is
/// entered where rounding puts it, which for grazing rays is off by a share of the ray's coordinates, not of t alone.
float reach(float t, const Ray& ray) {
  const float coordinates =
      std::max(std::max(std::fabs(ray.origin.x), std::fabs(ray.origin.y)), std::fabs(ray.origin.z));
  return t + 1e-4F * t + 0x1p-17F * coordinates;
}

void keep_nearest(const RTCFilterFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  const Tracer::Placed& placed = (*query.placed)[RTCHitN_instID(args->hit, 1, 0, 0)];
  Meeting candidate;
  candidate.object = placed.id;
  candidate.hit = {RTCHitN_primID(args->hit, 1, 0), RTCHitN_u(args->hit, 1, 0), RTCHitN_v(args->hit, 1, 0)};
  candidate.t = RTCRayN_tfar(args->ray, 1, 0);
  candidate.key = placed.object->key;
  const bool accepted = candidate.nearer_than(query.nearest) &&
                        (!placed.object->optics.cut_out || is_covered(*placed.object, candidate.hit));
  if (!accepted) {
    args->valid[0] = 0;
    return;
  }
  query.nearest = candidate;
  RTCRayN_tfar(args->ray, 1, 0) = reach(candidate.t, *query.ray);
}

void collect_crossings(const RTCFilterFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  const Tracer::Placed& placed = (*query.placed)[RTCHitN_instID(args->hit, 1, 0, 0)];
  const Hit hit{RTCHitN_primID(args->hit, 1, 0), RTCHitN_u(args->hit, 1, 0), RTCHitN_v(args->hit, 1, 0)};
  const SurfaceOptics& optics = placed.object->optics;
  if (optics.cut_out && !is_covered(*placed.object, hit)) {
    args->valid[0] = 0;
    return;
  }
  if (!optics.passes_light) return;  // opaque here: the segment ends
  query.crossings->push_back({placed.id, hit, RTCRayN_tfar(args->ray, 1, 0), placed.object->key});
  args->valid[0] = 0;
}

bool is_traceable(const Ray& ray) {
  constexpr float kLargest = 1e18F;
  const auto is_bounded = [](const Imath::V3f& v) {
    return std::fabs(v.x) < kLargest && std::fabs(v.y) < kLargest && std::fabs(v.z) < kLargest;
  };
  return is_bounded(ray.origin) && is_bounded(ray.direction) && ray.direction.dot(ray.direction) > 0 && ray.t_max > 0;
}

void set_ray(RTCRay& r, const Ray& ray) {
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.tnear = 0;
  r.tfar = ray.t_max;
  r.time = 0;
  r.mask = 0xFFFFFFFFU;
  r.id = 0;
  r.flags = 0;
}

}  // namespace

struct Tracer::Impl {
  RTCDevice device = nullptr;
  struct BottomLevel {
    std::weak_ptr<const Mesh> mesh;  // expired: the address may belong to another mesh by now
    RTCScene scene = nullptr;
  };
  std::map<std::pair<const Mesh*, bool>, BottomLevel> bottom_levels;  // by mesh and whether light may pass

  // At most AVX2: hosts that share a cache must agree in every bit, so they must run the same code.
  Impl() : device(rtcNewDevice("max_isa=avx2")) {
    if (device == nullptr) throw std::bad_alloc();
  }
  ~Impl() {
    for (auto& [mesh, level] : bottom_levels) rtcReleaseScene(level.scene);
    rtcReleaseDevice(device);
  }

  /// After building: Embree reports what went wrong only on request, and leaves its own float mode behind.
  void check() const {
    set_float_mode();
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    require(error == RTC_ERROR_NONE, "Embree builds its acceleration structures");
  }

  /// Drops the bottom levels of meshes that no object uses any more.
  void drop_unused() {
    std::erase_if(bottom_levels, [](auto& entry) {
      if (!entry.second.mesh.expired()) return false;
      rtcReleaseScene(entry.second.scene);
      return true;
    });
  }

  /// `may_pass_light`: shadow segments ask collect_crossings() at each hit; otherwise the first hit blocks them.
  RTCScene bottom_level(const std::shared_ptr<const Mesh>& mesh, bool may_pass_light) {
    BottomLevel& level = bottom_levels[{mesh.get(), may_pass_light}];
    if (level.scene != nullptr && level.mesh.lock() == mesh) return level.scene;
    if (level.scene != nullptr) rtcReleaseScene(level.scene);
    level.mesh = mesh;
    level.scene = rtcNewScene(device);
    rtcSetSceneFlags(level.scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads 16 bytes at the last vertex, so it gets a copy of its own.
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh->positions.size()));
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh->triangles.size()));
    if (positions == nullptr || triangles == nullptr) throw std::bad_alloc();
    for (const Point& p : mesh->positions) positions = std::copy_n(&p.x, 3, positions);
    for (const auto& t : mesh->triangles) triangles = std::copy_n(t.data(), 3, triangles);
    rtcSetGeometryIntersectFilterFunction(geometry, keep_nearest);
    if (may_pass_light) rtcSetGeometryOccludedFilterFunction(geometry, collect_crossings);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(level.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(level.scene);
    return level.scene;
  }
};

Tracer::TopLevel::TopLevel() = default;
Tracer::TopLevel::~TopLevel() = default;
Tracer::TopLevel::TopLevel(TopLevel&&) noexcept = default;
Tracer::TopLevel& Tracer::TopLevel::operator=(TopLevel&&) noexcept = default;
bool Tracer::TopLevel::empty() const { return !impl_ || impl_->placed.empty(); }

Tracer::Tracer() : impl_(std::make_unique<Impl>()) {}
Tracer::~Tracer() = default;

Tracer::TopLevel Tracer::build(std::span<const Placed> objects) {
  impl_->drop_unused();
  TopLevel level;
  level.impl_ = std::make_unique<TopLevel::Impl>();
  TopLevel::Impl& top = *level.impl_;
  top.scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(top.scene, RTC_SCENE_FLAG_ROBUST);
  for (const Placed& placed : objects)
    if (placed.object->alive && !placed.object->mesh->triangles.empty()) top.placed.push_back(placed);
  // An object alone would be the root of its top level and be met without the test of its box that it gets among
  // others; boxes of instances are rounded, so at silhouettes the two could disagree. Twice the same object makes it a
  // child.
  if (top.placed.size() == 1) top.placed.push_back(top.placed.front());
  for (std::size_t i = 0; i < top.placed.size(); ++i) {
    const RayObject& object = *top.placed[i].object;
    RTCGeometry instance = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, impl_->bottom_level(object.mesh, object.optics.passes_light || object.optics.cut_out));
    float columns[12];  // 3x4, column by column: Imath's rows are Embree's columns
    for (int column = 0; column < 4; ++column)
      std::copy_n(object.to_world[column], 3, columns + std::ptrdiff_t{3} * column);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(top.scene, instance, static_cast<unsigned>(i));
    rtcReleaseGeometry(instance);
    top.meshes.push_back(object.mesh);
  }
  rtcCommitScene(top.scene);
  impl_->check();
  return level;
}

Tracer::TopLevel Tracer::build(const RayScene& scene) {
  std::vector<Placed> all;
  all.reserve(scene.size());
  for (std::uint32_t i = 0; i < scene.size(); ++i) all.push_back({ObjectId(i), &scene.object(ObjectId(i))});
  return build(all);
}

Meeting Tracer::intersect(const TopLevel& level, const Ray& ray) {
  if (level.empty() || !is_traceable(ray)) return {};
  Query query;
  start(query, level.impl_->placed);
  query.ray = &ray;
  query.nearest.t = ray.t_max;
  query.nearest.key = ~std::uint64_t{0};
  RTCRayHit ray_hit;
  set_ray(ray_hit.ray, ray);
  ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query;
  rtcIntersect1(level.impl_->scene, &ray_hit, &arguments);
#else
  rtcIntersect1(level.impl_->scene, &query, &ray_hit);
#endif
  if (query.nearest.object.is_none()) query.nearest.t = std::numeric_limits<float>::infinity();
  return query.nearest;
}

bool Tracer::passes(const TopLevel& level, const Ray& ray, std::vector<Crossing>& crossings) {
  crossings.clear();
  if (level.empty() || !is_traceable(ray)) return true;
  Query query;
  start(query, level.impl_->placed);
  query.crossings = &crossings;
  RTCRay shadow_ray;
  set_ray(shadow_ray, ray);
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query;
  rtcOccluded1(level.impl_->scene, &shadow_ray, &arguments);
#else
  rtcOccluded1(level.impl_->scene, &query, &shadow_ray);
#endif
  if (shadow_ray.tfar < 0) return false;  // Embree's sign of an occluded ray
  if (crossings.size() < 2) return true;
  const auto place = [](const Crossing& c) { return std::tuple(c.t, c.key, c.hit.primitive); };
  std::sort(crossings.begin(), crossings.end(),
            [&](const Crossing& a, const Crossing& b) { return place(a) < place(b); });
  const auto same = [&](const Crossing& a, const Crossing& b) { return place(a) == place(b); };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());
  return true;
}

}  // namespace relook
