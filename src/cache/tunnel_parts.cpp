#include "cache/tunnel_parts.h"

#include <numeric>

#include "base/error.h"
#include "cache/image_parts.h"
#include "region/cell_tunnels.h"

namespace relook {
namespace {

/// A tunnel of a cell, as stored.
struct StoredTunnel {
  std::uint32_t path, sections;
};
static_assert(sizeof(StoredTunnel) == 8 && sizeof(TunnelSection) == 64);

std::string section_name(const char* column, std::size_t tile_of_group) {
  return std::string(column) + std::to_string(tile_of_group);
}

}  // namespace

Bytes encode_tunnels(const CacheContent& content, std::size_t group, const CacheIdentity& identity,
                     const std::string& bound_to) {
  const auto [first, last] = cache_group(content.image, group);
  ContainerWriter writer;
  writer.add("bound_to", bytes_of(bound_to));
  std::vector<std::uint32_t> around_counts;
  std::vector<std::uint8_t> kept;
  Sections around;
  for (std::size_t tile = first; tile < last; ++tile) {
    const Sections& of_tile = content.around_tiles[tile];
    around_counts.push_back(static_cast<std::uint32_t>(of_tile.size()));
    around.insert(around.end(), of_tile.begin(), of_tile.end());
    kept.push_back(content.tunnels[tile].empty() ? 0 : 1);
  }
  writer.add_column("kept", kept, sizeof(std::uint8_t));
  writer.add_column("around_counts", around_counts, sizeof(std::uint32_t));
  writer.add_column("around", around, sizeof(TunnelSection));
  for (std::size_t tile = first; tile < last; ++tile) {
    if (content.tunnels[tile].empty()) continue;
    const TileTunnels::Cells cells = content.tunnels[tile].cells();
    std::vector<StoredTunnel> tunnels;
    for (std::size_t i = 0; i < cells.paths.size(); ++i)
      tunnels.push_back({cells.paths[i].index(), cells.section_counts[i]});
    writer.add_column(section_name("cells", tile - first), cells.counts, sizeof(std::uint8_t));
    writer.add_column(section_name("tunnels", tile - first), tunnels, sizeof(StoredTunnel));
    writer.add_column(section_name("sections", tile - first), cells.sections, sizeof(TunnelSection));
  }
  return writer.finish(identity);
}

TunnelReader::TunnelReader(const ByteSource& file, const CacheIdentity& identity, const StorageOptions& shape,
                           const Camera& camera, std::uint32_t samples, std::size_t group, const PathBounds& paths)
    : reader_(file, identity), of_region_(shape.tunnels.of_region), camera_(camera), samples_(samples), paths_(paths) {
  const TileGroup tiles = cache_group(camera, samples, group);
  first_ = tiles.first;
  // Of the group alone: a large image has many groups.
  const std::vector<std::uint8_t> levels = cell_levels(shape.tunnels, camera.width, camera.height);
  check_sound(levels.size() >= tiles.last, "the manifest allows no tunnels");
  levels_.assign(levels.begin() + static_cast<std::ptrdiff_t>(tiles.first),
                 levels.begin() + static_cast<std::ptrdiff_t>(tiles.last));
  const std::size_t count = tiles.last - tiles.first;
  constexpr std::uint64_t kBoundDigits = 64;
  check_sound(reader_.raw_bytes("bound_to") == kBoundDigits, "no two hashes in section bound_to");
  bound_to_ = reader_.text("bound_to");
  kept_ = reader_.column<std::uint8_t>("kept", count);
  const auto counts = reader_.column<std::uint32_t>("around_counts", count);
  const std::uint64_t sections = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  check_sections(sections, count, tiles.first, tiles.last);
  const auto all = reader_.column<TunnelSection>("around", sections);
  auto next = all.begin();
  for (std::size_t k = 0; k < count; ++k) {
    check_sound(kept_[k] <= 1, "neither yes nor no in section kept");
    around_.emplace_back(next, next + counts[k]);
    next += counts[k];
    const std::string broken = broken_tunnel(around_.back());
    check_sound(broken.empty(), broken, " in section around");
  }
}

/// Throws CacheDamage for more sections than there can be: each has a node of some tree in it, or is a tunnel's section
/// of the eye. `first`, `last`: the tiles [first, last) that they are of.
void TunnelReader::check_sections(std::uint64_t sections, std::uint64_t tunnels, std::size_t first,
                                  std::size_t last) const {
  std::uint64_t samples = 0;
  for (std::size_t tile = first; tile < last; ++tile)
    samples += sample_count(tile_rect(tile, camera_.width, camera_.height), samples_);
  check_sound(sections <= samples * paths_.most_words + tunnels, "more sections than the ray trees can have");
}

std::uint64_t TunnelReader::raw_bytes(std::size_t tile) const {
  const std::size_t k = tile - first_;
  return reader_.raw_bytes(section_name("cells", k)) + reader_.raw_bytes(section_name("tunnels", k)) +
         reader_.raw_bytes(section_name("sections", k));
}

TileTunnels TunnelReader::tunnels(std::size_t tile) const {
  const std::size_t k = tile - first_;
  const TileGrid grid(levels_.at(k));
  TileTunnels::Cells cells;
  cells.counts = reader_.column<std::uint8_t>(section_name("cells", k), grid.cells());
  const std::uint64_t count = std::accumulate(cells.counts.begin(), cells.counts.end(), std::uint64_t{0});
  std::uint64_t sections = 0;
  for (const StoredTunnel& tunnel : reader_.column<StoredTunnel>(section_name("tunnels", k), count)) {
    cells.paths.push_back(tunnel.path == PathId::none().index() ? PathId::none() : PathId(tunnel.path));
    cells.section_counts.push_back(tunnel.sections);
    sections += tunnel.sections;
  }
  check_sections(sections, count, tile, tile + 1);
  cells.sections = reader_.column<TunnelSection>(section_name("sections", k), sections);
  const std::vector<std::string> broken = broken_invariants(cells, grid, of_region_, paths_.count);
  check_sound(broken.empty(), broken.empty() ? "" : broken.front(), " in section " + section_name("sections", k));
  TileTunnels tunnels = TileTunnels::united(grid, cells, of_region_);
  check_sound(grid.regions() == 0 || relook::around(tunnels) == around(tile),
              "what is around a tile is not around its cells: section around");
  return tunnels;
}

}  // namespace relook
