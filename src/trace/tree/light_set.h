// Sets of lights by their place in the light order, a bit each: how many lights there are is not limited, so that all
// from the last bit's on share it. Sets err to more.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

namespace relook {

template <class Word>
class LightBits {
 public:
  constexpr LightBits() = default;
  [[nodiscard]] static constexpr LightBits all() { return LightBits(std::numeric_limits<Word>::max()); }

  [[nodiscard]] constexpr bool has(std::size_t light) const { return (bits_ & bit(light)) != 0; }
  constexpr void add(std::size_t light) { bits_ |= bit(light); }
  [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }

  constexpr LightBits& operator|=(LightBits other) {
    bits_ |= other.bits_;
    return *this;
  }
  friend constexpr LightBits operator|(LightBits a, LightBits b) { return a |= b; }
  friend constexpr auto operator<=>(LightBits, LightBits) = default;

 private:
  static constexpr std::size_t kLast = std::numeric_limits<Word>::digits - 1;
  [[nodiscard]] static constexpr Word bit(std::size_t light) { return Word{1} << (light < kLast ? light : kLast); }
  constexpr explicit LightBits(Word bits) : bits_(bits) {}
  Word bits_ = 0;
};

using LightSet = LightBits<std::uint32_t>;  // on disk, in tunnels (cache/FORMAT.md)
using WideLightSet = LightBits<std::uint64_t>;
static_assert(sizeof(LightSet) == 4 && sizeof(WideLightSet) == 8);

}  // namespace relook
