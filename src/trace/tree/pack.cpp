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
    words.push_back(node.object.index());
    words.push_back(NodeFlags(children_of(node), node.point.inside, node.cut).word());
    hits.push_back(node.hit);
    const std::size_t states = words.size();
    words.resize(states + LightStates::words_of(layout.lights));
    for (std::size_t light = 0; light < layout.lights; ++light) {
      const LightLink& link = block.lights[node.first_light + light];
      std::uint32_t& word = words[states + light / LightStates::kLights];
      LightStates with(word);
      with.set(light % LightStates::kLights, link.state);
      word = with.word();
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
