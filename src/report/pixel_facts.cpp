#include "report/pixel_facts.h"

#include <algorithm>
#include <array>
#include <functional>
#include <ranges>

namespace relook {
namespace {

constexpr std::array<const char*, kBranches + 1> kBranchNames{
    "reflection",         "coat",    "refraction", "transparency", "refraction of red", "refraction of green",
    "refraction of blue", "diffuse", "primary"};
constexpr std::size_t kMostPaths = 8;  // that are printed

std::string material_name(const Scene& scene, ObjectId id) {
  const std::string& name = scene.material(scene.object(id).material).name;
  return name.empty() ? "(default)" : name;
}

class Collector {
 public:
  Collector(const Scene& scene, const RayScene& rays, const TreeBlock& block)
      : scene_(scene), rays_(rays), block_(block), routes_(block.nodes.size()), depths_(block.nodes.size()) {}

  PixelFacts run(const std::vector<std::uint32_t>& roots) {
    std::vector<CountedPath> paths;
    for (std::size_t sample = 0; sample < roots.size(); ++sample) {
      const std::size_t end = sample + 1 < roots.size() ? roots[sample + 1] : block_.nodes.size();
      std::vector<std::string> lines;
      for (std::size_t node = roots[sample]; node < end; ++node)
        lines.push_back(add_node(node, static_cast<std::uint32_t>(sample)));
      const auto known = std::ranges::find(paths, lines, &CountedPath::first);
      if (known != paths.end())
        ++known->second;
      else
        paths.emplace_back(std::move(lines), 1);
    }
    list(paths, roots.size());
    return std::move(facts_);
  }

 private:
  using CountedPath = std::pair<std::vector<std::string>, std::size_t>;  // with the number of samples

  void list(std::vector<CountedPath>& paths, std::size_t samples) {
    if (paths.size() > kMostPaths) std::ranges::stable_sort(paths, std::greater(), &CountedPath::second);
    std::size_t listed = 0;
    for (CountedPath& path : paths | std::views::take(kMostPaths)) {
      if (paths.size() > 1)
        facts_.lines.push_back(std::to_string(path.second) + " of " + std::to_string(samples) + " samples");
      for (std::string& line : path.first) facts_.lines.push_back(std::move(line));
      listed += path.second;
    }
    if (listed < samples)
      facts_.lines.push_back(std::to_string(samples - listed) + " samples on " +
                             std::to_string(paths.size() - kMostPaths) + " other paths");
  }

  /// Returns the node's line.
  std::string add_node(std::size_t index, std::uint32_t sample) {
    const RayNode& node = block_.nodes[index];
    const bool is_root = node.parent == kNoNode, is_miss = node.object.is_none();
    const std::string name = is_miss ? "environment" : object_name(scene_.object(node.object));
    const char* branch = kBranchNames[static_cast<std::size_t>(node.ray.branch)];
    Route& route = routes_[index];
    route = is_root ? name : routes_[node.parent] + " > " + branch + " > " + name;
    depths_[index] = is_root ? 0 : depths_[node.parent] + 1;
    std::string line(2 * depths_[index], ' ');
    if (!is_root) line += std::string(branch) + ": ";
    line += name;
    if (is_miss) {
      if (facts_.environment.empty()) facts_.environment = route;
      return line;
    }
    line += " [" + material_name(scene_, node.object) + "]";
    if (facts_.hits.try_emplace(node.object, route).second)
      facts_.materials[scene_.object(node.object).material].push_back(route);
    std::string lights;
    for (std::size_t place = 0; place < scene_.light_order.size(); ++place) {
      const std::string light = add_light(node, block_.lights[node.first_light + place], place, route, sample);
      if (!light.empty()) lights += (lights.empty() ? "; " : ", ") + light;
    }
    return line + lights;
  }

  /// Returns "Lamp blocked"; "" where the light is below the surface.
  std::string add_light(const RayNode& node, const LightLink& link, std::size_t place, const Route& route,
                        std::uint32_t sample) {
    const LightId id = scene_.light_order[place];
    const Light& light = scene_.light(id);
    SegmentFacts& segment = facts_.segments[{sample, route, id}];
    const std::string name = light_name(light);
    segment = {"light " + name + " on " + route, link.state, {}, shadow_segment(node, rays_.light(place))};
    std::string through;
    for (std::uint32_t i = 0; link.state == ShadowState::filtered && i < link.filters; ++i) {
      const ObjectId filter = block_.filters[link.first + i].object;
      segment.filters.push_back(filter.index());
      const std::string filter_name = object_name(scene_.object(filter));
      through += (through.empty() ? "" : ", ") + filter_name;
      const std::string use = "light " + name + " through " + filter_name + " on " + route;
      if (facts_.filters.try_emplace(filter, use).second)
        facts_.materials[scene_.object(filter).material].push_back(use);
    }
    switch (link.state) {
      case ShadowState::facing_away:
        return "";
      case ShadowState::blocked:
        return name + " blocked";
      case ShadowState::open:
      case ShadowState::filtered:
        break;
    }
    facts_.lights.try_emplace(id, route);
    return name + (through.empty() ? "" : " through " + through);
  }

  const Scene& scene_;
  const RayScene& rays_;
  const TreeBlock& block_;
  std::vector<Route> routes_;
  std::vector<std::size_t> depths_;
  PixelFacts facts_;
};

}  // namespace

PixelFacts pixel_facts(const Scene& scene, const RayScene& rays, const TreeBlock& block,
                       const std::vector<std::uint32_t>& roots) {
  return Collector(scene, rays, block).run(roots);
}

std::string light_name(const Light& light) {
  if (light.kind == LightKind::suns) return "suns";
  return light.kind == LightKind::emission ? "emission of " + light.light : light.light;
}

std::string object_name(const Object& object) {
  std::string name = object.node;
  if (object.primitive > 0) name += " primitive " + std::to_string(object.primitive);
  if (object.instance > 0) name += " instance " + std::to_string(object.instance);
  return name;
}

}  // namespace relook
