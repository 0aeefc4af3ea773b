// How rays leave what they meet: the branches of a ray tree, sets of them, and the colour channels that they part into.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace relook {

/// How a ray left its parent. The numbers are on disk, but for that of the primary ray, and never change. The
/// three `refracted_` ones stand for `refraction` where colours part (KHR_materials_dispersion). `diffuse` is a
/// direction of the path integrator's diffuse lobe; its reflection and coat are directions of glossy lobes, its
/// refractions of lobes, too, where a surface blurs.
enum class Branch : std::uint8_t {
  reflection = 0,
  coat = 1,
  refraction = 2,
  transparency = 3,
  refracted_red = 4,
  refracted_green = 5,
  refracted_blue = 6,
  diffuse = 7,
  primary = 8
};
inline constexpr std::size_t kBranches = 8;  // those that a hit can spawn

/// A set of branches that a hit can spawn.
class BranchSet {
 public:
  constexpr BranchSet() = default;
  [[nodiscard]] static constexpr BranchSet of_bits(std::uint8_t bits) { return BranchSet(bits); }
  [[nodiscard]] static constexpr BranchSet all() { return BranchSet(0xFF); }
  /// The refractions that stand apart where colours part.
  [[nodiscard]] static constexpr BranchSet parted() { return BranchSet(0x70); }

  [[nodiscard]] constexpr bool has(Branch branch) const { return (bits_ >> static_cast<unsigned>(branch) & 1U) != 0; }
  constexpr void add(Branch branch) { bits_ = static_cast<std::uint8_t>(bits_ | 1U << static_cast<unsigned>(branch)); }
  [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }
  [[nodiscard]] constexpr unsigned size() const { return static_cast<unsigned>(std::popcount(bits_)); }
  /// Bit b: the branch of number b.
  [[nodiscard]] constexpr std::uint8_t bits() const { return bits_; }

  friend constexpr BranchSet operator&(BranchSet a, BranchSet b) {
    return BranchSet(static_cast<std::uint8_t>(a.bits_ & b.bits_));
  }
  friend constexpr auto operator<=>(BranchSet, BranchSet) = default;

 private:
  constexpr explicit BranchSet(std::uint8_t bits) : bits_(bits) {}
  std::uint8_t bits_ = 0;
};
static_assert(sizeof(BranchSet) == 1 && BranchSet::all().size() == kBranches);

/// The branches of a set, in their order.
[[nodiscard]] inline std::vector<Branch> branches_of(BranchSet set) {
  std::vector<Branch> branches;
  for (std::size_t b = 0; b < kBranches; ++b)
    if (set.has(static_cast<Branch>(b))) branches.push_back(static_cast<Branch>(b));
  return branches;
}

/// What of the light that comes back along a ray counts: all of it, or one channel.
enum class Channel : std::uint8_t { all, red, green, blue };
inline constexpr std::array<Channel, 3> kChannels{Channel::red, Channel::green, Channel::blue};
/// How a ray of this channel alone is refracted where colours part.
[[nodiscard]] constexpr Branch refracted(Channel channel) {
  constexpr std::array<Branch, 4> kBranchOf{Branch::refraction, Branch::refracted_red, Branch::refracted_green,
                                            Branch::refracted_blue};
  return kBranchOf[static_cast<std::size_t>(channel)];
}
/// The channel of a ray whose parent's is `parent`.
[[nodiscard]] constexpr Channel channel_of(Branch branch, Channel parent) {
  for (const Channel channel : kChannels)
    if (branch == refracted(channel)) return channel;
  return parent;
}

}  // namespace relook
