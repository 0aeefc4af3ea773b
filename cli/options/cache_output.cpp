#include "options/cache_output.h"

#include "cache/cache.h"
#include "cache/cache_folder.h"
#include "cache/staged_folder.h"
#include "input/load_scene.h"

namespace relook {
namespace {

/// A fault of a cache that is in the way, in words.
std::string words_of(const CacheAnswer& answer) {
  switch (answer.fault) {
    case CacheFault::other_scene:
    case CacheFault::other_options:
      return "holds a cache of another " + answer.detail;
    case CacheFault::other_version:
      return "holds a cache of another version (" + answer.detail + ")";
    case CacheFault::other_arithmetic:
      return "holds a cache " + answer.detail;
    default:
      return "holds a damaged cache (" +
             (answer.file.empty() ? "no MANIFEST.json" : answer.file + ": " + answer.detail) + ")";
  }
}

void require_match(const CacheAnswer& answer, const std::string& output) {
  if (answer.fault == CacheFault::none) return;
  if (answer.fault == CacheFault::unreadable) throw IoError(output, answer.file + ": " + answer.detail);
  throw UsageError(output, words_of(answer) + "; --overwrite replaces it");
}

/// The cache that is asked for, as far as match_cache() looks at it.
CacheContent wanted_cache(const Arguments& arguments, Console& console) {
  LoadedDocument loaded = load_document(arguments.inputs[0], arguments.view);
  CacheContent wanted;
  wanted.camera = set_up_view(loaded, arguments.view);
  console.warn(loaded.warnings);
  wanted.image.view = arguments.view.sampling;
  wanted.scene_hash = loaded.hash;
  wanted.storage = storage_options(arguments.structures);
  return wanted;
}

}  // namespace

StorageOptions storage_options(const StructureOptions& structures) {
  return {structures.ray_trees_percent,
          structures.disk_bytes,
          {structures.tunnels, structures.tunnel_levels, structures.most_tunnels},
          structures.atoms,
          structures.groups,
          structures.color_trees_percent};
}

std::optional<Json> finished_cache(const Arguments& arguments, Console& console) {
  const std::string& output = arguments.output;
  const Occupant occupant = occupant_of(output);
  if (occupant.kind == Occupant::Kind::other) throw UsageError(output, occupant.what);
  if (occupant.kind == Occupant::Kind::none) return std::nullopt;
  if (arguments.overwrite) {
    if (occupant.foreign.empty()) return std::nullopt;
    throw UsageError(output, "holds " + occupant.foreign + ", which relook did not write");
  }
  Json manifest;
  require_match(read_manifest(output, manifest), output);
  require_match(match_cache(output, wanted_cache(arguments, console)), output);
  StagedFolder::remove_abandoned(output);
  return manifest;
}

}  // namespace relook
