// A cache directory as a whole: what preprocess publishes and replay reads. Self-contained and immutable; the format is
// described in FORMAT.md beside this file.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/json.h"
#include "frame/image.h"
#include "region/tile_tunnels.h"
#include "region/tunnel_shape.h"
#include "scene/look/look.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {

/// What preprocess was told about which ray trees and tunnels to store.
struct StorageOptions {
  double ray_trees_percent = 100;           // of the samples; the others' hits are left out
  std::optional<std::uint64_t> disk_bytes;  // of the whole cache, at most
  TunnelShape tunnels{0, 2, std::nullopt};
  std::uint32_t atoms = 0;   // depth of the node hierarchy from which tunnels count nodes as one object; 0: none
  std::uint32_t groups = 4;  // of a replay that does not say otherwise: most paths of a group; 0: none
  double color_trees_percent = 100;  // of such a replay: share of the samples whose colour trees are kept
  /// Are tunnels of a shape these? Where a region has one, paths make no difference.
  [[nodiscard]] bool has_tunnels_like(const TunnelShape& shape, std::uint32_t of_atoms) const {
    return tunnels == shape && (tunnels.of_region < 2 || atoms == of_atoms);
  }
  bool operator==(const StorageOptions&) const = default;
};

/// How many of what an image has (Table 2 of the paper).
struct PieceNumbers {
  std::uint64_t ray_paths = 0;
  std::uint64_t groups = 0;     // the largest regions whose samples all have one path, single pixels included
  std::uint64_t ray_trees = 0;  // that are stored
  std::uint64_t tunnels = 0;    // that are stored, with those above the tiles
  bool operator==(const PieceNumbers&) const = default;
};
[[nodiscard]] bool has_tunnels(const StorageOptions& storage, const Camera& camera);
struct CacheContent;
/// Counts them.
[[nodiscard]] PieceNumbers count_pieces(const CacheContent& content);

struct Manifest;

/// Everything a replay needs. Plain data; image/cached_image.h compiles the scene.
struct CacheContent {
  LookDocument document;  // with meshes and encoded images
  std::shared_ptr<PyramidStore> pyramids;
  Camera camera;
  std::string scene_hash;                 // XXH3-128 over the scene file's bytes and the look patch
  std::uint32_t objects = 0, lights = 0;  // of the compiled scene: all slots; living lights
  std::uint32_t shared = 0;               // of path: how many more lights than sums of lights (scene/light_sums.h)
  std::optional<double> noise;            // of the frame (image/layers/half_light.h), where it is known
  Image image;                            // seen by `camera`; its paths are laid out for `lights`
  std::vector<Sections> around_tiles;     // [tiles] around all tunnels of each; empty: there are no tunnels
  std::vector<TileTunnels> tunnels;       // [tiles] an empty one: left out; with `around_tiles`
  StorageOptions storage;
  PieceNumbers pieces;
  std::shared_ptr<const Manifest> manifest;  // that it has been read by; null: it has not been read
};

/// Why a directory cannot be used as a cache. Each has one sentence.
enum class CacheFault {
  none,
  missing,
  not_a_cache,
  unreadable,  // may be sound, but may not be opened
  other_version,
  other_arithmetic,
  other_scene,
  other_options,
  truncated,
  damaged
};
[[nodiscard]] std::string_view sentence(CacheFault fault);

struct CacheAnswer {
  CacheFault fault = CacheFault::none;
  std::string file;    // which file of the cache, relative
  std::string detail;  // what was looked at: "block hash mismatch in section hits"
};
/// The sentence and the detail, or the detail alone where it says all.
[[nodiscard]] std::string explanation(const CacheAnswer& answer);

/// Creates the parents of `path` and, for a moment, a folder beside it: what cannot be written is found out before the
/// work. Throws IoError, ResourceError.
void require_writable(const std::filesystem::path& path);

/// Takes hits and tunnels out of `content`, those of the tile groups that are worth the least (paper 4.3: time to
/// rebuild over bytes on disk, of tunnels times their surface area), until its cache is no larger than `bytes`. Throws
/// ResourceError that names the least it takes. `tunnel_areas`: by tile, if there are tunnels, see PieceFacts. Times
/// are estimates, so that a cache's bytes do not depend on a clock.
void fit_to_disk(CacheContent& content, std::uint64_t bytes, std::span<const double> tunnel_areas = {});

/// What becomes of another cache that is at the path of a new one.
enum class OldCache { replace, keep };

/// Writes to a temporary folder beside `path` and publishes by rename. A cache at `path` is replaced whole or, to be
/// kept, refused unless it is the very same; anything else there is refused (UsageError), also foreign files in a
/// cache. Bytes do not depend on the thread count. Throws IoError, ResourceError; on failure nothing remains.
void write_cache(const std::filesystem::path& path, const CacheContent& content, OldCache old = OldCache::replace);

/// Is the cache at `path` the one that would be written for `wanted`, of which only the scene's hash, the view and the
/// storage options are looked at, and does every file have its hash? `detail` of other_scene and other_options: what
/// the cache at hand has otherwise, like "resolution (960x540) and samples (4)".
[[nodiscard]] CacheAnswer match_cache(const std::filesystem::path& path, const CacheContent& wanted);

/// Damage that can be made good, because what is lost follows from the scene: frame, ray paths, ray trees.
struct CacheLosses {
  std::vector<CacheAnswer> faults;   // one a file, in the order of the files
  std::vector<std::size_t> tiles;    // to be traced again, increasing; all of them when the paths are lost
  std::vector<std::size_t> tunnels;  // of these tiles they are to be built again, increasing
  [[nodiscard]] bool empty() const { return faults.empty(); }
};

/// What becomes of tunnels that are read.
enum class TunnelReading : std::uint8_t {
  keep,
  check,  // every byte, but they are not kept
  skip    // their files are not opened; see StoredTunnels
};

/// Who is called while a cache is being read. What they do to the content stays done.
struct CacheUsers {
  /// All but the image is there and sound: document, assets, pyramids and the plain values.
  std::function<void(CacheContent&)> scene;
  /// The trees and colours, or sums of light, of a tile are there and sound; they may be taken to where there is more
  /// room. Comes after `scene`, for several tiles at once; the vectors of tiles keep their elements where they are.
  std::function<void(CacheContent&, std::size_t tile)> tile;
  TunnelReading tunnels = TunnelReading::keep;
};

/// Reads and verifies every hash and every index. On any fault `content` is untouched; with `losses`, files that are
/// missing or do not have their hash are none if they can be made good: then the tiles of `losses` have no trees, no
/// colours and no sums of light, and a lost path table is empty.
[[nodiscard]] CacheAnswer read_cache(const std::filesystem::path& path, CacheContent& content,
                                     CacheLosses* losses = nullptr, const CacheUsers& users = {});

/// Every byte and every invariant; one line per finding, empty if the cache is sound. Goes on after the first fault.
struct CacheReport {
  CacheAnswer worst;
  std::vector<std::string> findings;
  std::vector<std::string> notes;      // files that systems leave in folders, no fault
  std::uint64_t files = 0, bytes = 0;  // without those of the notes
};
[[nodiscard]] CacheReport check_cache(const std::filesystem::path& path);

/// XXH3-128 of the camera, the resolution and the sampling options.
[[nodiscard]] std::string options_hash(const CacheContent& content);

/// The manifest alone (for inspect): JSON with version, hashes, options, files and sizes.
[[nodiscard]] CacheAnswer read_manifest(const std::filesystem::path& path, Json& manifest);

}  // namespace relook
