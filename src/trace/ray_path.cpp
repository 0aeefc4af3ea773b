#include "trace/ray_path.h"

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "trace/path_cursor.h"

namespace relook {

PathId PathTable::intern(std::span<const std::uint32_t> path) {
  const std::uint64_t hash = hash_of(path);
  const auto [first, last] = ids_.equal_range(hash);
  for (auto it = first; it != last; ++it)
    if (std::ranges::equal(words(it->second), path)) return it->second;
  const PathId id(static_cast<std::uint32_t>(size()));
  words_.insert(words_.end(), path.begin(), path.end());
  offsets_.push_back(words_.size());
  ids_.emplace(hash, id);
  return id;
}

std::size_t PathTable::bytes() const {
  return words_.capacity() * sizeof(std::uint32_t) + offsets_.capacity() * sizeof(std::uint64_t) +
         ids_.size() * (sizeof(std::uint64_t) + sizeof(PathId) + 2 * sizeof(void*));
}

PathTable PathTable::from_columns(std::vector<std::uint32_t> words, std::vector<std::uint64_t> offsets) {
  require(!offsets.empty() && offsets.front() == 0 && offsets.back() == words.size(), "path columns fit together");
  PathTable table;
  table.words_ = std::move(words);
  table.offsets_ = std::move(offsets);
  table.ids_.reserve(table.size());
  for (std::uint32_t i = 0; i < table.size(); ++i) table.ids_.emplace(table.hash_of(table.words(PathId(i))), PathId(i));
  return table;
}

std::uint64_t PathTable::hash_of(std::span<const std::uint32_t> path) const { return hash64(std::as_bytes(path)); }

std::size_t hit_count(std::span<const std::uint32_t> words, std::size_t lights) {
  std::size_t hits = 0;
  for (PathCursor cursor(words, lights); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (!node.is_miss()) hits += 1 + node.filter_hits;
  }
  return hits;
}

std::vector<std::string> broken_invariants(std::span<const std::uint32_t> words, std::size_t objects,
                                           std::size_t lights) {
  std::vector<std::string> broken;
  const std::size_t light_words = (lights + 15) / 16;
  std::size_t i = 0;
  std::size_t expected = 1;  // nodes still owed: the root, then the children announced
  const auto left = [&](std::size_t count) { return words.size() - i >= count; };
  while (expected > 0 && broken.empty()) {
    if (!left(1)) return {"a node is missing"};
    const std::uint32_t object = words[i++];
    --expected;
    if (object == PathTable::kMissWord) continue;
    if (object >= objects) broken.push_back("object index out of range");
    if (!left(1 + light_words)) return {"a node is cut short"};
    const std::uint32_t flags = words[i++];
    if ((flags & ~0x0F1FU) != 0) broken.push_back("unknown flags");
    expected += static_cast<std::size_t>(std::popcount(flags & 0xFU));
    const std::size_t states = i;
    i += light_words;
    for (std::size_t light = 0; light < lights && broken.empty(); ++light) {
      if (shadow_state(words.subspan(states), light) != ShadowState::filtered) continue;
      if (!left(1)) return {"a filter count is missing"};
      const std::uint32_t count = words[i++];
      if (count == 0 || !left(count)) return {"a filter list is empty or cut short"};
      for (std::uint32_t f = 0; f < count; ++f)
        if (words[i++] >= objects) broken.push_back("filter object index out of range");
    }
  }
  if (broken.empty() && i != words.size()) broken.push_back("words after the last node");
  return broken;
}

}  // namespace relook
