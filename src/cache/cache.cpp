// Reading a cache: the manifest first, then every file, in parallel; all that is wrong is found, file by file, and
// losses that follow from the scene are told from faults. write_cache.cpp is the other direction.
#include "cache/cache.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/file_names.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "cache/cache_names.h"
#include "cache/cache_parts.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "cache/scene_parts.h"
#include "cache/tunnel_parts.h"
#include "scene/look/counted_assets.h"

namespace relook {
namespace {

/// A cache that is being read: what has been read so far, and for whom.
struct Reading {
  std::filesystem::path path;
  Manifest manifest;
  CacheContent content;
  std::shared_ptr<Assets> assets = counted_assets();
  std::vector<std::size_t> hits_of_path;
  bool uses_trees = false;  // frame and paths are sound; otherwise files of trees are only compared with their hashes
  CacheUsers users;
};

/// What is wrong with one file.
struct Finding {
  CacheAnswer answer;
  PartFile part;
  bool is_lost = false;  // missing, or not the bytes that were written
};

/// The most words that a lost path is believed to have had, for the check of the tunnels around its trees.
constexpr std::size_t kWordsOfLostPath = 1024;

void decode_tunnels(std::size_t group, BytesView bytes, Reading& reading) {
  CacheContent& content = reading.content;
  PathBounds paths = bounds_of(content.image.paths);
  if (paths.count == 0) paths = {reading.manifest.pieces.ray_paths, kWordsOfLostPath};
  const TunnelReader tunnels(ByteSource(bytes), reading.manifest.identity, content.storage, content.camera,
                             content.image.view.samples, group, paths);
  const TileGroup tiles = cache_group(content.image, group);
  for (std::size_t tile = tiles.first; tile < tiles.last; ++tile) {
    TileTunnels of_tile;
    if (tunnels.has(tile)) of_tile = tunnels.tunnels(tile);
    if (reading.users.tunnels == TunnelReading::check) continue;
    content.around_tiles[tile] = tunnels.around(tile);
    content.tunnels[tile] = std::move(of_tile);
  }
  // Last, so that damage of the file is called damage.
  check_sound(tunnels.bound_to() == hashes_bound_to(reading.manifest, group), kOfOtherTrees);
}

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
      return decode_frame(bytes, identity, content.image);
    case Part::paths:
      return decode_paths(bytes, identity, content);
    case Part::trees:
      if (reading.uses_trees) decode_trees(bytes, identity, part.group, reading.hits_of_path, content);
      return;
    case Part::tunnels:
      return decode_tunnels(part.group, bytes, reading);
  }
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
      const TileGroup group = cache_group(reading.content.image, part.group);
      for (std::size_t tile = group.first; tile < group.last; ++tile) reading.users.tile(reading.content, tile);
    }
  } catch (const CacheDamage& damage) {
    answer.fault = damage.fault;
    answer.detail = damage.what();
  } catch (const ResourceError& error) {
    throw ResourceError((reading.path / answer.file).string(), error.what());
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

/// Can the file be made good from the rest of the cache?
bool is_loss(const Finding& finding) {
  // Nothing but time depends on tunnels; those of other ray trees count as lost.
  if (finding.part.part == Part::tunnels) return finding.answer.fault != CacheFault::unreadable;
  const bool follows_from_scene =
      finding.part.part == Part::frame || finding.part.part == Part::paths || finding.part.part == Part::trees;
  return finding.is_lost && follows_from_scene && finding.answer.fault != CacheFault::unreadable;
}

/// A slot for every tile.
void make_slots(Image& image) {
  const std::size_t tiles = tile_count(image.frame.width, image.frame.height);
  const bool has_sums = image.view.integrator == Integrator::path;
  image.trees.resize(tiles);
  image.sample_colors.resize(has_sums ? 0 : tiles);
  image.light_sums.resize(has_sums ? tiles : 0);
}

/// What has to be traced or built again. Clears in `content` what is lost.
CacheLosses take_losses(const std::vector<Finding>& findings, CacheContent& content) {
  CacheLosses losses;
  std::set<std::size_t> tiles, tunnels;
  Image& image = content.image;
  const std::size_t all = tile_count(image.frame.width, image.frame.height);
  for (const Finding& finding : findings) {
    losses.faults.push_back(finding.answer);
    const bool is_group = finding.part.part == Part::trees || finding.part.part == Part::tunnels;
    const TileGroup lost =
        is_group ? cache_group(content.camera, image.view.samples, finding.part.group) : TileGroup{0, all};
    for (std::size_t tile = lost.first; tile < lost.last; ++tile)
      (finding.part.part == Part::tunnels ? tunnels : tiles).insert(tile);
    if (finding.part.part == Part::paths) image.paths = PathTable();
  }
  image.frame.pixels.resize(std::size_t{image.frame.width} * image.frame.height);
  make_slots(image);
  for (const std::size_t tile : tiles) {
    image.trees[tile] = TileTrees();
    if (!image.sample_colors.empty()) image.sample_colors[tile].clear();
    if (!image.light_sums.empty()) image.light_sums[tile] = PackedSums();
  }
  for (const std::size_t tile : tunnels) {
    content.around_tiles[tile].clear();
    content.tunnels[tile] = TileTunnels();
  }
  losses.tiles.assign(tiles.begin(), tiles.end());
  losses.tunnels.assign(tunnels.begin(), tunnels.end());
  return losses;
}

constexpr std::size_t kFrame = 3, kPaths = 4, kFirstTrees = 5;  // of parts_of(), where the scene comes first

/// Frame and paths, then trees, which are checked against the paths and take over pixels of the frame, and tunnels.
std::vector<Finding> read_image(std::span<const PartFile> parts, Reading& reading) {
  Image& image = reading.content.image;
  require(parts[kFrame].part == Part::frame && parts[kPaths].part == Part::paths, "parts have their places");
  std::vector<Finding> findings = read_parts(parts.subspan(kFrame, 2), reading);
  reading.uses_trees = std::ranges::none_of(findings, is_fault);
  if (reading.uses_trees) {
    const PathLayout layout{reading.content.lights, image.view.shadow_bits};
    for (std::size_t i = 0; i < image.paths.size(); ++i)
      reading.hits_of_path.push_back(hit_count(image.paths.words(PathId(static_cast<std::uint32_t>(i))), layout));
    make_slots(image);
  }
  const auto has_trees = [](const PartFile& part) { return part.part == Part::trees; };
  const auto trees = static_cast<std::size_t>(std::ranges::count_if(parts, has_trees));
  std::ranges::move(read_parts(parts.subspan(kFirstTrees, trees), reading), std::back_inserter(findings));
  if (reading.users.tunnels != TunnelReading::skip)
    std::ranges::move(read_parts(parts.subspan(kFirstTrees + trees), reading), std::back_inserter(findings));
  return findings;
}

/// Reads everything that can be read. Returns what is wrong, in the order of the files.
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
  content.manifest = std::make_shared<const Manifest>(manifest);
  content.storage = manifest.storage;
  content.pieces = manifest.pieces;
  content.camera = manifest.camera;
  content.image.view = manifest.view;
  content.image.frame = {manifest.camera.width, manifest.camera.height, {}};
  content.objects = manifest.objects;
  content.lights = manifest.lights;
  content.shared = manifest.shared;
  content.scene_hash = manifest.identity.scene_hash;
  content.pyramids = std::make_shared<PyramidStore>();
  content.document.assets = reading.assets;
  std::vector<Finding> findings;
  if (options_hash(content) != manifest.identity.options_hash)
    findings.push_back(
        {{CacheFault::damaged, std::string(kManifestName), "the options do not have the hash given"}, {}});

  const bool keeps_tunnels =
      has_tunnels(content.storage, content.camera) && reading.users.tunnels == TunnelReading::keep;
  content.around_tiles.resize(keeps_tunnels ? tile_count(content.camera.width, content.camera.height) : 0);
  content.tunnels.resize(content.around_tiles.size());
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

bool has_tunnels(const StorageOptions& storage, const Camera& camera) {
  return !cell_levels(storage.tunnels, camera.width, camera.height).empty();
}

std::string_view sentence(CacheFault fault) {
  switch (fault) {
    case CacheFault::none:
      return "the cache is sound";
    case CacheFault::missing:
      return "there is no cache here";
    case CacheFault::not_a_cache:
      return "this is not a relook cache";
    case CacheFault::unreadable:
      return "the cache cannot be read";
    case CacheFault::other_arithmetic:
      return "the cache holds the bits of another arithmetic; preprocess again";
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

std::string explanation(const CacheAnswer& answer) {
  if (answer.fault == CacheFault::unreadable && !answer.detail.empty()) return answer.detail;
  if (answer.fault == CacheFault::other_arithmetic && !answer.detail.empty())
    return answer.detail + "; preprocess again";
  const std::string what(sentence(answer.fault));
  return answer.detail.empty() ? what : what + " (" + answer.detail + ")";
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

namespace {

/// Counts the files below a cache and reports those that its manifest does not name, if there is a manifest.
void look_for_strays(const std::filesystem::path& path, const Manifest& manifest, CacheReport& report) {
  const auto find = [&](const std::string& finding, CacheAnswer answer) {
    report.findings.push_back(finding);
    if (report.worst.fault == CacheFault::none) report.worst = std::move(answer);
  };
  std::set<std::string> known{std::string(kManifestName)};
  for (const CacheFile& file : manifest.files) known.insert(file.name);
  std::error_code error;
  for (auto entry = std::filesystem::recursive_directory_iterator(path, error);
       !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) continue;
    const std::string name = entry->path().lexically_relative(path).generic_string();
    const bool is_file = entry->is_regular_file(ignored);
    if (is_file && !known.contains(name) && is_system_name(entry->path().filename().string())) {
      report.notes.push_back(printable(name) + ": left by the system, not of this cache");
      continue;
    }
    ++report.files;
    report.bytes += is_file ? entry->file_size(ignored) : 0;
    if (manifest.files.empty() || known.contains(name)) continue;
    find(printable(name) + ": not a file of this cache",
         {CacheFault::damaged, printable(name), "not a file of this cache"});
  }
  if (error)
    find("cannot be listed: " + error.message(), {CacheFault::unreadable, "", "cannot be listed: " + error.message()});
}

}  // namespace

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

  if (report.findings.empty() && count_pieces(reading.content) != reading.manifest.pieces) {
    report.findings.push_back(std::string(kManifestName) + ": the cache does not have as many pieces as it says");
    report.worst = {CacheFault::damaged, std::string(kManifestName),
                    "the cache does not have as many pieces as it says"};
  }
  look_for_strays(path, reading.manifest, report);
  return report;
}

}  // namespace relook
