#include "replay/compressed_edits.h"

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

bool is_outdated(const CompressedTile& tile, const ColorChange& change) {
  return std::ranges::any_of(tile.blocks, [&](const CompressedBlock& block) {
    return block.baked.depends_on(change.parameters) ||
           std::ranges::any_of(change.restructured, [&](MaterialId id) { return block.baked.has(id); });
  });
}

double weight(EvictionPolicy policy, const CompressedImage& image, const CompressedTile& tile, std::uint64_t change) {
  PieceFacts facts;
  facts.bytes = std::max<std::size_t>(tile.bytes, 1);
  facts.return_seconds = tile.build_seconds;
  facts.last_use = image.last_change;
  facts.uses = image.uses;
  return eviction_weight(policy, facts, change);
}

}  // namespace

bool CompressedImage::is_valid() const { return std::ranges::all_of(tiles, &CompressedTile::is_valid); }

const ParameterSet* CompressedEdits::set_for(const ParameterSet& changed) const {
  if (!chosen_) return &changed;
  const auto found = std::ranges::find_if(*chosen_, [&](const ParameterSet& set) { return set.contains(changed); });
  return found != chosen_->end() ? &*found : nullptr;
}

CompressedImage& CompressedEdits::of(const ParameterSet& parameters, std::uint64_t change) {
  auto found = std::ranges::find_if(images_, [&](const auto& image) { return image->parameters == parameters; });
  if (found == images_.end()) {
    images_.push_back(std::make_shared<CompressedImage>(parameters, tile_count_, sets_++));
    found = std::prev(images_.end());
    (*found)->were_built = tiles_built(parameters);
  }
  (*found)->last_change = change_ = change;
  ++(*found)->uses;
  at_work_ = found->get();
  return **found;
}

std::shared_ptr<std::vector<std::uint8_t>> CompressedEdits::tiles_built(const ParameterSet& parameters) {
  const auto found = std::ranges::find(built_, parameters, &Built::parameters);
  if (found != built_.end()) {
    std::rotate(found, std::next(found), built_.end());
  } else {
    if (built_.size() == kMostRemembered) built_.erase(built_.begin());
    built_.push_back({parameters, std::make_shared<std::vector<std::uint8_t>>(tile_count_, std::uint8_t{0})});
  }
  return built_.back().tiles;
}

void CompressedEdits::note_colors(const ColorChange& change) {
  if (change.new_environment || !change.reassigned.empty()) clear();  // programs may go, or belong to others
  erase([&](const CompressedImage& image) {
    return std::ranges::any_of(change.restructured,
                               [&](MaterialId id) { return may_reach_others(image.parameters, id); });
  });
  for (const auto& image : images_)
    for (CompressedTile& tile : image->tiles)
      if (is_outdated(tile, change)) drop(tile);
}

void CompressedEdits::note_trees(std::size_t tile) {
  for (const auto& image : images_) drop(image->tiles[tile]);
}

void CompressedEdits::keep(CompressedTile& place, CompressedTile tile) {
  bytes_ += tile.bytes;
  bytes_ -= place.bytes;
  place = std::move(tile);
}

void CompressedEdits::erase(const std::function<bool(const CompressedImage&)>& condition) {
  std::erase_if(images_, [&](const auto& image) {
    if (!condition(*image)) return false;
    for (const CompressedTile& tile : image->tiles) bytes_ -= tile.bytes;
    return true;
  });
}

void CompressedEdits::clear() {
  erase([](const CompressedImage&) { return true; });
}

void CompressedEdits::list_victims(EvictionPolicy policy, std::uint64_t change, std::vector<Victim>& victims) {
  for (const auto& image : images_) {
    if (image.get() == at_work_) continue;
    for (CompressedTile& tile : image->tiles) {
      if (tile.samples.empty()) continue;
      const auto leave = [this, &tile, still = std::weak_ptr(image)] {
        const std::shared_ptr<CompressedImage> owner = still.lock();
        if (!owner || owner.get() == at_work_) return std::uint64_t{0};
        const std::uint64_t samples = tile.samples.size();
        drop(tile);
        return samples;
      };
      victims.push_back({weight(policy, *image, tile, change), leave});
    }
  }
}

std::uint64_t CompressedEdits::trim() {
  at_work_ = nullptr;
  const std::uint64_t before = samples();
  std::uint64_t kept = before;
  if (kept > most_samples_) {
    struct Piece {
      CompressedTile* tile;
      double weight;
    };
    std::vector<Piece> pieces;
    for (const auto& image : images_)
      for (CompressedTile& tile : image->tiles) {
        if (tile.samples.empty()) continue;
        pieces.push_back({&tile, weight(EvictionPolicy::weight, *image, tile, change_)});
      }
    std::ranges::sort(pieces, {}, &Piece::weight);
    for (const Piece& piece : pieces) {
      if (kept <= most_samples_) break;
      kept -= piece.tile->samples.size();
      drop(*piece.tile);
    }
  }
  erase([](const CompressedImage& image) {
    const bool is_empty =
        std::ranges::all_of(image.tiles, [](const CompressedTile& tile) { return tile.samples.empty(); });
    return is_empty && !image.is_valid();
  });
  while (images_.size() > kMostSets) {
    const auto oldest = std::ranges::min_element(images_, {}, [](const auto& image) { return image->last_change; });
    erase([gone = oldest->get()](const CompressedImage& image) { return &image == gone; });
  }
  return before - samples();
}

std::uint64_t CompressedEdits::samples() const {
  std::uint64_t sum = 0;
  for (const auto& image : images_)
    for (const CompressedTile& tile : image->tiles) sum += tile.samples.size();
  return sum;
}

}  // namespace relook
