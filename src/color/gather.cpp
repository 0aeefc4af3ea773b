#include "color/gather.h"

#include "trace/surface.h"

namespace relook {
namespace {

/// What nodes and filters have in common.
struct HitView {
  const RayObject& object;
  const Hit& hit;
  const SurfacePoint& point;
  float footprint;
};

HitView view_of(const RayScene& scene, const RayNode& node) {
  return {scene.object(node.object), node.hit, node.point, node.footprint};
}
HitView view_of(const RayScene& scene, const FilterNode& filter) {
  return {scene.object(filter.object), filter.hit, filter.point, filter.footprint};
}

/// Inputs that nodes and filters share.
float surface_input(Input input, std::uint32_t detail, const Material& material, const HitView& view) {
  const int axis = static_cast<int>(detail & 15U);
  const auto slot = static_cast<Slot>(detail >> 4);
  switch (input) {
    case Input::position:
      return view.point.position[axis];
    case Input::normal:
      return view.point.shading[axis];
    case Input::geometric:
      return view.point.geometric[axis];
    case Input::footprint:
      return view.footprint;
    case Input::vertex_color:
      return vertex_color(*view.object.mesh, view.hit)[axis];
    case Input::tangent:
      return tangent_frame(view.object, view.hit, view.point, material.slot(slot)).tangent[axis];
    case Input::bitangent:
      return tangent_frame(view.object, view.hit, view.point, material.slot(slot)).bitangent[axis];
    case Input::coordinates: {
      const TextureCoordinates at = texture_coordinates(view.object, view.hit, view.point.local, material.slot(slot));
      return axis == 3 ? at.area_ratio : at.position[axis];
    }
    default:
      return 0;
  }
}

float tint(const TreeBlock& block, const RayNode& node, std::uint32_t detail, const BlockColors& colors) {
  const LightLink& link = block.lights[node.first_light + (detail >> 4)];
  float product = 1;
  for (std::uint32_t f = 0; f < link.filters; ++f)
    product *= colors.filters[link.first_filter + f][static_cast<int>(detail & 15U)];
  return product;
}

float node_input(Input input, std::uint32_t detail, const TreeBlock& block, const RayNode& node,
                 const BlockColors& colors) {
  const int channel = static_cast<int>(detail & 15U);
  switch (input) {
    case Input::view:
      return -node.ray.direction[channel];
    case Input::length:
      return node.length;
    case Input::child:
      return colors.nodes[node.child[detail >> 4]][channel];
    case Input::child_length:
      return block.nodes[node.child[detail & 15U]].length;
    case Input::tint:
      return tint(block, node, detail, colors);
    default:
      return 0;
  }
}

bool belongs_to_surface(Input input) {
  return input == Input::position || input == Input::normal || input == Input::geometric || input == Input::footprint ||
         input == Input::vertex_color || input == Input::tangent || input == Input::bitangent ||
         input == Input::coordinates;
}

}  // namespace

void gather(std::uint32_t payload, MaterialId material, const RayScene& scene, const TreeBlock& block, bool are_filters,
            std::span<const std::uint32_t> indices, const BlockColors& colors, Column& out) {
  const auto input = static_cast<Input>(payload & 0xFFU);
  const std::uint32_t detail = payload >> 8;
  if (belongs_to_surface(input)) {
    const Material& m = scene.scene().material(material);
    for (std::size_t lane = 0; lane < indices.size(); ++lane)
      out[lane] = are_filters ? surface_input(input, detail, m, view_of(scene, block.filters[indices[lane]]))
                              : surface_input(input, detail, m, view_of(scene, block.nodes[indices[lane]]));
  } else if (are_filters) {
    for (std::size_t lane = 0; lane < indices.size(); ++lane) out[lane] = block.filters[indices[lane]].length_inside;
  } else {
    for (std::size_t lane = 0; lane < indices.size(); ++lane)
      out[lane] = node_input(input, detail, block, block.nodes[indices[lane]], colors);
  }
}

}  // namespace relook
