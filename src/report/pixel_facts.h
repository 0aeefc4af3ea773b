// What one pixel's ray trees depend on, by name: the objects they meet, the lights that reach these, and the surfaces
// in between. Called by PixelHistory before and after an edit.
#pragma once
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "trace/ray_scene.h"
#include "trace/shadow/shadow_segment.h"
#include "trace/tree/tree_block.h"

namespace relook {

/// "GlassBall > refraction > Floor": how a ray gets to a node.
using Route = std::string;

/// The shadow segment from a node to a light.
struct SegmentFacts {
  std::string name;  // "light Lamp on Floor"
  ShadowState state = ShadowState::facing_away;
  std::vector<std::uint32_t> filters;  // objects on it, from the node to the light
  ShadowSegment segment;
};

struct PixelFacts {
  std::map<ObjectId, Route> hits;                            // the first route to each
  std::map<ObjectId, std::string> filters;                   // "light Lamp through Pane on Floor"
  std::map<MaterialId, std::vector<std::string>> materials;  // of both
  std::map<LightId, Route> lights;                           // that reach a node, and where first
  Route environment;                                         // "" : no ray leaves the scene
  /// By sample, route and light.
  std::map<std::tuple<std::uint32_t, Route, LightId>, SegmentFacts> segments;
  std::vector<std::string> lines;  // the commonest ray paths, a line a node, indented; equal paths stand once
};

/// `block`: complete trees that hold in `scene`, one a sample of the pixel; `roots`: their first nodes; `rays`: of the
/// scene.
[[nodiscard]] PixelFacts pixel_facts(const Scene& scene, const RayScene& rays, const TreeBlock& block,
                                     const std::vector<std::uint32_t>& roots);

/// "Lamp", "suns", "emission of Neon".
[[nodiscard]] std::string light_name(const Light& light);

/// "Chair", "Chair primitive 2".
[[nodiscard]] std::string object_name(const Object& object);

}  // namespace relook
