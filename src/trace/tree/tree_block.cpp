#include "trace/tree/tree_block.h"

#include <cmath>

#include "scene/surface_optics.h"
#include "trace/tree/path_cursor.h"

namespace relook {
namespace {

/// The order of the factors is that of colour expressions (SurfaceTerms::coverage).
float coverage_at(const RayNode& node, const RayObject& object) {
  const TextureSlot& texture = object.material->slot(Slot::base_color);
  float alpha = object.material->base_color.a * texel_at(node, object, texture).a;
  if (!object.mesh->colors.empty()) alpha *= vertex_color(*object.mesh, node.hit).a;
  return alpha;
}

}  // namespace

Rgba texel_at(const RayNode& node, const RayObject& object, const TextureSlot& slot) {
  if (slot.kind == TextureKind::none) return {1, 1, 1, 1};
  return texture_value(slot, texture_coordinates(object, node.hit, node.point.local, slot), node.footprint);
}

CoverageChoice coverage_choice(const RayNode& node, const RayObject& object) {
  const PathState& path = node.ray.path;
  if (path.from.is_none() || !object.optics.transparent || !passes_by_coverage(*object.material)) return {};
  const CoverageBucket bucket = bucket_of_coverage(coverage_at(node, object));
  const bool passes = sample_number(path.key, path.history, Purpose::coverage) < passing_share(bucket);
  return {passes ? CoverageChoice::Way::passes : CoverageChoice::Way::stops, bucket};
}

void complete(RayNode& node, const RayObject& object, const CoverageChoice* coverage) {
  node.point = surface_point(object, node.hit, node.ray.direction);
  const Direction way = node.point.position - node.ray.origin;
  node.length = std::sqrt(way.dot(way));
  const float width = node.ray.cone_width + node.ray.cone_spread * node.length;
  node.has_back = object.blurs && !object.optics.bent;
  node.footprint = width / std::fmax(-node.ray.direction.dot(node.point.geometric), 0.05F);
  node.coverage = coverage != nullptr ? *coverage : coverage_choice(node, object);
}

float distance_slack(const RayNode& node, const RayObject& object) {
  constexpr float kUlps = 0x1p-17F;  // 128 units in the last place
  const Point& o = node.ray.origin;
  const float coordinates = std::fabs(o.x) + std::fabs(o.y) + std::fabs(o.z);
  const float cosine = std::fmax(-node.ray.direction.dot(node.point.geometric), 1e-4F);
  // On long thin triangles rounded barycentrics move the point along the triangle: it lies that far beside the ray.
  const Direction way = node.point.position - o;
  const Direction beside = way - node.ray.direction * way.dot(node.ray.direction);
  const float known = (kUlps * (node.length + coordinates) + 8 * node.point.offset) * object.condition;
  return (known + 2 * std::sqrt(beside.dot(beside))) / cosine;
}

std::span<const std::uint32_t> TreeBlock::blocker_entry(const LightLink& link) const {
  const std::uint32_t* entry = blocker_words.data() + link.first;
  return {entry, entry_size(entry[0], ShadowState::blocked)};
}

}  // namespace relook
