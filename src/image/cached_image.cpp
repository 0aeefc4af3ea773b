#include "image/cached_image.h"

#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/json.h"
#include "base/parallel.h"
#include "image/cached_tunnels.h"
#include "image/image_pieces.h"
#include "image/render.h"
#include "scene/light_sums.h"
#include "trace/tree/path_cursor.h"

namespace relook {
namespace {

std::uint64_t triangle_count(const Scene& scene, std::uint32_t object_index) {
  const Object& object = scene.objects[object_index];
  const std::uint64_t triangles = scene.mesh(object.mesh).triangles.size();
  return object.displacement ? triangles << (2 * object.displacement->subdivide) : triangles;
}

/// Triangles of the objects that a sample with this path hits, in the order of its hits.
std::vector<std::uint64_t> triangles_hit(const Scene& scene, std::span<const std::uint32_t> words,
                                         const PathLayout& layout) {
  std::vector<std::uint64_t> triangles;
  for (PathCursor cursor(words, layout); !cursor.at_end();) {
    const PathNode node = cursor.next();
    if (node.is_miss()) continue;
    triangles.push_back(triangle_count(scene, node.object.index()));
    EntryReader entries(node.entries, layout.shadow_bits);
    for (std::size_t light = 0; light < layout.lights; ++light) {
      const ShadowState state = shadow_state(node.lights, light);
      const LightEntry entry = entries.next(state);
      if (state != ShadowState::filtered) continue;
      for (const std::uint32_t object : entry.objects) triangles.push_back(triangle_count(scene, object));
    }
  }
  return triangles;
}

}  // namespace

CacheContent cache_content(const SceneState& state, Image image, std::string scene_hash, TunnelRecord tunnels) {
  CacheContent content;
  content.document = state.document();
  content.pyramids = state.pyramids();
  content.camera = state.scene().camera;
  content.scene_hash = std::move(scene_hash);
  content.objects = static_cast<std::uint32_t>(state.scene().objects.size());
  content.lights = static_cast<std::uint32_t>(state.scene().light_order.size());
  content.shared = static_cast<std::uint32_t>(lights_in_shared_sums(state.scene()));
  content.image = std::move(image);
  content.storage.tunnels = tunnels.shape;
  content.around_tiles = std::move(tunnels.around);
  content.tunnels = std::move(tunnels.of_tiles);
  return content;
}

std::vector<double> tunnel_areas(const SceneState& state, const CacheContent& content) {
  const std::vector<LightEnd> lights = light_ends(state.scene());
  std::vector<double> areas;
  double sum = 0;
  for (const Sections& tunnel : content.around_tiles) sum += areas.emplace_back(surface_area(tunnel, lights));
  const double mean = sum / static_cast<double>(areas.size());
  for (double& area : areas) area = mean > 0 && std::isfinite(area / mean) ? area / mean : 1;
  return areas;
}

HitCheck::HitCheck(const Scene& scene, const PathTable& paths, std::uint32_t shadow_bits) {
  most_.reserve(paths.size());
  const PathLayout layout{scene.light_order.size(), shadow_bits};
  for (std::size_t i = 0; i < paths.size(); ++i)
    most_.push_back(triangles_hit(scene, paths.words(PathId(static_cast<std::uint32_t>(i))), layout));
}

bool HitCheck::is_sound(const TileTrees& tile) const {
  if (!has_hits(tile)) return true;
  for (std::size_t sample = 0; sample < tile.paths.size(); ++sample) {
    const std::vector<std::uint64_t>& most = most_[tile.paths[sample].index()];
    const std::span<const Hit> hits = tile.hits_of(sample);
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (hits[i].primitive >= most[i]) return false;
  }
  return true;
}

namespace {

/// Compiles the look document of `content`, which is moved from.
CacheAnswer compile(CacheContent& content, std::unique_ptr<SceneState>& state) {
  try {
    state = std::make_unique<SceneState>(std::move(content.document), content.camera, content.pyramids,
                                         content.image.view.integrator);
  } catch (const InputError& error) {
    return {CacheFault::damaged, "look.json", error.what()};
  }
  const Scene& scene = state->scene();
  if (scene.objects.size() != content.objects || scene.light_order.size() != content.lights ||
      lights_in_shared_sums(scene) != content.shared)
    return {CacheFault::damaged, "look.json", "the look document does not have the objects and lights of the paths"};
  return {};
}

/// make_good() for an image; the answer is about its paths.
CacheAnswer trace_again(const Scene& scene, const CacheLosses& losses, Image& image) {
  if (losses.empty()) return {};
  const std::size_t known_paths = image.paths.size();
  RenderStats stats;
  rebuild_tiles(scene, image, losses.tiles, stats);
  if (known_paths > 0 && image.paths.size() != known_paths)
    return {CacheFault::damaged, "paths", "the table lacks paths of the scene"};
  return {};
}

/// What is kept of some tiles.
Moves all_of(const std::vector<std::size_t>& tiles, const Image& image) {
  Moves moves;
  for (const std::size_t tile : tiles) {
    moves.ray_trees += image.trees[tile].paths.size();
    moves.bytes += hit_bytes(image.trees[tile]);
    if (!image.sample_colors.empty()) {
      ++moves.sample_colors;
      moves.bytes += image.sample_colors[tile].size() * sizeof(Rgba);
    }
    if (!image.light_sums.empty()) {
      ++moves.light_sums;
      moves.bytes += image.light_sums[tile].bytes();
    }
  }
  return moves;
}

}  // namespace

CacheAnswer make_good(CacheContent& content, const CacheLosses& losses) {
  if (losses.empty()) return {};
  CacheContent scene_part;
  scene_part.document = content.document;
  scene_part.camera = content.camera;
  scene_part.image.view = content.image.view;
  scene_part.pyramids = content.pyramids;
  scene_part.objects = content.objects;
  scene_part.lights = content.lights;
  scene_part.shared = content.shared;
  scene_part.image.view = content.image.view;
  std::unique_ptr<SceneState> state;
  CacheAnswer answer = compile(scene_part, state);
  if (answer.fault != CacheFault::none) return answer;
  answer = trace_again(state->scene(), losses, content.image);
  if (answer.fault == CacheFault::none) build_tunnels_again(*state, losses.tunnels, content);
  return answer;
}

CacheAnswer open_cache(const std::filesystem::path& path, bool mends, OpenedCache& opened, Residency* residency) {
  CacheContent content;
  CacheLosses losses;
  std::unique_ptr<SceneState> state;
  CacheAnswer of_scene;
  std::once_flag is_prepared;
  std::optional<HitCheck> check;
  std::atomic<bool> is_broken = false;
  CacheUsers users;
  users.tunnels = mends ? TunnelReading::skip : TunnelReading::check;
  users.scene = [&](CacheContent& scene_part) { of_scene = compile(scene_part, state); };
  if (residency != nullptr)
    users.tile = [&](CacheContent& so_far, std::size_t tile) {
      if (!state) return;
      std::call_once(is_prepared, [&] {
        check.emplace(state->scene(), so_far.image.paths, so_far.image.view.shadow_bits);
        add_image_pieces(*residency, so_far.image);
      });
      if (!check->is_sound(so_far.image.trees[tile])) is_broken = true;
      note_pieces(*residency, tile, so_far.image);
    };
  if (CacheAnswer answer = read_cache(path, content, mends ? &losses : nullptr, users);
      answer.fault != CacheFault::none)
    return answer;
  if (of_scene.fault != CacheFault::none) return of_scene;
  Image& image = content.image;
  if (CacheAnswer answer = trace_again(state->scene(), losses, image); answer.fault != CacheFault::none) return answer;
  const Moves rebuilt = all_of(losses.tiles, image);
  if (!check) {
    check.emplace(state->scene(), image.paths, image.view.shadow_bits);
    parallel_for(image.trees.size(), [&](std::size_t tile) {
      if (!check->is_sound(image.trees[tile])) is_broken = true;
    });
  } else {
    for (const std::size_t tile : losses.tiles) note_pieces(*residency, tile, image);
  }
  if (is_broken) return {CacheFault::damaged, "trees", "a hit names a triangle that its object does not have"};
  auto tunnels = StoredTunnels::of_cache(path, content.manifest, image.paths);
  opened = {std::move(state),   std::move(image), std::move(content.scene_hash), std::move(losses), rebuilt,
            std::move(tunnels), content.manifest};
  return {};
}

}  // namespace relook
