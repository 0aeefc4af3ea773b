#include "engine/compressed_edits.h"

#include <algorithm>

namespace relook {
namespace {

/// Sets that reach few samples, or none, are cheap to keep, but not for ever.
constexpr std::size_t kMostSets = 64;

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

}  // namespace

bool CompressedImage::is_valid() const { return std::ranges::all_of(tiles, &CompressedTile::is_valid); }

CompressedImage& CompressedEdits::of(const ParameterSet& parameters) {
  auto found = std::ranges::find_if(images_, [&](const auto& image) { return image->parameters == parameters; });
  if (found == images_.end()) {
    images_.push_back(std::make_unique<CompressedImage>(parameters, tile_count_));
    found = std::prev(images_.end());
  }
  (*found)->last_step = ++step_;
  return **found;
}

void CompressedEdits::note_colors(const ColorChange& change) {
  if (change.new_environment || !change.reassigned.empty()) clear();  // programs may go, or belong to others
  std::erase_if(images_, [&](const auto& image) {
    return std::ranges::any_of(change.restructured,
                               [&](MaterialId id) { return may_reach_others(image->parameters, id); });
  });
  for (const auto& image : images_)
    for (CompressedTile& tile : image->tiles)
      if (is_outdated(tile, change)) tile = {};
}

void CompressedEdits::note_trees(std::size_t tile) {
  for (const auto& image : images_) image->tiles[tile] = {};
}

std::uint64_t CompressedEdits::trim() {
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
        const auto age = static_cast<double>(1 + step_ - image->last_step);
        pieces.push_back({&tile, tile.build_seconds / (static_cast<double>(tile.bytes) * age)});
      }
    std::ranges::sort(pieces, {}, &Piece::weight);
    for (const Piece& piece : pieces) {
      if (kept <= most_samples_) break;
      kept -= piece.tile->samples.size();
      *piece.tile = {};
    }
  }
  std::erase_if(images_, [](const auto& image) {
    const bool is_empty =
        std::ranges::all_of(image->tiles, [](const CompressedTile& tile) { return tile.samples.empty(); });
    return is_empty && !image->is_valid();
  });
  while (images_.size() > kMostSets)
    images_.erase(std::ranges::min_element(images_, {}, [](const auto& image) { return image->last_step; }));
  return before - samples();
}

std::size_t CompressedEdits::bytes() const {
  std::size_t sum = 0;
  for (const auto& image : images_)
    for (const CompressedTile& tile : image->tiles) sum += sizeof(tile) + tile.bytes;
  return sum;
}

std::uint64_t CompressedEdits::samples() const {
  std::uint64_t sum = 0;
  for (const auto& image : images_)
    for (const CompressedTile& tile : image->tiles) sum += tile.samples.size();
  return sum;
}

}  // namespace relook
