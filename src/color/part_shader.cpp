#include "color/part_shader.h"

#include <algorithm>
#include <deque>

#include "color/block_shading.h"

namespace relook {
namespace {

/// May a part whose nodes are all restricted be other than zero in this block? False only where its one lamp reaches no
/// node.
bool may_reach(const LayerPart& layer, const RayScene& scene, const TreeBlock& block) {
  const ColorPart& part = layer.part;
  if (part.all_lamps || part.lamp.is_none() || part.sources != 0) return true;
  const auto& order = scene.light_order();
  const auto place = static_cast<std::size_t>(std::ranges::find(order, part.lamp) - order.begin());
  return std::ranges::any_of(block.nodes, [&](const RayNode& node) {
    if (node.object.is_none()) return false;
    const ShadowState state = block.lights[node.first_light + place].state;
    return state == ShadowState::open || state == ShadowState::filtered;
  });
}

}  // namespace

struct PartShader::Impl {
  const ColorScene& scene;
  NodePrograms whole;
  BlockShading shading;
  std::span<const LayerPart> parts;
  std::deque<NodePrograms> programs;  // by part

  Impl(const ColorScene& s, ProgramTable& table, std::span<const LayerPart> all)
      : scene(s), whole(s, table), shading(s), parts(all) {
    for (const LayerPart& layer : parts) programs.emplace_back(s, table, layer.part);
  }

  void take(std::span<const std::uint32_t> roots, std::vector<Rgba>& out) const {
    out.resize(roots.size());
    for (std::size_t k = 0; k < roots.size(); ++k) out[k] = shading.colors().nodes[roots[k]];
  }
};

PartShader::PartShader(const ColorScene& scene, ProgramTable& programs, std::span<const LayerPart> parts)
    : impl_(std::make_unique<Impl>(scene, programs, parts)) {}
PartShader::~PartShader() = default;

void PartShader::shade(const TreeBlock& block, std::span<const std::uint32_t> roots,
                       std::vector<std::vector<Rgba>>& out) {
  Impl& s = *impl_;
  out.resize(s.parts.size());
  s.shading.shade_filters(block, s.whole);
  s.shading.shade_nodes(block, s.whole);
  for (std::size_t p = 0; p < s.parts.size(); ++p) {  // these first, since they need the nodes below as a whole
    if (!s.parts[p].at_first_hit) continue;
    s.shading.shade_nodes(block, s.programs[p], roots);
    s.take(roots, out[p]);
  }
  for (std::size_t p = 0; p < s.parts.size(); ++p) {
    if (s.parts[p].at_first_hit) continue;
    if (may_reach(s.parts[p], s.scene, block)) {
      s.shading.shade_nodes(block, s.programs[p]);
      s.take(roots, out[p]);
    } else {
      out[p].assign(roots.size(), Rgba(0, 0, 0, 0));
    }
  }
}

}  // namespace relook
