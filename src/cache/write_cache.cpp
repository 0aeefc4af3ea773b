// Writing a cache: encoding its parts, fitting them to a disk, publishing the folder.
#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "cache/cache.h"
#include "cache/cache_folder.h"
#include "cache/cache_parts.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "cache/staged_folder.h"

namespace relook {

void require_writable(const std::filesystem::path& path) { const StagedFolder removed_again(path); }

namespace {

/// Of a group of tiles.
struct GroupSize {
  std::size_t group = 0;
  std::uint64_t hits = 0, with_hits = 0, without = 0;  // number; bytes of its file
  [[nodiscard]] std::uint64_t saved() const { return with_hits - std::min(without, with_hits); }
  /// Hits take about the same time each to find again.
  [[nodiscard]] double weight() const { return static_cast<double>(hits) / static_cast<double>(saved() + 1); }
};

GroupSize take_hits(CacheContent& content, const CacheIdentity& identity, std::size_t group,
                    std::vector<TileTrees>& taken) {
  GroupSize size{group};
  size.with_hits = encode_trees(content, group, identity).size();
  const TileGroup tiles = cache_group(content.camera, content.samples, group);
  for (std::size_t tile = tiles.first; tile < tiles.last; ++tile) {
    TileTrees& trees = content.trees[tile];
    size.hits += trees.hits.size();
    taken[tile].first_hit = std::exchange(trees.first_hit, {});
    taken[tile].hits = std::exchange(trees.hits, {});
  }
  size.without = encode_trees(content, group, identity).size();
  return size;
}

void put_back_hits(CacheContent& content, std::size_t group, std::vector<TileTrees>& taken) {
  const TileGroup tiles = cache_group(content.camera, content.samples, group);
  for (std::size_t tile = tiles.first; tile < tiles.last; ++tile) {
    content.trees[tile].first_hit = std::move(taken[tile].first_hit);
    content.trees[tile].hits = std::move(taken[tile].hits);
  }
}

}  // namespace

void fit_to_disk(CacheContent& content, std::uint64_t bytes) {
  const CacheIdentity identity{content.scene_hash, options_hash(content)};
  const std::vector<PartFile> parts = parts_of(content);
  std::vector<std::uint64_t> others(parts.size(), 0);
  std::vector<GroupSize> groups(cache_group_count(content.camera, content.samples));
  std::vector<TileTrees> taken(content.trees.size());
  parallel_for(parts.size(), [&](std::size_t i) {
    if (parts[i].part == Part::trees)
      groups[parts[i].group] = take_hits(content, identity, parts[i].group, taken);
    else
      others[i] = encode(parts[i], content, identity).size();
  });
  constexpr std::uint64_t kManifestBytes = 4096, kManifestFileBytes = 256;  // at most
  std::uint64_t least =
      std::accumulate(others.begin(), others.end(), kManifestBytes + kManifestFileBytes * parts.size());
  for (const GroupSize& group : groups) least += group.without;
  if (least > bytes)
    throw ResourceError("--disk", "this cache needs at least " + std::to_string((least + 1023) >> 10) + "K");
  std::ranges::stable_sort(groups, std::greater(), &GroupSize::weight);
  std::uint64_t left = bytes - least;
  for (const GroupSize& group : groups) {
    if (group.saved() > left) continue;
    left -= group.saved();
    put_back_hits(content, group.group, taken);
  }
}

namespace {

CacheFile write_part(const std::filesystem::path& folder, const PartFile& part, const CacheContent& content,
                     const CacheIdentity& identity) {
  const Bytes bytes = encode(part, content, identity);
  CacheFile file{stem(part), bytes.size(), hash128(bytes)};
  if (part.part != Part::look) file.name += file.hash + ".rlk";
  write_file(folder / file.name, bytes);
  return file;
}

/// May what is at `path` give way to a new cache? No if it is the same. Throws UsageError for what must stay.
bool may_replace(const std::filesystem::path& path, OldCache old, const std::string& new_manifest) {
  const Occupant occupant = occupant_of(path);
  if (occupant.kind == Occupant::Kind::none) return true;
  if (occupant.kind == Occupant::Kind::other) throw UsageError(path.string(), occupant.what);
  if (old == OldCache::keep) {
    if (text_of(read_file(path / kManifestName)) == new_manifest) return false;
    throw UsageError(path.string(),
                     "holds a cache that another program has written meanwhile; --overwrite replaces it");
  }
  if (!occupant.foreign.empty())
    throw UsageError(path.string(), "holds " + occupant.foreign + ", which relook did not write");
  return true;
}

}  // namespace

void write_cache(const std::filesystem::path& path, const CacheContent& content, OldCache old) {
  Manifest manifest = manifest_of(content);
  if (old == OldCache::replace) static_cast<void>(may_replace(path, old, ""));
  StagedFolder folder(path);
  std::string text;
  folder.fill([&] {
    make_folders(folder.path() / kTreesFolder);
    const std::vector<PartFile> parts = parts_of(content);
    manifest.files.resize(parts.size());
    parallel_for(parts.size(), [&](std::size_t i) {
      manifest.files[i] = write_part(folder.path(), parts[i], content, manifest.identity);
    });
    std::sort(manifest.files.begin(), manifest.files.end(),
              [](const CacheFile& a, const CacheFile& b) { return a.name < b.name; });
    text = manifest_text(manifest);
    write_file(folder.path() / kManifestName, text);
  });
  folder.publish([&] { return may_replace(path, old, text); });
}

}  // namespace relook
