#include "trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include "base/error.h"
#include "trace/embree_device.h"
#include "trace/same_crossing.h"
#include "trace/surface.h"

namespace relook {

struct Tracer::TopLevel::Impl {
  /// Objects under one Embree scene.
  struct Instances {
    SceneHandle scene;                                // null: no objects
    std::vector<Placed> placed;                       // by instance id; object null: hidden
    std::vector<std::shared_ptr<const Mesh>> meshes;  // keeps what the bottom levels point into
  };
  Instances base, overlay;
  std::vector<std::uint32_t> by_id;                                // instances of the base, sorted by object
  std::vector<std::pair<std::uint32_t, const RayObject*>> hidden;  // instances of the base, and what stood there
  bool counts_blockers = false;

  [[nodiscard]] bool meets_base() const { return hidden.size() < base.placed.size(); }
  [[nodiscard]] bool meets_overlay() const { return !overlay.placed.empty(); }
};

namespace {


/// What a filter callback needs, hung on Embree's context.
struct Query
#if RTC_VERSION_MAJOR >= 4
    : RTCRayQueryContext {
#else
    : RTCIntersectContext {
#endif
  const std::vector<Tracer::Placed>* placed = nullptr;
  const Ray* ray = nullptr;
  Meeting nearest;                             // intersect(), distance()
  float slack = 0;                             // intersect(), distance()
  std::optional<std::uint32_t> primitive;      // distance(): no other is met
  std::vector<Crossing>* crossings = nullptr;  // passes(), blockers()
  bool opaque_too = false;                     // blockers()
  bool is_short_of_memory = false;             // crossings are missing
};

void start(Query& query, const std::vector<Tracer::Placed>& placed) {
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&query);
#else
  rtcInitIntersectContext(&query);
#endif
  query.placed = &placed;
}

float largest_component(const Imath::V3f& v) {
  return std::max(std::max(std::fabs(v.x), std::fabs(v.y)), std::fabs(v.z));
}

/// Candidates up to this much further are still offered, so that equal distances always reach the tie rule: a box is
/// entered where rounding puts it, which for grazing rays is off by a share of the ray's coordinates, not of t alone.
float slack_of(const Ray& ray) { return 0x1p-17F * largest_component(ray.origin) / largest_component(ray.direction); }
float reach(float t, const Query& query) { return t + 1e-4F * t + query.slack; }

/// Is there a surface for light, or sight, that travels this way?
bool is_met(const RayObject& object, const Hit& hit, const Direction& travel) {
  if (object.optics.culls_back && is_back_face(object, hit.primitive, travel)) return false;
  return !object.optics.cut_out || is_covered(object, hit);
}

bool is_behind(const RayObject& object, const Meeting& candidate, const Query& query) {
  const Meeting& last = query.ray->behind;
  if (last.object.is_none() || !last.nearer_than(candidate)) return last.object.is_none();
  const bool may_be_same = last.object == candidate.object && candidate.t <= reach(last.t, query);
  return !may_be_same || !is_same_crossing(object, last.hit, candidate.hit, query.ray->direction);
}

void keep_nearest(const RTCFilterFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  const Tracer::Placed& placed = (*query.placed)[RTCHitN_instID(args->hit, 1, 0, 0)];
  if (placed.object == nullptr) {
    args->valid[0] = 0;
    return;
  }
  Meeting candidate;
  candidate.object = placed.id;
  candidate.hit = {RTCHitN_primID(args->hit, 1, 0), RTCHitN_u(args->hit, 1, 0), RTCHitN_v(args->hit, 1, 0)};
  candidate.t = RTCRayN_tfar(args->ray, 1, 0);
  candidate.key = placed.object->key;
  const bool accepted = candidate.nearer_than(query.nearest) && is_behind(*placed.object, candidate, query) &&
                        (!query.primitive || candidate.hit.primitive == *query.primitive) &&
                        is_met(*placed.object, candidate.hit, query.ray->direction);
  if (!accepted) {
    args->valid[0] = 0;
    return;
  }
  __builtin_prefetch(&placed.object->mesh->triangles[candidate.hit.primitive]);  // surface_point() reads it next
  query.nearest = candidate;
  RTCRayN_tfar(args->ray, 1, 0) = reach(candidate.t, query);
}

void collect_crossings(const RTCFilterFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  const Tracer::Placed& placed = (*query.placed)[RTCHitN_instID(args->hit, 1, 0, 0)];
  const Hit hit{RTCHitN_primID(args->hit, 1, 0), RTCHitN_u(args->hit, 1, 0), RTCHitN_v(args->hit, 1, 0)};
  const Direction way = query.ray->from_light ? -query.ray->direction : query.ray->direction;
  if (placed.object == nullptr || !is_met(*placed.object, hit, way)) {
    args->valid[0] = 0;
    return;
  }
  if (!placed.object->optics.passes_light && !query.opaque_too) return;  // the segment ends here
  try {
    query.crossings->push_back({placed.id, hit, RTCRayN_tfar(args->ray, 1, 0), placed.object->key});
  } catch (const std::exception&) {  // which Embree would take for its own
    query.is_short_of_memory = true;
    return;  // the segment ends here, to be thrown away
  }
  args->valid[0] = 0;
}

/// For objects without collect_crossings(). Asked after it at the others.
void reject_hidden(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  if ((*query.placed)[RTCHitN_instID(args->hit, 1, 0, 0)].object == nullptr) args->valid[0] = 0;
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
  r.tnear = ray.t_min;
  r.tfar = ray.t_max;
  r.time = 0;
  r.mask = 0xFFFFFFFFU;
  r.id = 0;
  r.flags = 0;
}

/// Looks for what is nearer than query.nearest.
void look_for_nearest(RTCScene scene, const std::vector<Tracer::Placed>& placed, Query& query) {
  start(query, placed);
  RTCRayHit ray_hit;
  set_ray(ray_hit.ray, *query.ray);
  // Nothing nearer than the last hit is looked for, less the slack: boxes in which that hit lies are entered, too.
  if (const Meeting& last = query.ray->behind; !last.object.is_none())
    ray_hit.ray.tnear = std::max(ray_hit.ray.tnear, 2 * last.t - reach(last.t, query));
  ray_hit.ray.tfar = reach(query.nearest.t, query);
  ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query;
  rtcIntersect1(scene, &ray_hit, &arguments);
#else
  rtcIntersect1(scene, &query, &ray_hit);
#endif
}

/// Appends the crossings. `any_hidden`: objects of `placed` are.
bool is_blocked(RTCScene scene, const std::vector<Tracer::Placed>& placed, bool any_hidden, Query& query) {
  start(query, placed);
  RTCRay shadow_ray;
  set_ray(shadow_ray, *query.ray);
#if RTC_VERSION_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query;
  if (any_hidden) {
    arguments.filter = reject_hidden;
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  }
  rtcOccluded1(scene, &shadow_ray, &arguments);
#else
  if (any_hidden) query.filter = reject_hidden;
  rtcOccluded1(scene, &query, &shadow_ray);
#endif
  return shadow_ray.tfar < 0;  // Embree's sign of an occluded ray
}

/// Embree may report a surface more than once, and in any order.
void put_in_order(std::vector<Crossing>& crossings) {
  if (crossings.size() < 2) return;
  std::ranges::sort(crossings, {}, place_on_segment);
  const auto repeated = std::ranges::unique(crossings, {}, place_on_segment);
  crossings.erase(repeated.begin(), repeated.end());
}

}  // namespace

struct Tracer::Impl {
  using Instances = TopLevel::Impl::Instances;
  EmbreeDevice device;
  bool count_blockers;
  struct BottomLevel {
    std::weak_ptr<const Mesh> mesh;  // expired: the address may belong to another mesh by now
    SceneHandle scene;               // built
  };
  std::map<std::pair<const Mesh*, bool>, BottomLevel> bottom_levels;  // by mesh and whether it reports crossings

  Impl(bool counts, MemoryMonitor monitor) : device(std::move(monitor)), count_blockers(counts) {}

  /// `reports_crossings`: shadow segments ask collect_crossings() at each hit; otherwise the first hit blocks them.
  RTCScene bottom_level(const std::shared_ptr<const Mesh>& mesh, bool reports_crossings) {
    const std::pair key(mesh.get(), reports_crossings);
    if (const auto known = bottom_levels.find(key); known != bottom_levels.end()) {
      if (known->second.mesh.lock() == mesh) return known->second.scene.get();
      bottom_levels.erase(known);
    }
    BottomLevel level{mesh, build_bottom_level(*mesh, reports_crossings)};  // whole, or not among the others
    return bottom_levels.emplace(key, std::move(level)).first->second.scene.get();
  }

  SceneHandle build_bottom_level(const Mesh& mesh, bool reports_crossings) {
    SceneHandle scene = device.new_scene();
    const GeometryHandle handle = device.new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
    const RTCGeometry geometry = handle.get();
    // Embree reads 16 bytes at the last vertex, so it gets a copy of its own.
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* triangles = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (positions == nullptr || triangles == nullptr) {
      device.check();
      throw std::bad_alloc();
    }
    for (const Point& p : mesh.positions) positions = std::copy_n(&p.x, 3, positions);
    for (const auto& t : mesh.triangles) triangles = std::copy_n(t.data(), 3, triangles);
    rtcSetGeometryIntersectFilterFunction(geometry, keep_nearest);
    if (reports_crossings) rtcSetGeometryOccludedFilterFunction(geometry, collect_crossings);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcCommitScene(scene.get());
    device.check();
    return scene;
  }

  GeometryHandle new_instance(const RayObject& object) {
    const SurfaceOptics& optics = object.optics;
    const bool reports_crossings = optics.passes_light || optics.cut_out || optics.culls_back || count_blockers;
    const RTCScene bottom = bottom_level(object.mesh, reports_crossings);
    GeometryHandle handle = device.new_geometry(RTC_GEOMETRY_TYPE_INSTANCE);
    const RTCGeometry instance = handle.get();
    rtcSetGeometryInstancedScene(instance, bottom);
    float columns[12];  // 3x4, column by column: Imath's rows are Embree's columns
    for (int column = 0; column < 4; ++column)
      std::copy_n(object.to_world[column], 3, columns + std::ptrdiff_t{3} * column);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(instance);
    return handle;
  }

  Instances build(std::span<const Placed> objects) {
    Instances instances;
    for (const Placed& placed : objects)
      if (placed.object->alive && !placed.object->mesh->triangles.empty()) instances.placed.push_back(placed);
    if (instances.placed.empty()) return instances;
    // An object alone would be the root of its top level and be met without the test of its box that it gets among
    // others; boxes of instances are rounded, so at silhouettes the two could disagree. Twice the same object makes it
    // a child.
    if (instances.placed.size() == 1) instances.placed.push_back(instances.placed.front());
    instances.scene = device.new_scene();
    for (std::size_t i = 0; i < instances.placed.size(); ++i) {
      const RayObject& object = *instances.placed[i].object;
      const GeometryHandle instance = new_instance(object);
      rtcAttachGeometryByID(instances.scene.get(), instance.get(), static_cast<unsigned>(i));
      instances.meshes.push_back(object.mesh);
    }
    rtcCommitScene(instances.scene.get());
    device.check();
    return instances;
  }
};

Tracer::TopLevel::TopLevel() = default;
Tracer::TopLevel::~TopLevel() = default;
Tracer::TopLevel::TopLevel(TopLevel&&) noexcept = default;
Tracer::TopLevel& Tracer::TopLevel::operator=(TopLevel&&) noexcept = default;
bool Tracer::TopLevel::empty() const { return !impl_ || (!impl_->meets_base() && !impl_->meets_overlay()); }

Tracer::Tracer(bool count_blockers, MemoryMonitor monitor)
    : impl_(std::make_unique<Impl>(count_blockers, std::move(monitor))) {}
Tracer::~Tracer() = default;

void Tracer::drop_unused() {
  std::erase_if(impl_->bottom_levels, [](auto& entry) { return entry.second.mesh.expired(); });
}

Tracer::TopLevel Tracer::build(std::span<const Placed> objects) {
  TopLevel level;
  level.impl_ = std::make_unique<TopLevel::Impl>();
  TopLevel::Impl& top = *level.impl_;
  top.base = impl_->build(objects);
  top.by_id.resize(top.base.placed.size());
  std::iota(top.by_id.begin(), top.by_id.end(), 0U);
  std::ranges::sort(top.by_id, {}, [&](std::uint32_t instance) { return top.base.placed[instance].id; });
  top.counts_blockers = impl_->count_blockers;
  return level;
}

Tracer::TopLevel Tracer::build(const RayScene& scene) {
  std::vector<Placed> all;
  all.reserve(scene.size());
  for (std::uint32_t i = 0; i < scene.size(); ++i) all.push_back({ObjectId(i), &scene.object(ObjectId(i))});
  return build(all);
}

void Tracer::replace(TopLevel& level, std::span<const ObjectId> hidden, std::span<const Placed> added) {
  if (!level.impl_) level = build(std::span<const Placed>());
  TopLevel::Impl::Instances overlay = impl_->build(added);  // first: where memory is short, the level stays as it is
  TopLevel::Impl& top = *level.impl_;
  std::vector<Placed>& placed = top.base.placed;
  top.hidden.reserve(placed.size() < 2 * hidden.size() ? placed.size() : 2 * hidden.size());
  for (const auto& [instance, object] : top.hidden) placed[instance].object = object;
  top.hidden.clear();
  for (const ObjectId id : hidden) {
    const auto id_of = [&](std::uint32_t instance) { return placed[instance].id; };
    for (const std::uint32_t instance : std::ranges::equal_range(top.by_id, id, {}, id_of))
      if (placed[instance].object != nullptr)
        top.hidden.emplace_back(instance, std::exchange(placed[instance].object, nullptr));
  }
  top.overlay = std::move(overlay);
}

Meeting Tracer::intersect(const TopLevel& level, const Ray& ray) {
  if (level.empty() || !is_traceable(ray)) return {};
  const TopLevel::Impl& top = *level.impl_;
  Query query;
  query.ray = &ray;
  query.slack = slack_of(ray);
  query.nearest.t = ray.t_max;
  query.nearest.key = ~std::uint64_t{0};
  if (top.meets_base()) look_for_nearest(top.base.scene.get(), top.base.placed, query);
  if (top.meets_overlay()) look_for_nearest(top.overlay.scene.get(), top.overlay.placed, query);
  if (query.nearest.object.is_none()) query.nearest.t = std::numeric_limits<float>::infinity();
  return query.nearest;
}

float Tracer::distance(const TopLevel& level, const Ray& ray, std::uint32_t primitive) {
  if (level.empty() || !is_traceable(ray)) return std::numeric_limits<float>::infinity();
  Query query;
  query.ray = &ray;
  query.slack = slack_of(ray);
  query.nearest.key = ~std::uint64_t{0};
  query.primitive = primitive;
  look_for_nearest(level.impl_->base.scene.get(), level.impl_->base.placed, query);
  return query.nearest.t;
}

bool Tracer::passes(const TopLevel& level, const Ray& ray, std::vector<Crossing>& crossings) {
  crossings.clear();
  if (level.empty() || !is_traceable(ray)) return true;
  const TopLevel::Impl& top = *level.impl_;
  Query query;
  query.ray = &ray;
  query.crossings = &crossings;
  const bool any_hidden = !top.hidden.empty();
  const bool is_free = !(top.meets_base() && is_blocked(top.base.scene.get(), top.base.placed, any_hidden, query)) &&
                       !(top.meets_overlay() && is_blocked(top.overlay.scene.get(), top.overlay.placed, false, query));
  if (query.is_short_of_memory) throw std::bad_alloc();
  if (is_free) put_in_order(crossings);
  return is_free;
}

void Tracer::blockers(const TopLevel& level, const Ray& ray, std::vector<Crossing>& crossings) {
  crossings.clear();
  if (level.empty() || !is_traceable(ray)) return;
  const TopLevel::Impl& top = *level.impl_;
  require(top.counts_blockers, "blockers are asked of a level that counts them");
  Query query;
  query.ray = &ray;
  query.crossings = &crossings;
  query.opaque_too = true;
  if (top.meets_base()) is_blocked(top.base.scene.get(), top.base.placed, false, query);
  if (top.meets_overlay()) is_blocked(top.overlay.scene.get(), top.overlay.placed, false, query);
  if (query.is_short_of_memory) throw std::bad_alloc();
  put_in_order(crossings);
}

}  // namespace relook
