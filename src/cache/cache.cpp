#include "cache/cache.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "cache/scene_parts.h"
#include "cache/staged_folder.h"

namespace relook {
namespace {

enum class Part : std::uint8_t { look, geometry, textures, frame, paths, trees };
constexpr std::array<std::string_view, 6> kPartNames{"look.json", "geometry", "textures", "frame", "paths", "trees"};

struct PartFile {
  Part part = Part::look;
  std::size_t group = 0;  // of Part::trees
};

std::vector<PartFile> parts_of(const CacheContent& content) {
  std::vector<PartFile> parts{{Part::look}, {Part::geometry}, {Part::textures}, {Part::frame}, {Part::paths}};
  for (std::size_t group = 0; group < cache_group_count(content.camera, content.samples); ++group)
    parts.push_back({Part::trees, group});
  return parts;
}

/// The start of a part's file name; the hash of its bytes follows (look.json has none, to be found by people).
std::string stem(const PartFile& part) {
  if (part.part == Part::look) return "look.json";
  std::string name(kPartNames[static_cast<std::size_t>(part.part)]);
  if (part.part == Part::trees) {
    char digits[24];
    std::snprintf(digits, sizeof digits, "/%05zu", part.group);
    name += digits;
  }
  return name + "-";
}

Bytes encode(const PartFile& part, const CacheContent& content, const CacheIdentity& identity) {
  switch (part.part) {
    case Part::look:
      return encode_look(content.document);
    case Part::geometry:
      return encode_geometry(content.document, identity);
    case Part::textures:
      return encode_textures(*content.document.assets, *content.pyramids, identity);
    case Part::frame:
      return encode_frame(content, identity);
    case Part::paths:
      return encode_paths(content, identity);
    case Part::trees:
      return encode_trees(content, part.group, identity);
  }
  return {};
}

CacheFile write_part(const std::filesystem::path& folder, const PartFile& part, const CacheContent& content,
                     const CacheIdentity& identity) {
  const Bytes bytes = encode(part, content, identity);
  CacheFile file{stem(part), bytes.size(), hash128(bytes)};
  if (part.part != Part::look) file.name += file.hash + ".rlk";
  write_file(folder / file.name, bytes);
  return file;
}

/// Everything that reading has found out so far.
struct Reading {
  std::filesystem::path path;
  Manifest manifest;
  CacheContent content;
  std::shared_ptr<Assets> assets = std::make_shared<Assets>();
  std::vector<std::size_t> hits_of_path;
  bool uses_trees = false;  // otherwise of trees nothing but the hash of the file is checked
  CacheUsers users;
};

/// What is wrong with one file.
struct Finding {
  CacheAnswer answer;
  PartFile part;
  bool is_lost = false;  // missing, or not the bytes that were written
};

void decode(const PartFile& part, BytesView bytes, Reading& reading) {
  const CacheIdentity& identity = reading.manifest.identity;
  CacheContent& content = reading.content;
  switch (part.part) {
    case Part::look:
      return decode_look(bytes, content.document);
    case Part::geometry:
      return decode_geometry(bytes, identity, content.document, *reading.assets);
    case Part::textures:
      return decode_textures(bytes, identity, *reading.assets, *content.pyramids);
    case Part::frame:
      return decode_frame(bytes, identity, content);
    case Part::paths:
      return decode_paths(bytes, identity, content);
    case Part::trees:
      if (reading.uses_trees) decode_trees(bytes, identity, part.group, reading.hits_of_path, content);
      return;
  }
}

const CacheFile& find_file(const Manifest& manifest, const PartFile& part) {
  const std::string start = stem(part);
  const auto found = std::find_if(manifest.files.begin(), manifest.files.end(),
                                  [&](const CacheFile& file) { return file.name.starts_with(start); });
  check_sound(found != manifest.files.end(), "the manifest names no file " + start);
  return *found;
}

/// Reads, verifies and decodes one file.
Finding read_part(const PartFile& part, Reading& reading) {
  Finding finding{{CacheFault::none, stem(part), ""}, part};
  CacheAnswer& answer = finding.answer;
  try {
    const CacheFile& file = find_file(reading.manifest, part);
    answer.file = file.name;
    finding.is_lost = true;
    const Bytes bytes = load_file(reading.path, file);
    const bool is_sound = hash128(bytes) == file.hash;
    finding.is_lost = !is_sound;
    try {
      decode(part, bytes, reading);
    } catch (const CacheDamage& damage) {
      const bool is_hash_more_telling = part.part == Part::look || damage.fault == CacheFault::other_version;
      if (is_sound || !is_hash_more_telling) throw;
    }
    check_sound(is_sound, "file hash mismatch");
    if (part.part == Part::trees && reading.uses_trees && reading.users.tile) {
      const TileGroup group = cache_group(reading.content.camera, reading.content.samples, part.group);
      for (std::size_t tile = group.first; tile < group.last; ++tile) reading.users.tile(reading.content, tile);
    }
  } catch (const CacheDamage& damage) {
    answer.fault = damage.fault;
    answer.detail = damage.what();
  }
  return finding;
}

/// The findings of some parts, read in parallel, in order.
std::vector<Finding> read_parts(std::span<const PartFile> parts, Reading& reading) {
  std::vector<Finding> findings(parts.size());
  parallel_for(parts.size(), [&](std::size_t i) { findings[i] = read_part(parts[i], reading); });
  return findings;
}

bool is_fault(const Finding& finding) { return finding.answer.fault != CacheFault::none; }

/// Can be made good from the rest of the cache.
bool is_loss(const Finding& finding) {
  const bool follows_from_scene =
      finding.part.part == Part::frame || finding.part.part == Part::paths || finding.part.part == Part::trees;
  return finding.is_lost && follows_from_scene;
}

/// What is to be done about losses, and nothing left in `content` of what is lost.
CacheLosses take_losses(const std::vector<Finding>& findings, CacheContent& content) {
  CacheLosses losses;
  std::set<std::size_t> tiles;
  const std::size_t all = cache_tile_count(content.camera);
  for (const Finding& finding : findings) {
    losses.faults.push_back(finding.answer);
    const bool is_group = finding.part.part == Part::trees;
    const TileGroup lost =
        is_group ? cache_group(content.camera, content.samples, finding.part.group) : TileGroup{0, all};
    for (std::size_t tile = lost.first; tile < lost.last; ++tile) tiles.insert(tile);
    if (finding.part.part == Part::paths) content.paths = PathTable();
  }
  content.frame.resize(std::size_t{content.camera.width} * content.camera.height);
  content.trees.resize(all);
  content.sample_colors.resize(all);
  for (const std::size_t tile : tiles) {
    content.trees[tile] = TileTrees();
    content.sample_colors[tile].clear();
  }
  losses.tiles.assign(tiles.begin(), tiles.end());
  return losses;
}

constexpr std::size_t kFrame = 3, kPaths = 4, kFirstTrees = 5;  // of parts_of(), where the scene comes first

/// Frame, paths and trees. Trees are checked against the paths, and take over pixels of the frame.
std::vector<Finding> read_image(std::span<const PartFile> parts, Reading& reading) {
  CacheContent& content = reading.content;
  require(parts[kFrame].part == Part::frame && parts[kPaths].part == Part::paths, "parts have their places");
  std::vector<Finding> findings = read_parts(parts.subspan(kFrame, 2), reading);
  reading.uses_trees = std::ranges::none_of(findings, is_fault);
  if (reading.uses_trees) {
    const PathLayout layout{content.lights, content.shadow_bits};
    for (std::size_t i = 0; i < content.paths.size(); ++i)
      reading.hits_of_path.push_back(hit_count(content.paths.words(PathId(static_cast<std::uint32_t>(i))), layout));
    const std::size_t tiles = cache_tile_count(content.camera);
    content.trees.resize(tiles);
    content.sample_colors.resize(tiles);
  }
  std::ranges::move(read_parts(parts.subspan(kFirstTrees), reading), std::back_inserter(findings));
  return findings;
}

/// Reads everything that can be read; what is wrong with it, in the order of the files.
std::vector<Finding> read_everything(const std::filesystem::path& path, Reading& reading) {
  reading.path = path;
  try {
    reading.manifest = load_manifest(path);
  } catch (const CacheDamage& damage) {
    const bool has_manifest = damage.fault != CacheFault::missing && damage.what()[0] != '\0';
    return {{{damage.fault, has_manifest ? std::string(kManifestName) : "", damage.what()}, {}}};
  }
  const Manifest& manifest = reading.manifest;
  CacheContent& content = reading.content;
  content.camera = manifest.camera;
  content.samples = manifest.samples;
  content.max_depth = manifest.max_depth;
  content.shadow_bits = manifest.shadow_bits;
  content.objects = manifest.objects;
  content.lights = manifest.lights;
  content.scene_hash = manifest.identity.scene_hash;
  content.pyramids = std::make_shared<PyramidStore>();
  content.document.assets = reading.assets;
  std::vector<Finding> findings;
  if (options_hash(content) != manifest.identity.options_hash)
    findings.push_back(
        {{CacheFault::damaged, std::string(kManifestName), "the options do not have the hash given"}, {}});

  const std::vector<PartFile> parts = parts_of(content);
  std::vector<Finding> of_scene, of_image;
  const auto read_scene = [&] {
    of_scene = read_parts(std::span(parts).first(kFrame), reading);
    if (reading.users.scene && findings.empty() && std::ranges::none_of(of_scene, is_fault))
      reading.users.scene(content);
  };
  if (reading.users.tile) {
    read_scene();
    of_image = read_image(parts, reading);
  } else {
    parallel_for(2, [&](std::size_t half) { half == 0 ? read_scene() : void(of_image = read_image(parts, reading)); });
  }
  std::ranges::copy_if(of_scene, std::back_inserter(findings), is_fault);
  std::ranges::copy_if(of_image, std::back_inserter(findings), is_fault);
  return findings;
}

}  // namespace

std::string_view sentence(CacheFault fault) {
  switch (fault) {
    case CacheFault::none:
      return "the cache is sound";
    case CacheFault::missing:
      return "there is no cache here";
    case CacheFault::not_a_cache:
      return "this is not a relook cache";
    case CacheFault::other_version:
      return "the cache was written by another version of relook; preprocess again";
    case CacheFault::other_scene:
      return "the cache is of another scene; preprocess again";
    case CacheFault::other_options:
      return "the cache is of another camera, resolution or sampling; preprocess again";
    case CacheFault::truncated:
      return "the cache is cut short; preprocess again";
    case CacheFault::damaged:
      return "the cache is damaged; preprocess again";
  }
  return "";
}

std::string options_hash(const CacheContent& content) {
  const Json options{{"camera", camera_json(content.camera)},
                     {"samples", content.samples},
                     {"max_depth", content.max_depth},
                     {"shadow_bits", content.shadow_bits}};
  return hash128(bytes_of(options.dump()));
}

void refuse_foreign_folder(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return;
  if (!std::filesystem::is_directory(path, error)) throw InputError(path.string(), "", "exists and is not a folder");
  if (!std::filesystem::is_empty(path, error) && !looks_like_cache(path))
    throw InputError(path.string(), "", "exists and is not a cache: not overwritten");
}

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

void write_cache(const std::filesystem::path& path, const CacheContent& content) {
  refuse_foreign_folder(path);
  Manifest manifest;
  manifest.identity = {content.scene_hash, options_hash(content)};
  manifest.camera = content.camera;
  manifest.samples = content.samples;
  manifest.max_depth = content.max_depth;
  manifest.shadow_bits = content.shadow_bits;
  manifest.objects = content.objects;
  manifest.lights = content.lights;

  StagedFolder folder(path);
  folder.fill([&] {
    make_folders(folder.path() / kPartNames[static_cast<std::size_t>(Part::trees)]);
    const std::vector<PartFile> parts = parts_of(content);
    manifest.files.resize(parts.size());
    parallel_for(parts.size(), [&](std::size_t i) {
      manifest.files[i] = write_part(folder.path(), parts[i], content, manifest.identity);
    });
    std::sort(manifest.files.begin(), manifest.files.end(),
              [](const CacheFile& a, const CacheFile& b) { return a.name < b.name; });
    write_file(folder.path() / kManifestName, manifest_text(manifest));
  });
  folder.publish();
}

CacheAnswer read_cache(const std::filesystem::path& path, CacheContent& content, CacheLosses* losses,
                       const CacheUsers& users) {
  Reading reading;
  reading.users = users;
  const std::vector<Finding> findings = read_everything(path, reading);
  const auto fault =
      std::ranges::find_if(findings, [&](const Finding& finding) { return losses == nullptr || !is_loss(finding); });
  if (fault != findings.end()) return fault->answer;
  if (losses != nullptr && !findings.empty()) *losses = take_losses(findings, reading.content);
  content = std::move(reading.content);
  return {};
}

CacheReport check_cache(const std::filesystem::path& path) {
  Reading reading;
  CacheReport report;
  const std::vector<Finding> faults = read_everything(path, reading);
  if (!faults.empty()) report.worst = faults.front().answer;
  for (const Finding& finding : faults) {
    const CacheAnswer& fault = finding.answer;
    std::string line = fault.file;
    if (!line.empty()) line += ": ";
    report.findings.push_back(line + (fault.detail.empty() ? std::string(sentence(fault.fault)) : fault.detail));
  }
  if (report.worst.fault == CacheFault::missing || report.worst.fault == CacheFault::not_a_cache) return report;

  std::set<std::string> known{std::string(kManifestName)};
  for (const CacheFile& file : reading.manifest.files) known.insert(file.name);
  std::error_code error;
  for (auto entry = std::filesystem::recursive_directory_iterator(path, error);
       !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->is_directory(error)) continue;
    ++report.files;
    report.bytes += entry->is_regular_file(error) ? entry->file_size(error) : 0;
    const std::string name = entry->path().lexically_relative(path).generic_string();
    if (reading.manifest.files.empty() || known.contains(name)) continue;
    report.findings.push_back(printable(name) + ": not a file of this cache");
    if (report.worst.fault == CacheFault::none)
      report.worst = {CacheFault::damaged, printable(name), "not a file of this cache"};
  }
  return report;
}

CacheAnswer read_manifest(const std::filesystem::path& path, Json& manifest) {
  try {
    Json document;
    static_cast<void>(load_manifest(path, &document));
    manifest = std::move(document);
    return {};
  } catch (const CacheDamage& damage) {
    return {damage.fault, damage.what()[0] == '\0' ? "" : std::string(kManifestName), damage.what()};
  }
}

}  // namespace relook
