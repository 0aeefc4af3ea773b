// Writing a cache: encoding its parts, fitting them to --disk (paper 4.3), publishing the folder.
#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "cache/cache.h"
#include "cache/cache_folder.h"
#include "cache/cache_parts.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "cache/residency/eviction.h"
#include "cache/staged_folder.h"
#include "cache/tunnel_parts.h"

namespace relook {

void require_writable(const std::filesystem::path& path) { const StagedFolder removed_again(path); }

namespace {

/// What can be left out of a cache: the hits or the tunnels of a group of tiles.
struct Dispensable {
  PartFile part;
  std::uint64_t with = 0, without = 0;  // bytes of its file
  double seconds = 0;                   // to rebuild it; of tunnels times their area, by which changes touch them
  [[nodiscard]] std::uint64_t saved() const { return with - std::min(without, with); }
  [[nodiscard]] double weight() const { return seconds / static_cast<double>(saved() + 1); }
};

/// What has been taken out of a cache's content, by tile.
struct Taken {
  std::vector<TileTrees> hits;
  std::vector<TileTunnels> tunnels;
};

constexpr std::size_t kBoundDigits = 64;

std::uint64_t file_bytes(const CacheContent& content, const CacheIdentity& identity, const PartFile& part) {
  if (part.part != Part::tunnels) return encode(part, content, identity).size();
  return encode_tunnels(content, part.group, identity, std::string(kBoundDigits, '0')).size();
}

Dispensable take_hits(CacheContent& content, const CacheIdentity& identity, const PartFile& part, Taken& taken) {
  Dispensable option{part, file_bytes(content, identity, part)};
  const TileGroup tiles = cache_group(content.image, part.group);
  for (std::size_t tile = tiles.first; tile < tiles.last; ++tile) {
    TileTrees& trees = content.image.trees[tile];
    option.seconds += kHitSeconds * static_cast<double>(trees.hits.size());
    taken.hits[tile].first_hit = std::exchange(trees.first_hit, {});
    taken.hits[tile].hits = std::exchange(trees.hits, {});
  }
  option.without = file_bytes(content, identity, part);
  return option;
}

/// `areas`: the `tunnel_areas` of fit_to_disk(). Requires: the group's hits are still there.
Dispensable take_tunnels(CacheContent& content, const CacheIdentity& identity, const PartFile& part,
                         std::span<const double> areas, Taken& taken) {
  Dispensable option{part, file_bytes(content, identity, part)};
  const TileGroup tiles = cache_group(content.image, part.group);
  for (std::size_t tile = tiles.first; tile < tiles.last; ++tile) {
    option.seconds += kTunnelSeconds * static_cast<double>(content.image.trees[tile].hits.size()) * areas[tile];
    taken.tunnels[tile] = std::exchange(content.tunnels[tile], {});
  }
  option.without = file_bytes(content, identity, part);
  return option;
}

void put_back(CacheContent& content, const PartFile& part, Taken& taken) {
  const TileGroup tiles = cache_group(content.image, part.group);
  for (std::size_t tile = tiles.first; tile < tiles.last; ++tile) {
    if (part.part == Part::tunnels) {
      content.tunnels[tile] = std::move(taken.tunnels[tile]);
      continue;
    }
    content.image.trees[tile].first_hit = std::move(taken.hits[tile].first_hit);
    content.image.trees[tile].hits = std::move(taken.hits[tile].hits);
  }
}

}  // namespace

void fit_to_disk(CacheContent& content, std::uint64_t bytes, std::span<const double> tunnel_areas) {
  const CacheIdentity identity{content.scene_hash, options_hash(content)};
  const std::vector<PartFile> parts = parts_of(content);
  std::vector<Dispensable> options(parts.size());
  Taken taken{std::vector<TileTrees>(content.image.trees.size()), std::vector<TileTunnels>(content.tunnels.size())};
  const auto for_each = [&](Part kind, const auto& take) {
    parallel_for(parts.size(), [&](std::size_t i) {
      if (parts[i].part == kind) options[i] = take(parts[i]);
    });
  };
  for_each(Part::tunnels,
           [&](const PartFile& part) { return take_tunnels(content, identity, part, tunnel_areas, taken); });
  for_each(Part::trees, [&](const PartFile& part) { return take_hits(content, identity, part, taken); });
  constexpr std::uint64_t kManifestBytes = 4096, kManifestFileBytes = 256;  // at most
  std::uint64_t least = kManifestBytes + kManifestFileBytes * parts.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool is_optional = parts[i].part == Part::trees || parts[i].part == Part::tunnels;
    least += is_optional ? options[i].without : file_bytes(content, identity, parts[i]);
  }
  if (least > bytes)
    throw ResourceError("--disk", "this cache needs at least " + std::to_string((least + 1023) >> 10) + "K");
  std::ranges::stable_sort(options, std::greater(), &Dispensable::weight);
  std::uint64_t left = bytes - least;
  for (const Dispensable& option : options) {
    if (option.with == 0 || option.saved() > left) continue;
    left -= option.saved();
    put_back(content, option.part, taken);
  }
}

namespace {

/// Requires: for tunnels, manifest.files has the files that they are bound to.
CacheFile write_part(const std::filesystem::path& folder, const PartFile& part, const CacheContent& content,
                     const Manifest& manifest) {
  const Bytes bytes = part.part == Part::tunnels ? encode_tunnels(content, part.group, manifest.identity,
                                                                  hashes_bound_to(manifest, part.group))
                                                 : encode(part, content, manifest.identity);
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
  manifest.pieces = count_pieces(content);
  if (old == OldCache::replace) static_cast<void>(may_replace(path, old, ""));
  StagedFolder folder(path);
  std::string text;
  folder.fill([&] {
    const std::vector<PartFile> parts = parts_of(content);
    for (const std::string_view inner : kInnerFolders)
      if (std::ranges::any_of(parts, [&](const PartFile& part) { return stem(part).starts_with(inner); }))
        make_folders(folder.path() / inner);
    const auto has_tunnels = [](const PartFile& part) { return part.part == Part::tunnels; };
    const auto others = static_cast<std::size_t>(std::ranges::find_if(parts, has_tunnels) - parts.begin());
    manifest.files.resize(others);
    parallel_for(others,
                 [&](std::size_t i) { manifest.files[i] = write_part(folder.path(), parts[i], content, manifest); });
    std::vector<CacheFile> of_tunnels(parts.size() - others);
    parallel_for(of_tunnels.size(), [&](std::size_t i) {
      of_tunnels[i] = write_part(folder.path(), parts[others + i], content, manifest);
    });
    std::ranges::move(of_tunnels, std::back_inserter(manifest.files));
    std::sort(manifest.files.begin(), manifest.files.end(),
              [](const CacheFile& a, const CacheFile& b) { return a.name < b.name; });
    text = manifest_text(manifest);
    write_file(folder.path() / kManifestName, text);
  });
  folder.publish([&] { return may_replace(path, old, text); });
}

}  // namespace relook
