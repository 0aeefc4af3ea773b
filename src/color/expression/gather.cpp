#include "color/expression/gather.h"

#include "trace/surface.h"

namespace relook {
namespace {

/// Calls read(lane, node or filter) for every lane.
template <class Read>
void for_each_lane(const Gathering& from, const Read& read) {
  const std::span<const std::uint32_t> indices = from.indices;
  if (from.are_filters)
    for (std::size_t lane = 0; lane < indices.size(); ++lane) read(lane, from.block.filters[indices[lane]]);
  else
    for (std::size_t lane = 0; lane < indices.size(); ++lane) read(lane, from.block.nodes[indices[lane]]);
}

/// Fills a column from nodes, which alone have this input.
template <class Read>
void from_nodes(const Gathering& from, float* out, const Read& read) {
  for (std::size_t lane = 0; lane < from.indices.size(); ++lane) out[lane] = read(from.block.nodes[from.indices[lane]]);
}

}  // namespace

void gather(Payload payload, const Gathering& from, const BlockColors& colors, float* out) {
  const int axis = static_cast<int>(payload.axis());
  const std::uint32_t which = payload.which();
  switch (payload.input()) {
    case Input::position:
      return for_each_lane(from, [&](std::size_t lane, const auto& hit) { out[lane] = hit.point.position[axis]; });
    case Input::normal:
      return for_each_lane(from, [&](std::size_t lane, const auto& hit) { out[lane] = hit.point.shading[axis]; });
    case Input::geometric:
      return for_each_lane(from, [&](std::size_t lane, const auto& hit) { out[lane] = hit.point.geometric[axis]; });
    case Input::footprint:
      return for_each_lane(from, [&](std::size_t lane, const auto& hit) { out[lane] = hit.footprint; });
    case Input::vertex_color:
      return for_each_lane(from, [&](std::size_t lane, const auto& hit) {
        out[lane] = vertex_color(*from.scene.object(hit.object).mesh, hit.hit)[axis];
      });
    case Input::length_inside:
      for (std::size_t lane = 0; lane < from.indices.size(); ++lane)
        out[lane] = from.block.filters[from.indices[lane]].length_inside;
      return;
    case Input::view:
      return from_nodes(from, out, [&](const RayNode& node) { return -node.ray.direction[axis]; });
    case Input::child:
      return from_nodes(from, out, [&](const RayNode& node) { return colors.nodes[node.child[which]][axis]; });
    case Input::child_length:
      return from_nodes(from, out, [&](const RayNode& node) {
        const RayNode& child = from.block.nodes[node.child[which]];
        return child.length - child.ray.travelled;
      });
    case Input::tint:
      return from_nodes(from, out, [&](const RayNode& node) {
        return tint(from.block.lights[node.first_light + which], axis, colors);
      });
    case Input::sum:  // no input of a hit
      return;
    case Input::child_direction:
      return from_nodes(
          from, out, [&](const RayNode& node) { return from.block.nodes[node.child[which]].ray.direction[axis]; });
    case Input::child_share:
      return from_nodes(from, out, [&](const RayNode& node) {
        return 1.0F / from.block.nodes[node.child[which]].ray.path.density;
      });
    case Input::alpha_floor:
      return from_nodes(from, out, [&](const RayNode& node) { return node.ray.path.alpha_floor; });
    case Input::cosine:
      for (std::size_t lane = 0; lane < from.indices.size(); ++lane)
        out[lane] = from.block.filters[from.indices[lane]].cosine;
      return;
    case Input::light_direction:
    case Input::light_weight:
    case Input::light_radiance:
      return;  // of light terms (color/path/path_programs.h)
  }
}

std::uint32_t mapping_key(const TextureSlot& slot) {
  const bool is_procedural = slot.kind == TextureKind::procedural;  // and so has another mapping in the place of uv
  return static_cast<std::uint32_t>(slot.mapping) << 24 | std::uint32_t{slot.axis} << 16 |
         std::uint32_t{slot.texcoord} << 8 | (is_procedural ? 1U : 0U);
}

void gather_coordinates(const TextureSlot& slot, const Gathering& from, Column* out) {
  for_each_lane(from, [&](std::size_t lane, const auto& hit) {
    const TextureCoordinates at = texture_coordinates(from.scene.object(hit.object), hit.hit, hit.point.local, slot);
    for (int axis = 0; axis < 3; ++axis) out[axis].lanes[lane] = at.position[axis];
    out[3].lanes[lane] = at.area_ratio;
  });
}

void gather_tangent_frames(const TextureSlot& slot, const Gathering& from, Column* out) {
  for_each_lane(from, [&](std::size_t lane, const auto& hit) {
    const TangentFrame frame = tangent_frame(from.scene.object(hit.object), hit.hit, hit.point, slot);
    for (int axis = 0; axis < 3; ++axis) {
      out[axis].lanes[lane] = frame.tangent[axis];
      out[axis + 3].lanes[lane] = frame.bitangent[axis];
    }
  });
}

}  // namespace relook
