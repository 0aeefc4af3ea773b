// Small readers for glTF's own habits: optional members, arrays of objects, indices into other arrays. Those over Json
// read what may be wrong, those over JsonView say where. Used in scene/gltf alone.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "base/json.h"

namespace relook {

/// The member, if it is there and an array; null otherwise. `Value`: Json or const Json.
template <class Value>
[[nodiscard]] Value* find_array(Value& owner, std::string_view key) {
  if (!owner.is_object()) return nullptr;
  const auto found = owner.find(key);
  return found == owner.end() || !found->is_array() ? nullptr : &*found;
}

/// The same; an empty one where there is none.
[[nodiscard]] inline const Json& array_or_empty(const Json& owner, std::string_view key) {
  static const Json empty = Json::array();
  const Json* found = find_array(owner, key);
  return found == nullptr ? empty : *found;
}

/// The member, if it is there. An error if `owner` is no object.
[[nodiscard]] inline std::optional<JsonView> member(const JsonView& owner, std::string_view key) {
  if (!owner.has(key)) return std::nullopt;
  return owner.at(key);
}

/// Length of an optional array.
[[nodiscard]] inline std::size_t array_size(const JsonView& owner, std::string_view key) {
  const auto array = member(owner, key);
  if (!array) return 0;
  array->require_array();
  return array->size();
}

/// Calls visit(entry, index) for the entries of an optional array.
template <class Visit>
void for_each(const JsonView& owner, std::string_view key, const Visit& visit) {
  const std::size_t count = array_size(owner, key);
  if (count == 0) return;
  const JsonView array = owner.at(key);
  for (std::size_t i = 0; i < count; ++i) visit(array.at(i), i);
}

/// The same for an array of objects. A name, where there is one, is text.
template <class Visit>
void for_each_object(const JsonView& owner, std::string_view key, const Visit& visit) {
  for_each(owner, key, [&](const JsonView& entry, std::size_t i) {
    entry.require_object();
    if (entry.has("name")) (void)entry.at("name").text();
    visit(entry, i);
  });
}

/// An index into an array of `count` things of a kind ("material").
[[nodiscard]] inline std::size_t reference(const JsonView& index, std::size_t count, std::string_view kind) {
  const std::int64_t value = index.integer(INT64_MIN, INT64_MAX);
  if (value < 0 || static_cast<std::uint64_t>(value) >= count)
    index.fail("there is no " + std::string(kind) + " " + std::to_string(value) + "; the file has " +
               std::to_string(count));
  return static_cast<std::size_t>(value);
}

[[nodiscard]] inline std::optional<std::size_t> optional_reference(const JsonView& owner, std::string_view key,
                                                                   std::size_t count, std::string_view kind) {
  const auto index = member(owner, key);
  if (!index) return std::nullopt;
  return reference(*index, count, kind);
}

/// extensions.<name> of an object, itself an object.
[[nodiscard]] inline std::optional<JsonView> extension(const JsonView& owner, std::string_view name) {
  const auto extensions = member(owner, "extensions");
  if (!extensions) return std::nullopt;
  auto found = member(*extensions, name);
  if (found) found->require_object();
  return found;
}

}  // namespace relook
