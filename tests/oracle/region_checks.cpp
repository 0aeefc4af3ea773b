#include "region_checks.h"

#include "image/path_classes.h"
#include "image/sampling.h"
#include "trace/shadow/shadow_segment.h"

namespace relook {
namespace {

PathClasses classes_of(const Replayer& replayer) {
  const std::uint32_t atoms = replayer.regions().options().atoms;
  PathClasses classes(atoms > 0);
  classes.extend(replayer.image().paths, layout_of(replayer),
                 atoms > 0 ? atoms_of(replayer.state(), atoms) : std::vector<ObjectId>());
  return classes;
}

/// Is the point in the hull of the two boxes, up to rounding?
bool is_inside(const Box& from, const Box& to, const Point& at) {
  const Point around(1e-4F, 1e-4F, 1e-4F);
  return touches(Shaft{from, to}, Box(at - around, at + around));
}

/// Looks whether the segments of one tree lie in a tunnel.
class TreeCheck {
 public:
  TreeCheck(const Scene& scene, const TreeBlock& block, std::uint32_t root, std::span<const TunnelSection> tunnel)
      : scene_(scene), block_(block), root_(root), tunnel_(tunnel) {}

  [[nodiscard]] bool is_enclosed(std::size_t& segments) {
    std::vector<History> histories;
    for (std::uint32_t i = root_; i < block_.nodes.size(); ++i) {
      const RayNode& node = block_.nodes[i];
      histories.push_back(i == root_ ? History::primary() : histories[node.parent - root_].child(node.ray.branch));
      if (!has_ray(node, histories.back())) return false;
      ++segments;
      for (std::size_t light = 0; !node.object.is_none() && light < scene_.light_order.size(); ++light) {
        const ShadowState state = block_.lights[node.first_light + light].state;
        if (state == ShadowState::facing_away) continue;
        if (!has_shadow(node, histories.back(), light, state)) return false;
        ++segments;
      }
    }
    return true;
  }

 private:
  [[nodiscard]] const TunnelSection* section(History history) const {
    const auto it = std::ranges::find(tunnel_, history, &TunnelSection::history);
    return it == tunnel_.end() ? nullptr : &*it;
  }
  [[nodiscard]] bool has_ray(const RayNode& node, History history) const {
    const TunnelSection* own = section(history);
    const TunnelSection* above = section(history.parent());
    if (own == nullptr || above == nullptr) return false;
    Box origins = above->points;
    if (history.is_folded()) origins.extendBy(own->points);
    const bool missed = node.object.is_none();
    for (const float t : {0.0F, 0.3F, 0.7F, 1.0F}) {
      const float start = node.ray.travelled;  // of a ray that goes straight on
      const float length = start + (missed ? 50.0F : node.length - start) * t;
      const Box to = missed ? extruded(origins, own->leaving, 50).to : own->points;
      if (!is_inside(origins, to, node.ray.origin + node.ray.direction * length)) return false;
    }
    return true;
  }
  [[nodiscard]] bool has_shadow(const RayNode& node, History history, std::size_t light, ShadowState state) const {
    const TunnelSection* own = section(history);
    const LightEnd end = light_ends(scene_)[light];
    const ShadowSegment segment = shadow_segment(node, scene_.light(scene_.light_order[light]));
    const LightSet lights = state == ShadowState::blocked ? own->blocked : own->open;
    if (!lights.has(light)) return false;
    const Box to = end.directional ? extruded(own->points, end.end, 50).to : end.end;
    for (const float t : {0.0F, 0.4F, 1.0F})
      if (!is_inside(own->points, to, segment.origin + segment.direction * (end.directional ? 50 * t : t)))
        return false;
    return true;
  }

  const Scene& scene_;
  const TreeBlock& block_;
  std::uint32_t root_;
  std::span<const TunnelSection> tunnel_;
};

/// In some tunnel of each region from the cell up to the tile.
bool is_enclosed_everywhere(const Scene& scene, const TreeBlock& block, const TileTunnels& tunnels, std::uint32_t cell,
                            std::size_t& segments) {
  const TileGrid& grid = tunnels.grid();
  std::vector<bool> holds(grid.regions(), false);
  holds[cell] = true;
  for (std::uint32_t region = cell; region < grid.regions(); ++region) {
    if (!grid.is_cell(region))
      for (std::uint32_t child : grid.children_of(region)) holds[region] = holds[region] || holds[child];
    if (!holds[region] || (grid.is_cell(region) && region != cell)) continue;
    bool enclosed = false;
    for (std::size_t k = 0; k < tunnels.count(region) && !enclosed; ++k)
      enclosed = TreeCheck(scene, block, 0, tunnels.tunnel(region, k).sections).is_enclosed(segments);
    if (!enclosed) return false;
  }
  return true;
}

}  // namespace

PathLayout layout_of(const Replayer& replayer) {
  return {replayer.state().scene().light_order.size(), replayer.image().view.shadow_bits};
}

ImageRegions fresh_regions(const Replayer& replayer) {
  const PathClasses classes = classes_of(replayer);
  const ClassOf class_of = [&](PathId path) { return classes.of(path); };
  const RayScene rays(replayer.state().scene());
  const ViewOptions& view = replayer.image().view;
  ImageRegions regions(replayer.regions().options());
  regions.build_groups(replayer.image(), class_of);
  regions.build_tunnels(replayer.image(), {rays, nullptr, view.max_depth, view.shadow_bits}, class_of);
  return regions;
}

std::size_t stale_tiles(const Replayer& replayer) {
  const ImageRegions fresh = fresh_regions(replayer);
  const ImageRegions& kept = replayer.regions();
  std::size_t stale = kept.has_tunnels() && !(fresh.image_tunnels() == kept.image_tunnels()) ? 1 : 0;
  stale += fresh.has_groups() && !(fresh.image_groups() == kept.image_groups()) ? 1 : 0;
  for (std::size_t tile = 0; tile < replayer.image().trees.size(); ++tile) {
    const bool same_groups = !fresh.has_groups() || fresh.groups(tile) == kept.groups(tile);
    const bool is_here = kept.has_tunnels() && !kept.tunnels(tile).empty();  // or stored, or missing
    const bool same_tunnels = !is_here || fresh.tunnels(tile) == kept.tunnels(tile);
    stale += same_groups && same_tunnels ? 0 : 1;
  }
  return stale;
}

std::size_t segments_outside(const Replayer& replayer, const ImageRegions& regions, std::size_t& segments) {
  const Image& image = replayer.image();
  const Scene& scene = replayer.state().scene();
  const RayScene rays(scene);
  const GrowScene grow{rays, nullptr, image.view.max_depth, image.view.shadow_bits};
  const PrimaryRays primaries(scene.camera, image.view);
  std::size_t outside = 0;
  for (std::size_t tile = 0; tile < image.trees.size(); ++tile) {
    const TileRect rect = tile_rect(tile, image.frame.width, image.frame.height);
    const TileTrees& trees = image.trees[tile];
    for (std::uint32_t sample = 0; sample < trees.paths.size(); ++sample) {
      GrowCounters counters;
      TreeBlock block;
      const StoredTree stored{PathCursor(image.paths.words(trees.paths[sample]), layout_of(replayer)),
                              trees.hits_of(sample)};
      expand_tree(grow, primaries.ray(rect, sample), sample, stored, block, counters);
      const TileTunnels& tunnels = regions.tunnels(tile);
      const std::uint32_t cell = tunnels.grid().cell_of(sample / image.view.samples, rect.x1 - rect.x0);
      if (!is_enclosed_everywhere(scene, block, tunnels, cell, segments)) ++outside;
    }
  }
  return outside;
}

}  // namespace relook
