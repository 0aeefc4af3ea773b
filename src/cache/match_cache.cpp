// match_cache() of cache.h: is the cache that is there the one that `preprocess` would write? Compared by manifest and
// by the hashes of all files; what it has otherwise is said in words.
#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "cache/manifest.h"

namespace relook {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string lens_text(const Lens& lens) {
  return lens.radius > 0 ? number(lens.radius) + ":" + number(lens.focus) : "none";
}

/// The same camera, whatever the resolution, on which its extent depends, too.
bool same_view(const Camera& a, const Camera& b) {
  const bool same_size = a.width == b.width && a.height == b.height;
  const bool same_extent = a.half_width == b.half_width && a.half_height == b.half_height;
  return a.name == b.name && a.node == b.node && a.orthographic == b.orthographic && a.eye == b.eye &&
         a.right == b.right && a.up == b.up && a.forward == b.forward && a.near == b.near && a.far == b.far &&
         (!same_size || same_extent);
}

/// "A", "A and B", "A, B and C".
std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i)
    list += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return list;
}

/// What a cache at hand has otherwise than the one wanted.
CacheAnswer other_content(const Manifest& there, const Manifest& wanted) {
  std::vector<std::string> others;
  const auto compare = [&](bool is_same, const std::string& what, const std::string& value) {
    if (!is_same) others.push_back(value.empty() ? what : what + " (" + value + ")");
  };
  const Camera &camera = there.camera, &other = wanted.camera;
  const StorageOptions& storage = there.storage;
  const bool is_same_scene = there.identity.scene_hash == wanted.identity.scene_hash;
  compare(is_same_scene, "scene", "");
  compare(same_view(camera, other), "camera", printable(camera.name));
  compare(camera.width == other.width && camera.height == other.height, "resolution",
          std::to_string(camera.width) + "x" + std::to_string(camera.height));
  const ViewOptions &view = there.view, &other_view = wanted.view;
  compare(view.samples == other_view.samples, "--samples", std::to_string(view.samples));
  compare(view.max_depth == other_view.max_depth, "--max-depth", std::to_string(view.max_depth));
  compare(view.shadow_bits == other_view.shadow_bits, "--shadow-bits", std::to_string(view.shadow_bits));
  compare(view.integrator == other_view.integrator, "--integrator", std::string(integrator_word(view.integrator)));
  if (view.integrator == Integrator::path && other_view.integrator == Integrator::path) {
    compare(view.diffuse_depth == other_view.diffuse_depth, "--diffuse-depth", std::to_string(view.diffuse_depth));
    compare(view.glossy_depth == other_view.glossy_depth, "--glossy-depth", std::to_string(view.glossy_depth));
    compare(view.transmission_depth == other_view.transmission_depth, "--transmission-depth",
            std::to_string(view.transmission_depth));
    compare(view.lens == other_view.lens, "--lens", lens_text(view.lens));
  }
  compare(storage.ray_trees_percent == wanted.storage.ray_trees_percent, "--ray-trees",
          number(storage.ray_trees_percent));
  compare(storage.disk_bytes == wanted.storage.disk_bytes, "--disk",
          storage.disk_bytes ? std::to_string(*storage.disk_bytes) + " bytes" : "none");
  const TunnelShape &shape = storage.tunnels, &other_shape = wanted.storage.tunnels;
  compare(shape.of_region == other_shape.of_region, "--tunnels", std::to_string(shape.of_region));
  compare(shape.dropped_levels == other_shape.dropped_levels, "--tunnel-levels", std::to_string(shape.dropped_levels));
  compare(shape.of_image == other_shape.of_image, "--most-tunnels",
          shape.of_image ? std::to_string(*shape.of_image) : "none");
  compare(storage.atoms == wanted.storage.atoms, "--atoms", std::to_string(storage.atoms));
  compare(storage.groups == wanted.storage.groups, "--groups", std::to_string(storage.groups));
  compare(storage.color_trees_percent == wanted.storage.color_trees_percent, "--color-trees",
          number(storage.color_trees_percent));
  if (others.empty()) return {};
  return {is_same_scene ? CacheFault::other_options : CacheFault::other_scene, std::string(kManifestName),
          listed(others)};
}

CacheAnswer check_hash(const std::filesystem::path& cache, const CacheFile& file) {
  try {
    check_sound(hash128(load_file(cache, file)) == file.hash, "file hash mismatch");
    return {};
  } catch (const CacheDamage& damage) {
    return {damage.fault, file.name, damage.what()};
  }
}

}  // namespace

CacheAnswer match_cache(const std::filesystem::path& path, const CacheContent& wanted) {
  try {
    const Manifest manifest = load_manifest(path);
    if (CacheAnswer answer = other_content(manifest, manifest_of(wanted)); answer.fault != CacheFault::none)
      return answer;
    std::vector<CacheAnswer> answers(manifest.files.size());
    parallel_for(answers.size(), [&](std::size_t i) { answers[i] = check_hash(path, manifest.files[i]); });
    const auto fault = std::ranges::find_if(answers, [](const CacheAnswer& a) { return a.fault != CacheFault::none; });
    return fault == answers.end() ? CacheAnswer() : *fault;
  } catch (const CacheDamage& damage) {
    return {damage.fault, std::string(kManifestName), damage.what()};
  }
}

}  // namespace relook
