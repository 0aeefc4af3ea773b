#include "edit/growth.h"

#include <string>

namespace relook {
namespace {

void add_extent(const Json& value, const Extent& most, Extent& sum) {
  ++sum.values;
  if (value.is_string()) sum.bytes += value.get_ref<const std::string&>().size();
  if (!value.is_structured() || sum.exceeds(most)) return;
  if (value.is_array()) {
    for (const Json& item : value) {
      add_extent(item, most, sum);
      if (sum.exceeds(most)) return;
    }
    return;
  }
  for (const auto& [key, member] : value.get_ref<const Json::object_t&>()) {
    sum.bytes += key.size();
    add_extent(member, most, sum);
    if (sum.exceeds(most)) return;
  }
}

/// Whether `value` has at most `levels` levels, itself included. No deeper than that is looked.
bool fits_within(const Json& value, std::size_t levels) {
  if (levels == 0) return false;
  if (!value.is_structured()) return true;
  for (const Json& item : value)
    if (!fits_within(item, levels - 1)) return false;
  return true;
}

}  // namespace

Extent extent_of(const Json& value, const Extent& most) {
  Extent sum;
  add_extent(value, most, sum);
  return sum;
}

void require_shallow(const Json& value, std::size_t level, std::string_view file, std::string_view where) {
  if (level < kDeepestLook && fits_within(value, kDeepestLook - level)) return;
  throw InputError(file, where, "this would nest values deeper than " + std::to_string(kDeepestLook) + " levels");
}

}  // namespace relook
