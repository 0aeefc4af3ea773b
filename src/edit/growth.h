// How far operations may make the look document grow: `copy` into itself would double depth or size each time. Counted
// before a value is copied; the price follows from the value. Used by Transaction.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "base/json.h"

namespace relook {

/// An amount of JSON.
struct Extent {
  std::uint64_t values = 0, bytes = 0;  // bytes: of strings and keys
  [[nodiscard]] constexpr bool exceeds(const Extent& most) const { return values > most.values || bytes > most.bytes; }
  constexpr Extent& operator+=(const Extent& other) {
    values += other.values;
    bytes += other.bytes;
    return *this;
  }
  constexpr Extent& operator-=(const Extent& other) {
    values -= other.values;
    bytes -= other.bytes;
    return *this;
  }
};

inline constexpr std::size_t kDeepestLook = 64;  // levels of the look document, as of any file that is parsed
/// What `copy` may make: in one entry of the document (a material, a node), and in all by one journal.
inline constexpr Extent kMostInEntry{100'000, 4U << 20U};
inline constexpr Extent kMostCopied{1'000'000, 32U << 20U};

/// What a copied node counts for beside its own values: it is named, compiled and drawn.
inline constexpr std::uint64_t kValuesOfCopiedNode = 100;

/// More than a whole journal may make or have: nothing after it is looked at.
struct JournalLimitError : InputError {
  using InputError::InputError;
};

/// Values and bytes of text, keys included. Counting ends soon after one of `most` is passed.
[[nodiscard]] Extent extent_of(const Json& value, const Extent& most);

/// Throws InputError{file, where} when `value`, set `level` levels below the root, would reach below the deepest level.
void require_shallow(const Json& value, std::size_t level, std::string_view file, std::string_view where);

}  // namespace relook
