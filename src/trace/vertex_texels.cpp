#include "trace/vertex_texels.h"

#include "trace/surface.h"
#include "trace/tree/tree_block.h"

namespace relook {
namespace {

/// Do both images stand at the same coordinates?
bool are_mapped_alike(const TextureSlot& a, const TextureSlot& b) {
  return a.mapping == b.mapping && a.axis == b.axis && a.texcoord == b.texcoord;
}

}  // namespace

VertexTexels::VertexTexels(const RayNode& node, const RayObject& object, std::initializer_list<Slot> slots)
    : node_(node), object_(object) {
  const TextureSlot* before = nullptr;
  TextureCoordinates at;
  for (const Slot name : slots) {
    const TextureSlot& slot = object.material->slot(name);
    if (slot.kind != TextureKind::image) continue;
    if (before == nullptr || !are_mapped_alike(*before, slot))
      at = texture_coordinates(object, node.hit, node.point.local, slot);
    before = &slot;
    Placed& placed = placed_[count_++];
    placed.slot = name;
    find_taps(slot, at, node.footprint, placed.taps);
    prefetch(*slot.pyramid, placed.taps);
  }
}

Rgba VertexTexels::at(Slot slot) const {
  const TextureSlot& texture = object_.material->slot(slot);
  for (std::size_t k = 0; k < count_; ++k)
    if (placed_[k].slot == slot) return value_of(*texture.pyramid, placed_[k].taps);
  return texel_at(node_, object_, texture);
}

}  // namespace relook
