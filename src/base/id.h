// Strong indices: an ObjectId cannot be used where a MaterialId is wanted, and "none" is a value of the type, never -1.
#pragma once
#include <compare>
#include <cstdint>
#include <functional>
#include <limits>

namespace relook {

template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t index) : index_(index) {}
  static constexpr Id none() { return Id(); }
  [[nodiscard]] constexpr bool is_none() const { return index_ == kNone; }
  [[nodiscard]] constexpr std::uint32_t index() const { return index_; }
  friend constexpr auto operator<=>(Id, Id) = default;

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t index_ = kNone;
};

using ObjectId = Id<struct ObjectTag>;
using MeshId = Id<struct MeshTag>;
using MaterialId = Id<struct MaterialTag>;
using LightId = Id<struct LightTag>;
using PathId = Id<struct PathTag>;

}  // namespace relook

template <class Tag>
struct std::hash<relook::Id<Tag>> {
  std::size_t operator()(relook::Id<Tag> id) const { return std::hash<std::uint32_t>()(id.index()); }
};
