// `relook preprocess`: renders a scene and writes the cache from which replays start.
#include <optional>

#include "base/system/memory.h"
#include "cache/cache.h"
#include "image/cached_image.h"
#include "image/image_pieces.h"
#include "image/layers/half_light.h"
#include "image/path_classes.h"
#include "image/render.h"
#include "input/load_cache.h"
#include "input/load_scene.h"
#include "options/cache_output.h"
#include "options/needless_options.h"
#include "options/outputs.h"
#include "run/step_text.h"
#include "verbs.h"

namespace relook {

namespace {

/// Keeps the ray trees of a share of the samples.
void forget_trees(Image& image, double share) {
  std::vector<std::uint64_t> hits;
  for (const TileTrees& trees : image.trees) hits.push_back(trees.hits.size());
  for (const std::size_t tile : tiles_beyond(share, image.trees, hits)) {
    give_back(image.trees[tile].first_hit);
    give_back(image.trees[tile].hits);
  }
}

std::uint64_t bytes_of_files(const Json& manifest) {
  std::uint64_t bytes = 0;
  for (const Json& file : manifest["content"]["files"]) bytes += file["bytes"].get<std::uint64_t>();
  return bytes;
}

/// What is known of a cache from its manifest.
Json summary(const std::string& cache, const Json& manifest) {
  const Json& content = manifest["content"];
  const Json& camera = content["camera"];
  return {{"cache", cache},
          {"scene_hash", content["scene"]},
          {"camera", camera["name"]},
          {"resolution", {camera["width"], camera["height"]}},
          {"objects", content["objects"]},
          {"lights", content["lights"]},
          {"bytes", bytes_of_files(manifest)}};
}

ExitCode say_complete(const std::string& cache, const Json& manifest, Console& console) {
  console.part_done();
  console.line(cache + ": complete already, " + std::to_string(bytes_of_files(manifest)) + " bytes; nothing was done");
  Json result = summary(cache, manifest);
  result["complete"] = true;
  console.json(result);
  return ExitCode::ok;
}

/// What a preprocess holds it keeps until it has been written, so a limit can only end it.
void keep_within(const std::optional<std::uint64_t>& memory_bytes) {
  if (memory_bytes && resident_set_bytes() > *memory_bytes)
    throw ResourceError("--memory", "this preprocess needs more than " + std::to_string(*memory_bytes >> 20) + "M");
}

}  // namespace

ExitCode run_preprocess(const Arguments& arguments, Console& console) {
  if (const std::optional<Json> manifest = finished_cache(arguments, console))
    return say_complete(arguments.output, *manifest, console);
  std::optional<TraceScope> span(std::in_place, console.trace(), "load scene");
  std::optional<Interrupt::Expendable> loading(std::in_place, console.interrupt());
  LoadedScene loaded = load_scene(arguments.inputs[0], arguments.view);
  loading.reset();
  console.warn(idle_structures_warning(arguments, arguments.view.sampling.integrator));
  console.warn(loaded.warnings);
  require_not_outputs(arguments, loaded.files, "a file of the scene");
  require_writable(arguments.output);
  span.emplace(console.trace(), "preprocess");
  RenderStats stats;
  const StorageOptions storage = storage_options(arguments.structures);
  TunnelRecord tunnels;
  tunnels.shape = storage.tunnels;
  if (storage.atoms > 0) tunnels.atoms = atoms_of(*loaded.state, storage.atoms);
  const auto within_memory = [&, show = console.stage("preprocess")](double share) {
    keep_within(arguments.structures.memory_bytes);
    if (show) show(share);
  };
  Image image = preprocess(loaded.state->scene(), arguments.view.sampling, stats, within_memory, &tunnels);
  console.end_stage();
  const std::optional<double> share = noise(loaded.state->scene(), image.view, image.frame);
  span.emplace(console.trace(), "write cache");
  const std::size_t paths = image.paths.size();
  forget_trees(image, arguments.structures.ray_trees_percent / 100);
  CacheContent content = cache_content(*loaded.state, std::move(image), loaded.hash, std::move(tunnels));
  content.storage = storage;
  content.noise = share;
  console.check_interrupt();
  keep_within(arguments.structures.memory_bytes);
  if (arguments.structures.disk_bytes)
    fit_to_disk(content, *arguments.structures.disk_bytes, tunnel_areas(*loaded.state, content));
  write_cache(arguments.output, content, arguments.overwrite ? OldCache::replace : OldCache::keep);
  span.reset();
  console.part_done();

  Json manifest;
  require_sound(read_manifest(arguments.output, manifest), arguments.output);
  console.line(arguments.output + ": " + std::to_string(content.objects) + " objects, " + std::to_string(paths) +
               " ray paths, " + std::to_string(bytes_of_files(manifest)) + " bytes, " +
               std::to_string(stats.render_seconds) + " s" + noise_text(share));
  Json result = summary(arguments.output, manifest);
  result.update({{"ray_paths", paths},
                 {"samples_total", stats.counters.samples_total},
                 {"ray_updates", stats.counters.ray_updates},
                 {"shadow_updates", stats.counters.shadow_updates},
                 {"noise", share ? Json(*share) : Json()},
                 {"build_seconds", stats.build_seconds},
                 {"render_seconds", stats.render_seconds}});
  console.json(result);
  return ExitCode::ok;
}

}  // namespace relook
