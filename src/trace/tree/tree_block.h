// Ray trees in flight: the nodes of some samples with everything that follows from their hits, ready to be shaded,
// packed into the compact form, or both. Nodes of a sample stand together in preorder, children in the order of Branch.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "scene/coverage_bucket.h"
#include "trace/light/light_sample.h"
#include "trace/surface.h"
#include "trace/tree/lobes.h"
#include "trace/tree/path_words.h"
#include "trace/tree/spawned_ray.h"

namespace relook {

inline constexpr std::uint32_t kNoNode = 0xFFFFFFFFU;

/// What becomes of a ray where a surface covers a part of what it meets. From the eye both: the surface is seen, and a
/// straight ray beside it sees what is behind. Behind a scattering the ray either stops, and the straight ray is not
/// there, or passes, and the surface is not.
struct CoverageChoice {
  enum class Way : std::uint8_t { both, stops, passes };
  Way way = Way::both;
  CoverageBucket bucket = CoverageBucket::half;

  [[nodiscard]] bool sees_surface() const { return way != Way::passes; }
  [[nodiscard]] bool goes_on() const { return way != Way::stops; }
  /// One over the share of the chosen way.
  [[nodiscard]] float scale() const {
    if (way == Way::both) return 1;
    const float passing = passing_share(bucket);
    return 1 / (way == Way::passes ? passing : 1 - passing);
  }
};

/// A node of a ray tree: a hit, or the environment when the ray left the scene.
struct RayNode {
  // A constructor, so that a new node is not cleared byte by byte first.
  RayNode(std::uint32_t above, std::uint32_t of_sample, const SpawnedRay& way)
      : parent(above), sample(of_sample), ray(way) {}

  std::uint32_t parent;
  std::array<std::uint32_t, kBranches> child{kNoNode, kNoNode, kNoNode, kNoNode,
                                             kNoNode, kNoNode, kNoNode, kNoNode};
  std::uint32_t sample;  // within the tile
  ObjectId object;       // none: miss
  Hit hit;
  SpawnedRay ray;                                     // that led here
  BranchSet cut;                                      // branches that the Fresnel cut-off removed
  CoverageChoice coverage;                            // of the path integrator
  bool has_back = false;                              // light from behind reaches it, too: it is thin and blurs
  float t = std::numeric_limits<float>::quiet_NaN();  // of the meeting; NaN: not known
  float length = 0;                                   // metres from the ray's origin
  float footprint = 0;                                // metres: ray-cone width at the hit over the cosine of incidence
  SurfacePoint point;
  std::uint32_t first_light = 0;  // into TreeBlock::lights, one entry per light of the light order
  std::uint32_t lobes = kNoNode;  // into TreeBlock::lobes; kNoNode: it has none
};

[[nodiscard]] inline BranchSet children_of(const RayNode& node) {
  BranchSet children;
  for (std::size_t b = 0; b < kBranches; ++b)
    if (node.child[b] != kNoNode) children.add(static_cast<Branch>(b));
  return children;
}

/// What stands between a node and one light.
struct LightLink {
  ShadowState state = ShadowState::facing_away;
  std::uint32_t first = 0;    // filtered: into TreeBlock::filters; blocked and counted: into TreeBlock::blocker_words
  std::uint32_t filters = 0;  // how many, of a filtered light
  std::uint32_t sample = kNoNode;  // into TreeBlock::samples, of a light with a size; kNoNode: not kept
};

/// A transparent surface on a shadow segment.
struct FilterNode {
  ObjectId object;
  Hit hit;
  SurfacePoint point;
  float footprint = 0;
  float length_inside = 0;  // metres of the segment inside the volume that it leaves here, 0 otherwise
  float cosine = 0;         // of the segment with the geometric normal
};

/// Where a shadow segment runs: as ShadowSegment.
struct SegmentLine {
  Point origin{0, 0, 0};
  Direction direction{0, 0, 1};
  float t_max = 0;
};

struct TreeBlock {
  std::vector<RayNode> nodes;
  std::vector<LightLink> lights;
  std::vector<FilterNode> filters;
  std::vector<VertexLobes> lobes;            // of the path integrator
  std::vector<LightSample> samples;          // of it, of lights that reach a hit
  std::vector<std::uint32_t> blocker_words;  // entries of blocked lights, as in paths
  std::vector<SegmentLine> lines;            // of `lights`, where their segments have been worked out
  bool keeps_lines = false;                  // else there are none

  /// The entry of a blocked light. Requires: shadows are counted.
  [[nodiscard]] std::span<const std::uint32_t> blocker_entry(const LightLink& link) const;

  /// A state to go back to: what was appended since is dropped.
  struct Mark {
    std::size_t nodes = 0, lights = 0, filters = 0, lobes = 0, samples = 0, blocker_words = 0;
  };
  [[nodiscard]] Mark mark() const {
    return {nodes.size(), lights.size(), filters.size(), lobes.size(), samples.size(), blocker_words.size()};
  }
  void rewind(const Mark& mark) {
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(mark.nodes), nodes.end());
    resize_lights(mark.lights);
    filters.resize(mark.filters);
    lobes.resize(mark.lobes);
    samples.resize(mark.samples);
    blocker_words.resize(mark.blocker_words);
  }
  void clear() { rewind({}); }
  void resize_lights(std::size_t count) {
    lights.resize(count);
    if (keeps_lines) lines.resize(count);
  }
};

/// Fills length, footprint, point and coverage of a node whose ray, object and hit are set. `coverage`: its choice, or
/// null: it is found.
void complete(RayNode& node, const RayObject& object, const CoverageChoice* coverage = nullptr);

/// What a texture slot of the object holds at a completed node, by the ray's footprint; white if it holds nothing.
[[nodiscard]] Rgba texel_at(const RayNode& node, const RayObject& object, const TextureSlot& slot);

/// The choice at a completed node, with this value of its object. It follows from a bucket of the coverage that colours
/// are weighed by, at the ray's footprint.
[[nodiscard]] CoverageChoice coverage_choice(const RayNode& node, const RayObject& object);

/// A hit's distance is known up to rounding, the more so the flatter the ray meets its triangle: the half width of the
/// band, in metres along the ray, within which only the whole scene decides what is nearer.
[[nodiscard]] float distance_slack(const RayNode& node, const RayObject& object);

}  // namespace relook
