#include "image/stored_image.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "base/parallel.h"
#include "base/system/memory.h"
#include "color/path/tile_vertices.h"
#include "image/sampling.h"
#include "trace/tree/pack.h"

namespace relook {
namespace {

/// `colors`: of the samples from `first` on.
void put_on_top(const SampleColors& shown, std::uint32_t first, std::vector<Rgba>& colors) {
  const auto found = std::ranges::lower_bound(shown.samples, first);
  for (auto k = static_cast<std::size_t>(found - shown.samples.begin());
       k < shown.samples.size() && shown.samples[k] < first + colors.size(); ++k)
    colors[shown.samples[k] - first] = shown.colors[k];
}

/// The hits of a tile with new ones in place of the old ones.
TileTrees with_hits_of(const SampleTrees& fresh, TileTrees trees) {
  TileTrees next;
  next.first_hit.reserve(trees.first_hit.size());
  next.first_hit.push_back(0);
  next.hits.reserve(trees.hits.size());
  const auto keep = [&](std::size_t from, std::size_t to) {
    if (from == to) return;  // there may be none at all
    const std::uint32_t begin = trees.first_hit[from];
    const std::size_t here = next.hits.size();
    next.hits.insert(next.hits.end(), trees.hits.begin() + begin, trees.hits.begin() + trees.first_hit[to]);
    for (std::size_t sample = from; sample < to; ++sample)
      next.first_hit.push_back(hit_place(here + trees.first_hit[sample + 1] - begin));
  };
  std::size_t sample = 0;  // that is not there yet
  for (std::size_t k = 0; k < fresh.samples.size(); ++k) {
    keep(sample, fresh.samples[k]);
    const std::span<const Hit> hits = fresh.hits_at(k);
    next.hits.insert(next.hits.end(), hits.begin(), hits.end());
    next.first_hit.push_back(hit_place(next.hits.size()));
    sample = fresh.samples[k] + std::size_t{1};
  }
  keep(sample, trees.paths.size());
  next.paths = std::move(trees.paths);
  return next;
}

}  // namespace

StoredImage::StoredImage(Image image, std::vector<LightId> lights, std::vector<ObjectId> atoms,
                         const RegionOptions& options, Residency& residency)
    : image_(std::move(image)),
      layers_(image_.light_sums.size()),
      has_been_composed_(image_.light_sums.size(), 0),
      sum_versions_(image_.light_sums.size(), 1),
      kept_rays_(image_.light_sums.size()),
      kept_segments_(image_.light_sums.size()),
      kept_terms_(image_.light_sums.size()),
      kept_vertices_(image_.light_sums.size()),
      residency_(residency),
      lights_(std::move(lights)),
      classes_(options.atoms > 0),
      atoms_(std::move(atoms)),
      regions_(options, &residency),
      tile_segments_(image_.trees.size(), 0),
      stays_without_hits_(image_.trees.size(), 0),
      found_again_(image_.trees.size(), 0),
      compact_paths_(image_.paths.size()) {
  index_paths();
  parallel_for(image_.trees.size(), [&](std::size_t tile) { count_segments(tile); });
  for (std::size_t tile = 0; tile < image_.trees.size(); ++tile) {
    segments_ += tile_segments_[tile];
    samples_ += image_.trees[tile].paths.size();
  }
  for (std::vector<std::uint64_t>& tiles : bytes_derived_) tiles.resize(image_.light_sums.size());
  regions_.build_groups(image_, class_of());
  if (residency_.is_watched()) {
    add_pieces();
    add_derived();
  }
}

void StoredImage::add_pieces() {
  if (residency_.has_kind(PieceKind::ray_trees)) return;  // read under a limit
  add_image_pieces(residency_, image_);
  for (std::size_t tile = 0; tile < image_.trees.size(); ++tile) note_pieces(residency_, tile, image_);
}

void StoredImage::forget_hits(double share) {
  for (const std::size_t tile : tiles_beyond(share, image_.trees, tile_segments_)) {
    residency_.forget(PieceKind::ray_trees, tile);
    stays_without_hits_[tile] = 1;
  }
}

GrowCounters StoredImage::bring_back_hits(std::size_t tile, const Leaves& leaves, const GrowScene& scene) {
  const TileTrees& trees = image_.trees[tile];
  GrowCounters counters;
  const std::size_t samples = trees.paths.size();
  const auto wanted = leaves.count() * kLeafSize * kLeafSize * image_.view.samples;
  found_again_[tile] = static_cast<std::uint32_t>(std::min(found_again_[tile] + wanted, samples));
  if (found_again_[tile] < samples) return counters;
  if (!residency_.is_worth_room(PieceKind::ray_trees, tile, tile_segments_[tile] * sizeof(Hit))) return counters;
  found_again_[tile] = 0;
  const auto start = std::chrono::steady_clock::now();
  find_hits(tile, scene, counters);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!trees.hits.empty())
    hit_seconds_ = hit_seconds_ + 0.1 * (seconds / static_cast<double>(trees.hits.size()) - hit_seconds_);
  note_trees(residency_, tile, trees, hit_seconds_);
  return counters;
}

void StoredImage::find_hits(std::size_t tile, const GrowScene& scene, GrowCounters& counters) {
  TileTrees& trees = image_.trees[tile];
  const TileRect rect = tile_rect(tile, image_.frame.width, image_.frame.height);
  const PrimaryRays primaries(scene.scene.camera(), image_.view);
  std::vector<Hit> hits;
  std::vector<std::uint32_t> first_hit{0}, words;
  TreeBlock block;
  for (std::uint32_t sample = 0; sample < trees.paths.size(); ++sample) {
    block.clear();
    words.clear();
    const StoredTree stored{PathCursor(image_.paths.words(trees.paths[sample]), layout()), std::nullopt};
    const std::uint32_t root = expand_tree(scene, primaries.ray(rect, sample), sample, stored, block, counters);
    pack(block, root, layout(), words, hits);
    first_hit.push_back(hit_place(hits.size()));
  }
  hits.shrink_to_fit();
  trees.hits = std::move(hits);
  trees.first_hit = std::move(first_hit);
}

Resident StoredImage::resident() const {
  Resident resident;
  resident.ray_paths = image_.paths.bytes() + index_.bytes();
  for (const TileTrees& tile : image_.trees) {
    resident.ray_paths += tile.paths.size() * sizeof(PathId);
    resident.ray_trees += hit_bytes(tile);
  }
  resident.groups = regions_.group_bytes();
  resident.tunnels = regions_.tunnel_bytes();
  for (const std::vector<Rgba>& colors : image_.sample_colors)
    resident.sample_colors += colors.capacity() * sizeof(Rgba);
  for (const PackedSums& sums : image_.light_sums) resident.light_sums += sums.bytes();
  for (const TileLayers& layers : layers_) resident.light_sums += layers.bytes();
  for (const TileRays& rays : kept_rays_) resident.kept_rays += rays.bytes();
  for (const TileSegments& segments : kept_segments_) resident.kept_segments += segments.bytes();
  for (const TileTerms& terms : kept_terms_) resident.kept_terms += terms.bytes();
  for (const auto& vertices : kept_vertices_) resident.kept_vertices += vertices ? vertices->bytes() : 0;
  const std::uint64_t frame = image_.frame.pixels.size() * sizeof(Rgba);
  resident.total = resident.ray_paths + resident.ray_trees + resident.sample_colors + resident.light_sums +
                   resident.kept_rays + resident.kept_segments + resident.kept_terms + resident.kept_vertices +
                   resident.groups + resident.tunnels + frame;
  return resident;
}

void StoredImage::set_atoms(std::vector<ObjectId> atoms, const GrowScene& scene) {
  if (atoms == atoms_) return;
  atoms_ = std::move(atoms);
  classify_paths(scene);
}

void StoredImage::classify_paths(const GrowScene& scene) {
  classes_.clear();
  index_paths();
  regions_.build_groups(image_, class_of());
  if (regions_.options().tunnels < 2) return;  // not for one path
  if (!regions_.has_tunnels()) {
    regions_.forget_stored();
    return;
  }
  build_tunnels(scene);
  for (std::size_t tile = 0; tile < image_.trees.size(); ++tile) {
    const auto lease = residency_.use(PieceKind::tunnels, tile);
    note_rebuilt_tunnels(tile);
  }
}

void StoredImage::index_paths() {
  index_.extend(image_.paths, layout());
  classes_.extend(image_.paths, layout(), atoms_);
}

void StoredImage::count_segments(std::size_t tile) {
  tile_segments_[tile] = 0;
  for (PathId path : image_.trees[tile].paths) tile_segments_[tile] += index_.segments(path);
}

void StoredImage::keep_hits(NewSamples& fresh) {
  const auto lease = residency_.use(PieceKind::ray_trees, fresh.tile);
  TileTrees& trees = image_.trees[fresh.tile];
  SampleTrees& packed = fresh.packed;
  const bool is_whole = packed.samples.size() == trees.paths.size() && stays_without_hits_[fresh.tile] == 0;
  if (!packed.samples.empty() && (has_hits(trees) || is_whole)) {
    trees = with_hits_of(packed, std::move(trees));
    note_trees(residency_, fresh.tile, trees, hit_seconds_);
  }
  give_back(packed.hits);
  give_back(packed.first_hit);
  if (!fresh.shaded.samples.empty()) keep_colors(fresh.tile, fresh.shaded.samples, fresh.shaded.colors);
  give_back(fresh.shaded.colors);
}

void StoredImage::keep_paths(std::span<const NewSamples> fresh, const GrowScene& scene, bool lights_changed) {
  if (lights_changed) {
    image_.paths = PathTable();
    index_.clear();
    classes_.clear();
    regions_.forget_stored();
  }
  lights_ = scene.scene.light_order();
  std::vector<std::vector<PathId>> ids(fresh.size());
  for (std::size_t k = 0; k < fresh.size(); ++k)
    for (std::uint32_t i = 0; i < fresh[k].packed.paths.size(); ++i)
      ids[k].push_back(image_.paths.intern(fresh[k].packed.paths.words(PathId(i))));
  index_paths();
  std::vector<std::size_t> changed;
  for (std::size_t k = 0; k < fresh.size(); ++k) {
    const SampleTrees& packed = fresh[k].packed;
    if (packed.samples.empty()) continue;
    changed.push_back(fresh[k].tile);
    std::vector<PathId>& paths = image_.trees[fresh[k].tile].paths;
    for (std::size_t i = 0; i < packed.samples.size(); ++i)
      paths[packed.samples[i]] = ids[k][packed.path_of[i].index()];
  }
  parallel_for(fresh.size(), [&](std::size_t k) {
    const std::vector<std::uint32_t>& samples = fresh[k].packed.samples;
    if (samples.empty()) return;
    count_segments(fresh[k].tile);
    update_regions(fresh[k].tile, leaves_of(fresh[k].tile, samples), scene);
  });
  regions_.update_image(changed);
  segments_ = 0;
  for (std::uint64_t count : tile_segments_) segments_ += count;
  if (image_.paths.size() > 4 * compact_paths_ + 4096) drop_unused_paths(scene);
}

void StoredImage::bring_back_tunnels(std::span<const NewSamples> fresh, const GrowScene& scene) {
  parallel_for(fresh.size(), [&](std::size_t k) {
    const std::size_t tile = fresh[k].tile;
    const bool is_done = !fresh[k].missed_tunnels || !fresh[k].packed.samples.empty();
    if (!is_done && residency_.is_worth_room(PieceKind::tunnels, tile, 0)) update_regions(tile, {}, scene);
  });
}

void StoredImage::update_regions(std::size_t tile, const Leaves& changed, const GrowScene& scene) {
  if (!regions_.update(image_, scene, tile, changed, class_of())) return;
  const auto lease = residency_.use(PieceKind::tunnels, tile);
  note_rebuilt_tunnels(tile);
}

void StoredImage::build_tunnels(const GrowScene& scene) {
  for (const std::size_t tile : regions_.build_tunnels(image_, scene, class_of())) {
    const auto lease = residency_.use(PieceKind::tunnels, tile);
    note_rebuilt_tunnels(tile);
  }
}

void StoredImage::note_rebuilt_tunnels(std::size_t tile) {
  ++rebuilt_tunnels_;
  rebuilt_tunnel_bytes_ += regions_.tunnels(tile).bytes();
}

Moves StoredImage::take_rebuilt() {
  Moves rebuilt;
  rebuilt.tunnels = rebuilt_tunnels_.exchange(0);
  rebuilt.bytes = rebuilt_tunnel_bytes_.exchange(0);
  return rebuilt;
}

Leaves StoredImage::leaves_of(std::size_t tile, const std::vector<std::uint32_t>& samples) const {
  const TileRect rect = tile_rect(tile, image_.frame.width, image_.frame.height);
  Leaves leaves;
  for (std::uint32_t sample : samples) leaves.set(leaf_of(sample / image_.view.samples, rect.width()));
  return leaves;
}

/// Numbers the paths in use afresh, in the order of tiles and samples.
void StoredImage::drop_unused_paths(const GrowScene& scene) {
  PathTable used;
  std::vector<PathId> ids(image_.paths.size(), PathId::none());
  for (TileTrees& tile : image_.trees)
    for (PathId& path : tile.paths) {
      PathId& id = ids[path.index()];
      if (id.is_none()) id = used.intern(image_.paths.words(path));
      path = id;
    }
  image_.paths = std::move(used);
  compact_paths_ = image_.paths.size();
  index_.clear();
  classify_paths(scene);
}

void StoredImage::keep_colors(std::size_t tile, std::span<const std::uint32_t> samples, std::span<const Rgba> colors) {
  const auto lease = residency_.use(PieceKind::sample_colors, tile);
  std::vector<Rgba>& stored = image_.sample_colors[tile];
  for (std::size_t k = 0; k < samples.size(); ++k) stored[samples[k]] = colors[k];
  note_colors(residency_, tile, stored);
}

void StoredImage::refresh_pixels(std::size_t tile, std::span<const std::uint32_t> samples, const SampleColors* shown,
                                 TileMask& changed) {
  const auto lease = residency_.use(PieceKind::sample_colors, tile);
  const TileRect rect = tile_rect(tile, image_.frame.width, image_.frame.height);
  const std::uint32_t width = rect.width(), count = image_.view.samples;
  const Rgba* stored = image_.sample_colors[tile].data();
  if (count == 1 && shown == nullptr) {
    std::uint32_t y = 0;
    for (const std::uint32_t pixel : samples) {
      while (pixel >= (y + 1) * width) ++y;
      const std::uint32_t x = pixel - y * width;
      Rgba& place = image_.frame.pixels[std::size_t{rect.y0 + y} * image_.frame.width + rect.x0 + x];
      changed[y] |= std::uint64_t{same_bits(stored[pixel], place) ? 0U : 1U} << x;
      place = stored[pixel];
    }
    return;
  }
  std::vector<Rgba> on_top(shown != nullptr ? count : 0);
  std::uint32_t last_pixel = kNoNode, y = 0;
  for (const std::uint32_t sample : samples) {
    const std::uint32_t pixel = count == 1 ? sample : sample / count;
    if (pixel == last_pixel) continue;
    last_pixel = pixel;
    while (pixel >= (y + 1) * width) ++y;
    const std::uint32_t x = pixel - y * width;
    const Rgba* colors = stored + std::size_t{pixel} * count;
    if (shown != nullptr) {
      std::copy_n(colors, count, on_top.begin());
      put_on_top(*shown, pixel * count, on_top);
      colors = on_top.data();
    }
    const Rgba color = pixel_color(colors, count);
    Rgba& place = image_.frame.pixels[std::size_t{rect.y0 + y} * image_.frame.width + rect.x0 + x];
    if (same_bits(color, place)) continue;
    place = color;
    changed[y] |= std::uint64_t{1} << x;
  }
}

}  // namespace relook
