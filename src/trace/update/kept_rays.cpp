#include "trace/update/kept_rays.h"

#include <bit>

#include "trace/tree/spawn.h"

namespace relook {
namespace {

// Bits of KeptRay::flags_; the lowest five: straight rays so far.
constexpr std::uint16_t kStraightMask = 0x1F, kIsFirst = 0x20, kIsEye = 0x40, kGathers = 0x80, kIsShut = 0x100,
                        kIsWide = 0x200, kIsAlone = 0x400, kHasLamps = 0x800, kGoesOn = 0x1000, kLeavesBehind = 0x2000,
                        kFromParent = 0x4000;
static_assert(kMostStraight <= kStraightMask);

/// Widths that lobes set are powers of two from 2^-14 to 1: as 1 to 15. 0: it is the parent's.
std::uint8_t width_code(float width, float of_parent) {
  if (width == of_parent) return 0;
  const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(width) >> 23) - 127;
  return static_cast<std::uint8_t>(1 - exponent);
}
float width_of(std::uint8_t code, float of_parent) {
  return code == 0 ? of_parent : std::bit_cast<float>(static_cast<std::uint32_t>(1 - code + 127) << 23);
}

constexpr unsigned kFloorShift = 4, kWayShift = 4;
constexpr std::uint8_t kLowHalf = 0xF;

}  // namespace

KeptRay::KeptRay(const TreeBlock& block, const RayNode& node)
    : direction_(node.ray.direction), density_(node.ray.path.density) {
  const RayNode& parent = block.nodes[node.parent];
  const PathState& path = node.ray.path;
  const auto flag = [](bool is_set, std::uint16_t bit) { return is_set ? bit : std::uint16_t{0}; };
  flags_ = static_cast<std::uint16_t>(
      path.straight | flag(path.is_first, kIsFirst) | flag(path.is_eye, kIsEye) | flag(path.gathers, kGathers) |
      flag(path.is_shut, kIsShut) | flag(path.is_wide, kIsWide) | flag(path.is_alone, kIsAlone) |
      flag(path.has_lamps, kHasLamps) | flag(node.ray.goes_on(), kGoesOn) |
      flag(node.ray.origin != left_at(parent.point, 1.0F), kLeavesBehind) |
      flag(path.from == parent.object && path.from != parent.ray.path.from, kFromParent));
  widths_ = static_cast<std::uint8_t>(width_code(node.ray.cone_spread, parent.ray.cone_spread) |
                                      width_code(path.alpha_floor, parent.ray.path.alpha_floor) << kFloorShift);
  coverage_ = static_cast<std::uint8_t>(static_cast<unsigned>(node.coverage.bucket) |
                                        static_cast<unsigned>(node.coverage.way) << kWayShift);
}

SpawnedRay KeptRay::restored(const RayNode& parent, const RayObject& object, Branch branch) const {
  SpawnedRay ray;
  const SpawnedRay& before = parent.ray;
  if (has(kGoesOn)) {
    go_straight(parent, object, ray);
  } else {
    ray.origin = left_at(parent.point, has(kLeavesBehind) ? -1.0F : 1.0F);
    ray.direction = direction_;
    ray.cone_width = before.cone_width + before.cone_spread * parent.length;
  }
  ray.cone_spread = width_of(widths_ & kLowHalf, before.cone_spread);
  ray.branch = branch;
  ray.channel = channel_of(branch, before.channel);
  PathState& path = ray.path;
  path.key = before.path.key;
  path.history = child_history(before.path.history, static_cast<std::uint32_t>(branch));
  path.from = has(kFromParent) ? parent.object : before.path.from;
  path.density = density_;
  path.alpha_floor = width_of(static_cast<std::uint8_t>(widths_ >> kFloorShift), before.path.alpha_floor);
  path.straight = static_cast<std::uint8_t>(flags_ & kStraightMask);
  path.is_first = has(kIsFirst);
  path.is_eye = has(kIsEye);
  path.gathers = has(kGathers);
  path.is_shut = has(kIsShut);
  path.is_wide = has(kIsWide);
  path.is_alone = has(kIsAlone);
  path.has_lamps = has(kHasLamps);
  return ray;
}

CoverageChoice KeptRay::coverage() const {
  return {static_cast<CoverageChoice::Way>(coverage_ >> kWayShift), static_cast<CoverageBucket>(coverage_ & kLowHalf)};
}

std::size_t TileRays::bytes() const {
  return first.capacity() * sizeof(std::uint32_t) + rays.capacity() * sizeof(KeptRay) +
         weights.capacity() * sizeof(Color);
}

void TileRays::append(const TreeBlock& block, std::uint32_t root) {
  const std::uint32_t sample = block.nodes[root].sample;
  for (std::size_t i = root + std::size_t{1}; i < block.nodes.size() && block.nodes[i].sample == sample; ++i)
    rays.emplace_back(block, block.nodes[i]);
  first.push_back(hit_place(rays.size()));
}

void TileRays::append(const TileRays& other, std::size_t sample) {
  const bool with_weights = has_weights() && other.has_weights();
  const auto more = other.of(sample);
  if (with_weights) {
    const auto theirs = other.weights_of(sample);
    weights.insert(weights.end(), theirs.begin(), theirs.end());
  } else {
    weights.clear();
  }
  rays.insert(rays.end(), more.begin(), more.end());
  first.push_back(hit_place(rays.size()));
}

}  // namespace relook
