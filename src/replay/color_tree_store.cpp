#include "replay/color_tree_store.h"

#include <algorithm>

namespace relook {
namespace {

/// Sets that reach few samples, or none, are cheap to keep, but not for ever.
constexpr std::size_t kMostSets = 64;
/// Of so many sets it is known what has been built before; an older one counts as new.
constexpr std::size_t kMostRemembered = 1024;

/// Could another structure of the material make other samples depend on the parameters?
bool may_reach_others(const ParameterSet& parameters, MaterialId restructured) {
  return parameters.fields_of(restructured) != 0 || !parameters.lights.empty() || parameters.ambient ||
         parameters.environment;
}

bool is_outdated(const TileColorTrees& tile, const ColorChange& change) {
  return std::ranges::any_of(tile.blocks, [&](const CompressedBlock& block) {
    return block.baked.depends_on(change.parameters) ||
           std::ranges::any_of(change.restructured, [&](MaterialId id) { return block.baked.has(id); });
  });
}

double weight(EvictionPolicy policy, const ColorTreeSet& set, const TileColorTrees& tile, std::uint64_t change) {
  PieceFacts facts;
  facts.bytes = std::max<std::size_t>(tile.bytes, 1);
  facts.return_seconds = tile.build_seconds;
  facts.last_use = set.last_change;
  facts.uses = set.uses;
  return eviction_weight(policy, facts, change);
}

}  // namespace

bool ColorTreeSet::is_valid() const { return std::ranges::all_of(tiles, &TileColorTrees::is_valid); }

const ParameterSet* ColorTreeStore::set_for(const ParameterSet& changed) const {
  if (!chosen_) return &changed;
  const auto found = std::ranges::find_if(*chosen_, [&](const ParameterSet& set) { return set.contains(changed); });
  return found != chosen_->end() ? &*found : nullptr;
}

ColorTreeSet& ColorTreeStore::of(const ParameterSet& parameters, std::uint64_t change) {
  auto found = std::ranges::find_if(sets_, [&](const auto& set) { return set->parameters == parameters; });
  if (found == sets_.end()) {
    sets_.push_back(std::make_shared<ColorTreeSet>(parameters, tile_count_, set_count_++));
    found = std::prev(sets_.end());
    (*found)->were_built = tiles_built(parameters);
  }
  (*found)->last_change = change_ = change;
  ++(*found)->uses;
  at_work_ = found->get();
  return **found;
}

std::shared_ptr<std::vector<std::uint8_t>> ColorTreeStore::tiles_built(const ParameterSet& parameters) {
  const auto found = std::ranges::find(built_, parameters, &Built::parameters);
  if (found != built_.end()) {
    std::rotate(found, std::next(found), built_.end());
  } else {
    if (built_.size() == kMostRemembered) built_.erase(built_.begin());
    built_.push_back({parameters, std::make_shared<std::vector<std::uint8_t>>(tile_count_, std::uint8_t{0})});
  }
  return built_.back().tiles;
}

void ColorTreeStore::note_colors(const ColorChange& change) {
  if (change.new_environment || !change.reassigned.empty()) clear();  // programs may go, or belong to others
  erase([&](const ColorTreeSet& set) {
    return std::ranges::any_of(change.restructured,
                               [&](MaterialId id) { return may_reach_others(set.parameters, id); });
  });
  for (const auto& set : sets_)
    for (TileColorTrees& tile : set->tiles)
      if (is_outdated(tile, change)) drop(tile);
}

void ColorTreeStore::note_trees(std::size_t tile) {
  for (const auto& set : sets_) drop(set->tiles[tile]);
}

void ColorTreeStore::keep(TileColorTrees& place, TileColorTrees tile) {
  bytes_ += tile.bytes;
  bytes_ -= place.bytes;
  place = std::move(tile);
}

void ColorTreeStore::erase(const std::function<bool(const ColorTreeSet&)>& condition) {
  std::erase_if(sets_, [&](const auto& set) {
    if (!condition(*set)) return false;
    for (const TileColorTrees& tile : set->tiles) bytes_ -= tile.bytes;
    return true;
  });
}

void ColorTreeStore::clear() {
  erase([](const ColorTreeSet&) { return true; });
}

void ColorTreeStore::list_victims(EvictionPolicy policy, std::uint64_t change, std::vector<Victim>& victims) {
  for (const auto& set : sets_) {
    if (set.get() == at_work_) continue;
    for (TileColorTrees& tile : set->tiles) {
      if (tile.samples.empty()) continue;
      const auto leave = [this, &tile, still = std::weak_ptr(set)] {
        const std::shared_ptr<ColorTreeSet> owner = still.lock();
        if (!owner || owner.get() == at_work_) return std::uint64_t{0};
        const std::uint64_t samples = tile.samples.size();
        drop(tile);
        return samples;
      };
      victims.push_back({weight(policy, *set, tile, change), leave});
    }
  }
}

std::uint64_t ColorTreeStore::trim() {
  at_work_ = nullptr;
  const std::uint64_t before = samples();
  std::uint64_t kept = before;
  if (kept > most_samples_) {
    struct Piece {
      TileColorTrees* tile;
      double weight;
    };
    std::vector<Piece> pieces;
    for (const auto& set : sets_)
      for (TileColorTrees& tile : set->tiles) {
        if (tile.samples.empty()) continue;
        pieces.push_back({&tile, weight(EvictionPolicy::weight, *set, tile, change_)});
      }
    std::ranges::sort(pieces, {}, &Piece::weight);
    for (const Piece& piece : pieces) {
      if (kept <= most_samples_) break;
      kept -= piece.tile->samples.size();
      drop(*piece.tile);
    }
  }
  erase([](const ColorTreeSet& set) {
    const bool is_empty =
        std::ranges::all_of(set.tiles, [](const TileColorTrees& tile) { return tile.samples.empty(); });
    return is_empty && !set.is_valid();
  });
  while (sets_.size() > kMostSets) {
    const auto oldest = std::ranges::min_element(sets_, {}, [](const auto& set) { return set->last_change; });
    erase([gone = oldest->get()](const ColorTreeSet& set) { return &set == gone; });
  }
  return before - samples();
}

std::uint64_t ColorTreeStore::samples() const {
  std::uint64_t sum = 0;
  for (const auto& set : sets_)
    for (const TileColorTrees& tile : set->tiles) sum += tile.samples.size();
  return sum;
}

}  // namespace relook
