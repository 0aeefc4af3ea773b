#include "trace/tree/ray_path.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "trace/shadow/shadow_counter.h"
#include "trace/tree/path_cursor.h"

namespace relook {
namespace {

std::uint32_t hash_of(std::span<const std::uint32_t> path) {
  return static_cast<std::uint32_t>(hash64(std::as_bytes(path)));
}

}  // namespace

PathId PathTable::intern(std::span<const std::uint32_t> path) {
  reserve(size() + 1);
  const std::uint32_t hash = hash_of(path);
  Place& place = place_of(path, hash);
  if (!place.id.is_none()) return place.id;
  if (size() >= PathId::none().index()) throw std::bad_alloc();  // more than ids can tell
  const PathId id(static_cast<std::uint32_t>(size()));
  words_.insert(words_.end(), path.begin(), path.end());
  offsets_.push_back(words_.size());
  place = {id, hash};
  return id;
}

PathTable::Place& PathTable::place_of(std::span<const std::uint32_t> path, std::uint32_t hash) {
  const std::size_t mask = index_.size() - 1;
  for (std::size_t i = hash & mask;; i = (i + 1) & mask) {
    Place& place = index_[i];
    if (place.id.is_none() || (place.hash == hash && std::ranges::equal(words(place.id), path))) return place;
  }
}

void PathTable::reserve(std::size_t paths) {
  if (2 * paths <= index_.size()) return;
  const std::vector<Place> old =
      std::exchange(index_, std::vector<Place>(std::bit_ceil(std::max<std::size_t>(2 * paths, 16))));
  const std::size_t mask = index_.size() - 1;
  for (const Place& place : old) {
    if (place.id.is_none()) continue;
    std::size_t i = place.hash & mask;
    while (!index_[i].id.is_none()) i = (i + 1) & mask;
    index_[i] = place;
  }
}

std::size_t PathTable::bytes() const {
  return words_.capacity() * sizeof(std::uint32_t) + offsets_.capacity() * sizeof(std::uint64_t) +
         index_.capacity() * sizeof(Place);
}

PathTable PathTable::from_columns(std::vector<std::uint32_t> words, std::vector<std::uint64_t> offsets) {
  require(!offsets.empty() && offsets.front() == 0 && offsets.back() == words.size(), "path columns fit together");
  PathTable table;
  table.words_ = std::move(words);
  table.offsets_ = std::move(offsets);
  table.reserve(table.size());
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    const std::span<const std::uint32_t> path = table.words(PathId(i));
    const std::uint32_t hash = hash_of(path);
    Place& place = table.place_of(path, hash);
    if (place.id.is_none()) place = {PathId(i), hash};
  }
  return table;
}

std::size_t hit_count(std::span<const std::uint32_t> words, const PathLayout& layout) {
  std::size_t hits = 0;
  for (PathCursor cursor(words, layout); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (!node.is_miss()) hits += 1 + node.filter_hits;
  }
  return hits;
}

namespace {

/// What is malformed about the entry that `words` starts with, "" if nothing; `size`: its length.
std::string broken_entry(std::span<const std::uint32_t> words, ShadowState state, std::size_t objects,
                         std::uint32_t shadow_bits, std::size_t& size) {
  if (words.empty()) return "the count of a light's surfaces is missing";
  const std::size_t count = words[0];
  const bool is_blocked = state == ShadowState::blocked;
  size = entry_size(words[0], state);
  if ((count == 0 && !is_blocked) || words.size() < size) return "a light's list of surfaces is empty or cut short";
  for (const std::uint32_t object : words.subspan(1, count))
    if (object >= objects) return "object index of a transparent surface out of range";
  bool counts_any = false;
  for (const std::uint32_t counter : words.subspan(1 + count, size - 1 - count)) {
    if (!ShadowCounter::is_sound(counter, shadow_bits)) return "a shadow counter has too many bits";
    counts_any = counts_any || counter != 0;
  }
  return is_blocked && !counts_any ? "a blocked light has no blocker" : "";
}

}  // namespace

std::vector<std::string> broken_invariants(std::span<const std::uint32_t> words, std::size_t objects,
                                           const PathLayout& layout) {
  std::vector<std::string> broken;
  const std::size_t light_words = LightStates::words_of(layout.lights);
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
    const NodeFlags flags = NodeFlags::of_word(words[i++]);
    if (!flags.is_sound()) broken.push_back("unknown flags");
    expected += flags.branches().size();
    const std::size_t states = i;
    i += light_words;
    for (std::size_t light = 0; light < layout.lights; ++light) {
      const ShadowState state = shadow_state(words.subspan(states), light);
      if (!has_entry(state, layout.shadow_bits)) continue;
      std::size_t size = 0;
      std::string broken_list = broken_entry(words.subspan(i), state, objects, layout.shadow_bits, size);
      if (!broken_list.empty()) return {std::move(broken_list)};
      i += size;
    }
  }
  if (broken.empty() && i != words.size()) broken.push_back("words after the last node");
  return broken;
}

}  // namespace relook
