#include "color/path/light_terms.h"

#include <algorithm>
#include <cmath>

#include "color/expression/field.h"
#include "physics/power_heuristic.h"
#include "trace/light/emission_source.h"
#include "trace/light/light_sample.h"

namespace relook {
namespace {

/// Lamps without a size are gathered as if no nearer than this behind a scattering, metres squared.
constexpr float kLeastDistance2 = 1e-4F;

/// What becomes of a ray that sets out along a segment.
enum class AlongSegment : std::uint8_t {
  arrives,
  turns,  // it is bent or blurred, or dimmed otherwise
  ends    // there are more surfaces with holes than rays go straight on through
};
AlongSegment ray_along(const ColorScene& scene, const RayNode& node, std::span<const FilterNode> filters) {
  std::uint32_t straight = straight_behind(node.ray.path);
  bool turns = false;
  for (const FilterNode& filter : filters) {
    const RayObject& object = scene.object(filter.object);
    if (object.optics.bent) return AlongSegment::turns;
    turns = turns || object.turns;
    if (passes_by_coverage(*object.material)) ++straight;
  }
  if (straight > kMostStraight) return AlongSegment::ends;
  return turns ? AlongSegment::turns : AlongSegment::arrives;
}

/// Of a lamp without a size: it reaches every lobe.
std::optional<LightTerm> lamp_term(const RayNode& node, const RayLight& ray_light, const Light& light) {
  LightTerm term;
  term.weights = {1, 1, 1, 1};
  float share = lamp_share(light, node.point.position) / sample_rate(ray_light, node);
  if (traits_of(light.kind).has_place) {
    const Direction way = ray_light.position - node.point.position;
    const float distance2 = std::fmax(way.dot(way), 1e-8F);
    term.way = way / std::sqrt(distance2);
    share = share / (node.ray.path.from.is_none() ? distance2 : std::fmax(distance2, kLeastDistance2));
  } else {
    term.way = -ray_light.direction;
  }
  if (!(share > 0)) return std::nullopt;
  term.radiance = {share, share, share};
  return term;
}

}  // namespace

float lamp_share(const Light& light, const Point& at) {
  const LightTraits& traits = traits_of(light.kind);
  if (!traits.has_place || traits.has_size) return 1;
  const Direction way = light.position - at;
  const float distance = std::sqrt(std::fmax(way.dot(way), 1e-8F));
  const float reach = distance * field_value(light, LightField::inverse_range);
  float share = std::fmax(1.0F - reach * reach * (reach * reach), 0.0F);
  if (!traits.has_cone) return share;
  const Direction beside = way / distance + light.direction;
  const float versine = beside.dot(beside) * 0.5F;
  const float inwards = field_value(light, LightField::outer_versine) - versine;
  const float t = std::fmin(std::fmax(inwards * field_value(light, LightField::inverse_cone_width), 0.0F), 1.0F);
  return share * (t * t);
}

std::optional<LightTerm> light_term(const ColorScene& scene, const TreeBlock& block, std::uint32_t index,
                                    std::uint32_t place) {
  const RayNode& node = block.nodes[index];
  const LightLink& link = block.lights[node.first_light + place];
  const VertexLobes* lobes = node.lobes != kNoNode ? &block.lobes[node.lobes] : nullptr;
  const LightSample* sample = link.sample != kNoNode ? &block.samples[link.sample] : nullptr;
  auto term =
      light_term(scene, {node, lobes, std::span(block.filters).subspan(link.first, link.filters), sample}, place);
  if (term) term->node = index;
  return term;
}

std::optional<LightTerm> light_term(const ColorScene& scene, const LitHit& hit, std::uint32_t place) {
  const RayNode& node = hit.node;
  const RayLight& ray_light = scene.light(place);
  const Light& light = scene.scene().light(scene.light_order()[place]);
  if (light.excludes(node.object)) return std::nullopt;
  std::optional<LightTerm> term;
  if (!ray_light.is_soft()) {
    term = lamp_term(node, ray_light, light);
  } else if (hit.lobes != nullptr) {
    const auto sample = hit.sample != nullptr ? *hit.sample : sample_light(ray_light, node);
    if (!sample) return std::nullopt;
    term.emplace();
    term->way = sample->way;
    term->radiance = radiance_of(ray_light, *sample) * lamp_share(light, node.point.position);
    const VertexLobes& lobes = *hit.lobes;
    const AlongSegment along = ray_along(scene, node, hit.filters);
    // No ray of a reflecting lobe leads below the triangle; samples may, where the smooth surface is lit.
    const bool is_above = sample->way.dot(node.point.geometric) > 0;
    constexpr std::array kLobes{Lobe::diffuse, Lobe::specular, Lobe::coat, Lobe::transmission};
    for (std::size_t k = 0; k < kLobes.size(); ++k) {
      const bool is_reached = is_above != (kLobes[k] == Lobe::transmission);
      const float other =
          is_reached && along != AlongSegment::ends ? lobes.density(kLobes[k], sample->way) : 0.0F;
      // Where rays are turned either the samples or the rays bring the light, as the lobe is wide or narrow.
      if (along == AlongSegment::turns)
        term->weights[k] = lobes.is_wide(kLobes[k]) || !is_reached ? 1 / sample->density : 0.0F;
      else
        term->weights[k] = weight_of(sample->density, other) / sample->density;
    }
  }
  if (!term) return std::nullopt;
  // Light from behind the smooth surface is let through, other light reflected.
  if (node.has_back && !(term->way.dot(node.point.shading) > 0))
    term->weights = {0, 0, 0, term->weights[3]};
  else
    term->weights[3] = 0;
  term->light = place;
  return term;
}

float met_weight(const RayNode& node, const RayLight& light, float density) {
  const PathState& path = node.ray.path;
  if (!(path.density > 0) || path.is_alone) return 1;
  return weight_of(path.density, density * (path.is_first ? 1.0F : light.rate));
}

bool may_meet(const RayNode& node, const RayLight& ray_light, const Light& light) {
  const PathState& path = node.ray.path;
  const bool has_samples = !ray_light.emission || !ray_light.emission->empty();
  if (path.is_shut && has_samples) return false;
  if (path.is_eye) return light.visible || !traits_of(light.kind).in_document;
  return path.from.is_none() || !light.excludes(path.from);
}

std::optional<float> crossed(const RayNode& node, const RayLight& ray_light, const Light& light) {
  const SpawnedRay& ray = node.ray;
  const auto distance = cross(*ray_light.shape, ray.origin, ray.direction);
  if (!distance) return std::nullopt;
  const float first = std::fmax(ray.travelled, ray.start);
  const float last = node.object.is_none() ? ray.end : node.length;
  const bool is_in_sky = *distance == std::numeric_limits<float>::infinity();
  if (is_in_sky ? !node.object.is_none() : !(*distance > first && *distance <= last)) return std::nullopt;
  const float share = lamp_share(light, ray.origin);
  const float weight = met_weight(node, ray_light, density(*ray_light.shape, ray.origin, ray.direction));
  return ray_light.shape_radiance() * share * weight;
}

}  // namespace relook
