#include "trace/update/kept_vertices.h"

#include <algorithm>
#include <cstring>

namespace relook {
namespace {

template <class T>
bool has_same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}
bool is_same_lobe(const GlossyLobe& a, const GlossyLobe& b) {
  return has_same_bits(a.alpha_x, b.alpha_x) && has_same_bits(a.alpha_y, b.alpha_y);
}
GlossyLobe lobe_of(AlphaBucket bucket) { return {bucket.representative(), bucket.representative()}; }

}  // namespace

KeptLobes::KeptLobes(const VertexLobes& lobes, const Direction& view)
    : normal_(lobes.base.z),
      view_(view),
      shares_{lobes.shares.diffuse, lobes.shares.specular, lobes.shares.coat, lobes.shares.transmission},
      specular_(lobes.specular_bucket),
      coat_(lobes.coat_bucket),
      transmission_(lobes.transmission_bucket),
      has_sheen_(lobes.diffuse.has_sheen) {
  if (has_coat()) coat_normal_ = lobes.coat_base.z;
}

bool KeptLobes::holds(const VertexLobes& lobes) const {
  if (lobes.shininess >= 0 || lobes.eta != 0 || lobes.is_channel_chosen) return false;
  const VertexLobes kept = restored();
  const LobeShares& shares = lobes.shares;
  return has_same_bits(kept.base, lobes.base) && has_same_bits(kept.view, lobes.view) &&
         (!has_coat() || (has_same_bits(kept.coat_base, lobes.coat_base) &&
                          has_same_bits(kept.coat_view, lobes.coat_view) && is_same_lobe(kept.coat, lobes.coat))) &&
         (!(shares.specular > 0) || is_same_lobe(kept.specular, lobes.specular)) &&
         (!(shares.transmission > 0) || is_same_lobe(kept.transmission, lobes.transmission));
}

VertexLobes KeptLobes::restored() const {
  VertexLobes lobes;
  lobes.shares = {shares_[0], shares_[1], shares_[2], shares_[3]};
  lobes.base = basis_about(normal_);
  lobes.view = lobes.base.to_local(view_);
  lobes.diffuse.has_sheen = has_sheen_;
  lobes.specular_bucket = specular_;
  lobes.coat_bucket = coat_;
  lobes.transmission_bucket = transmission_;
  lobes.specular = lobe_of(specular_);
  lobes.transmission = lobe_of(transmission_);
  if (!has_coat()) return lobes;
  lobes.coat_base = basis_about(coat_normal_);
  lobes.coat_view = lobes.coat_base.to_local(view_);
  lobes.coat = lobe_of(coat_);
  return lobes;
}

LitVertex::LitVertex(const TreeBlock& block, const RayNode& node)
    : position(node.point.position),
      geometric(node.point.geometric),
      shading(node.point.shading),
      lift(node.point.lift),
      offset(node.point.offset),
      footprint(node.footprint),
      key(node.ray.path.key),
      history{static_cast<std::uint32_t>(node.ray.path.history),
              static_cast<std::uint32_t>(node.ray.path.history >> 32U)},
      object(node.object) {
  const PathState& path = node.ray.path;
  const auto flag = [](bool is_set, std::uint16_t bit) { return is_set ? bit : std::uint16_t{0}; };
  flags = static_cast<std::uint16_t>(path.straight | flag(node.has_back, kHasBack) | flag(path.is_wide, kIsWide) |
                                     flag(path.is_shut, kIsShut) | flag(path.has_lamps, kHasLamps) |
                                     flag(!path.from.is_none(), kIsBehind) | flag(node.lobes != kNoNode, kHasLobes));
  if (node.lobes != kNoNode) lobes = KeptLobes(block.lobes[node.lobes], -node.ray.direction);
}
static_assert(kMostStraight <= LitVertex::kStraightMask);

void LitVertex::restore(RayNode& node) const {
  constexpr ObjectId kSome(0);  // that there is one is all that is read
  node.object = object;
  node.has_back = (flags & kHasBack) != 0;
  node.footprint = footprint;
  node.point.position = position;
  node.point.geometric = geometric;
  node.point.shading = shading;
  node.point.lift = lift;
  node.point.offset = offset;
  PathState& path = node.ray.path;
  path.key = key;
  path.history = std::uint64_t{history[1]} << 32U | history[0];
  path.from = (flags & kIsBehind) != 0 ? kSome : ObjectId::none();
  path.straight = static_cast<std::uint8_t>(flags & kStraightMask);
  path.is_wide = (flags & kIsWide) != 0;
  path.is_shut = (flags & kIsShut) != 0;
  path.has_lamps = (flags & kHasLamps) != 0;
}

MetRay::MetRay(const RayNode& node)
    : origin(node.ray.origin),
      direction(node.ray.direction),
      first(std::max(node.ray.travelled, node.ray.start)),
      last(node.object.is_none() ? node.ray.end : node.length),
      density(node.ray.path.density),
      from(node.ray.path.from) {
  const PathState& path = node.ray.path;
  flags = static_cast<std::uint8_t>((path.is_eye ? kIsEye : 0) | (path.is_shut ? kIsShut : 0) |
                                    (path.is_alone ? kIsAlone : 0) | (path.is_first ? kIsFirst : 0));
}

void MetRay::restore(RayNode& node) const {
  node.ray.origin = origin;
  node.ray.direction = direction;
  node.ray.travelled = node.ray.start = first;
  node.ray.end = node.length = last;
  PathState& path = node.ray.path;
  path.density = density;
  path.from = from;
  path.is_eye = (flags & kIsEye) != 0;
  path.is_shut = (flags & kIsShut) != 0;
  path.is_alone = (flags & kIsAlone) != 0;
  path.is_first = (flags & kIsFirst) != 0;
}

}  // namespace relook
