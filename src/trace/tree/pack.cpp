#include "trace/tree/pack.h"

#include "trace/tree/path_cursor.h"

namespace relook {

void pack(const TreeBlock& block, std::uint32_t root, const PathLayout& layout, std::vector<std::uint32_t>& words,
          std::vector<Hit>& hits) {
  const std::uint32_t sample = block.nodes[root].sample;
  for (std::size_t i = root; i < block.nodes.size() && block.nodes[i].sample == sample; ++i) {
    const RayNode& node = block.nodes[i];
    if (node.object.is_none()) {
      words.push_back(PathTable::kMissWord);
      continue;
    }
    std::uint8_t branches = 0;
    for (std::size_t b = 0; b < kBranches; ++b)
      if (node.child[b] != kNoNode) branches = static_cast<std::uint8_t>(branches | 1U << b);
    const std::uint32_t flags = branch_flags(branches) | (node.point.inside ? kInsideFlag : 0U) |
                                static_cast<std::uint32_t>(node.cut_mask) << kCutShift;
    words.push_back(node.object.index());
    words.push_back(flags);
    hits.push_back(node.hit);
    const std::size_t states = words.size();
    words.resize(states + (layout.lights + 15) / 16);
    for (std::size_t light = 0; light < layout.lights; ++light) {
      const LightLink& link = block.lights[node.first_light + light];
      words[states + light / 16] |= static_cast<std::uint32_t>(link.state) << (2 * (light % 16));
      if (!has_entry(link.state, layout.shadow_bits)) continue;
      if (link.state == ShadowState::blocked) {
        const auto entry = block.blocker_entry(link);
        words.insert(words.end(), entry.begin(), entry.end());
        continue;
      }
      words.push_back(link.filters);
      for (std::uint32_t f = 0; f < link.filters; ++f) {
        const FilterNode& filter = block.filters[link.first + f];
        words.push_back(filter.object.index());
        hits.push_back(filter.hit);
      }
    }
  }
}

}  // namespace relook
