#include "color/gather.h"

#include "trace/surface.h"

namespace relook {
namespace {

/// Calls read(lane, node or filter) for every lane.
template <class Read>
void for_each_lane(const Batch& batch, const Read& read) {
  const std::span<const std::uint32_t> indices = batch.indices;
  if (batch.are_filters)
    for (std::size_t lane = 0; lane < indices.size(); ++lane) read(lane, batch.block.filters[indices[lane]]);
  else
    for (std::size_t lane = 0; lane < indices.size(); ++lane) read(lane, batch.block.nodes[indices[lane]]);
}

/// Fills a column from nodes, which alone have this input.
template <class Read>
void from_nodes(const Batch& batch, Column& out, const Read& read) {
  for (std::size_t lane = 0; lane < batch.indices.size(); ++lane)
    out[lane] = read(batch.block.nodes[batch.indices[lane]]);
}

/// The product of the filters between a node and a light.
float tint(const TreeBlock& block, const RayNode& node, std::uint32_t light, int channel, const BlockColors& colors) {
  const LightLink& link = block.lights[node.first_light + light];
  float product = 1;
  for (std::uint32_t f = 0; f < link.filters; ++f) product *= colors.filters[link.first + f][channel];
  return product;
}

}  // namespace

void gather(std::uint32_t payload, const Batch& batch, const BlockColors& colors, Column& out) {
  const std::uint32_t detail = payload >> 8;
  const int axis = static_cast<int>(detail & 15U);
  const std::uint32_t which = detail >> 4;
  switch (static_cast<Input>(payload & 0xFFU)) {
    case Input::position:
      return for_each_lane(batch, [&](std::size_t lane, const auto& hit) { out[lane] = hit.point.position[axis]; });
    case Input::normal:
      return for_each_lane(batch, [&](std::size_t lane, const auto& hit) { out[lane] = hit.point.shading[axis]; });
    case Input::geometric:
      return for_each_lane(batch, [&](std::size_t lane, const auto& hit) { out[lane] = hit.point.geometric[axis]; });
    case Input::footprint:
      return for_each_lane(batch, [&](std::size_t lane, const auto& hit) { out[lane] = hit.footprint; });
    case Input::vertex_color:
      return for_each_lane(batch, [&](std::size_t lane, const auto& hit) {
        out[lane] = vertex_color(*batch.scene.object(hit.object).mesh, hit.hit)[axis];
      });
    case Input::length_inside:
      for (std::size_t lane = 0; lane < batch.indices.size(); ++lane)
        out[lane] = batch.block.filters[batch.indices[lane]].length_inside;
      return;
    case Input::view:
      return from_nodes(batch, out, [&](const RayNode& node) { return -node.ray.direction[axis]; });
    case Input::child:
      return from_nodes(batch, out, [&](const RayNode& node) { return colors.nodes[node.child[which]][axis]; });
    case Input::child_length:
      return from_nodes(batch, out, [&](const RayNode& node) { return batch.block.nodes[node.child[detail]].length; });
    case Input::tint:
      return from_nodes(batch, out, [&](const RayNode& node) { return tint(batch.block, node, which, axis, colors); });
  }
}

void gather_coordinates(const TextureSlot& slot, const Batch& batch, Column* out) {
  for_each_lane(batch, [&](std::size_t lane, const auto& hit) {
    const TextureCoordinates at = texture_coordinates(batch.scene.object(hit.object), hit.hit, hit.point.local, slot);
    for (int axis = 0; axis < 3; ++axis) out[axis][lane] = at.position[axis];
    out[3][lane] = at.area_ratio;
  });
}

void gather_tangent_frames(const TextureSlot& slot, const Batch& batch, Column* out) {
  for_each_lane(batch, [&](std::size_t lane, const auto& hit) {
    const TangentFrame frame = tangent_frame(batch.scene.object(hit.object), hit.hit, hit.point, slot);
    for (int axis = 0; axis < 3; ++axis) {
      out[axis][lane] = frame.tangent[axis];
      out[axis + 3][lane] = frame.bitangent[axis];
    }
  });
}

}  // namespace relook
