#include "image/image_pieces.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "base/byte_columns.h"
#include "base/error.h"
#include "base/system/memory.h"

namespace relook {

std::uint64_t hit_bytes(const TileTrees& trees) {
  return trees.first_hit.capacity() * sizeof(std::uint32_t) + trees.hits.capacity() * sizeof(Hit);
}

namespace {

PieceHandler handler_of_trees(std::vector<TileTrees>& trees) {
  PieceHandler of_trees;
  of_trees.pack = [tiles = trees.data()](std::size_t tile) {
    ByteColumns columns;
    columns.append(tiles[tile].first_hit);
    columns.append(tiles[tile].hits);
    return columns.take();
  };
  of_trees.unpack = [tiles = trees.data()](std::size_t tile, BytesView bytes) {
    ByteColumnsReader columns(bytes);
    columns.next(tiles[tile].first_hit);
    columns.next(tiles[tile].hits);
  };
  of_trees.drop = [tiles = trees.data()](std::size_t tile) {
    give_back(tiles[tile].first_hit);
    give_back(tiles[tile].hits);
  };
  of_trees.may_be_missing = true;
  return of_trees;
}

PieceHandler handler_of_colors(std::vector<std::vector<Rgba>>& colors) {
  PieceHandler of_colors;
  of_colors.pack = [tiles = colors.data()](std::size_t tile) {
    ByteColumns columns;
    columns.append(tiles[tile]);
    return columns.take();
  };
  of_colors.unpack = [tiles = colors.data()](std::size_t tile, BytesView bytes) {
    ByteColumnsReader(bytes).next(tiles[tile]);
  };
  of_colors.drop = [tiles = colors.data()](std::size_t tile) { give_back(tiles[tile]); };
  return of_colors;
}

PieceHandler handler_of_sums(std::vector<PackedSums>& sums) {
  PieceHandler of_sums;
  of_sums.pack = [tiles = sums.data()](std::size_t tile) { return tiles[tile].to_bytes(); };
  of_sums.unpack = [tiles = sums.data()](std::size_t tile, BytesView bytes) {
    try {
      tiles[tile] = PackedSums::from_bytes(bytes);
    } catch (const InputError&) {
      throw IoError("", "what was evicted to disk is not read back as it was written");
    }
  };
  of_sums.drop = [tiles = sums.data()](std::size_t tile) { tiles[tile] = PackedSums(); };
  return of_sums;
}

}  // namespace

void add_image_pieces(Residency& residency, Image& image) {
  residency.add_kind(PieceKind::ray_trees, image.trees.size(), handler_of_trees(image.trees));
  residency.add_kind(PieceKind::sample_colors, image.sample_colors.size(), handler_of_colors(image.sample_colors));
  residency.add_kind(PieceKind::light_sums, image.light_sums.size(), handler_of_sums(image.light_sums));
}

void note_pieces(Residency& residency, std::size_t tile, const Image& image) {
  note_trees(residency, tile, image.trees[tile]);
  if (!image.sample_colors.empty()) note_colors(residency, tile, image.sample_colors[tile]);
  if (!image.light_sums.empty()) note_sums(residency, tile, image.light_sums[tile]);
}

std::vector<std::size_t> tiles_beyond(double share, const std::vector<TileTrees>& trees,
                                      std::span<const std::uint64_t> nodes) {
  std::vector<std::size_t> tiles(share < 1 ? trees.size() : 0);
  std::iota(tiles.begin(), tiles.end(), std::size_t{0});
  const auto depth = [&](std::size_t tile) {
    return static_cast<double>(nodes[tile]) / static_cast<double>(trees[tile].paths.size());
  };
  std::ranges::stable_sort(tiles, std::greater(), depth);
  double left = 0;
  for (const std::size_t tile : tiles) left += share * static_cast<double>(trees[tile].paths.size());
  std::erase_if(tiles, [&](std::size_t tile) {
    const auto samples = static_cast<double>(trees[tile].paths.size());
    if (samples > left) return false;
    left -= samples;
    return true;
  });
  return tiles;
}

void note_trees(Residency& residency, std::size_t tile, const TileTrees& trees, double hit_seconds) {
  if (has_hits(trees))
    residency.set(PieceKind::ray_trees, tile, hit_bytes(trees), static_cast<double>(trees.hits.size()) * hit_seconds);
}

void note_colors(Residency& residency, std::size_t tile, const std::vector<Rgba>& colors) {
  residency.set(PieceKind::sample_colors, tile, colors.size() * sizeof(Rgba), 0);
}

void note_sums(Residency& residency, std::size_t tile, const PackedSums& sums) {
  residency.set(PieceKind::light_sums, tile, sums.bytes(), 0);
}

}  // namespace relook
