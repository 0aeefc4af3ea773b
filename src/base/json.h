// Strict JSON: depth, number of values and duplicate keys are checked as the text is read, before a value is kept, and
// values are read through one view that checks type, range and finiteness and names the place in every error.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"

namespace relook {

using Json = nlohmann::json;

/// Parses UTF-8 JSON. Refuses nesting deeper than 64, more than 16 million values, duplicate keys, numbers that are not
/// finite doubles, and trailing text. Throws InputError{file, "byte N" or pointer, ...}.
[[nodiscard]] Json parse_json(std::string_view text, std::string_view file);

/// JSON as text, in one line or with an indent; bytes that are not UTF-8, as in the names of files, are replaced.
[[nodiscard]] std::string json_text(const Json& value, int indent = -1);

/// One token of a JSON pointer, escaped ("~" to "~0", "/" to "~1").
[[nodiscard]] std::string escape_token(std::string_view token);
/// The unescaped tokens of a JSON pointer. Throws InputError when it does not start with "/" or has a bad escape.
[[nodiscard]] std::vector<std::string> split_pointer(std::string_view pointer, std::string_view file,
                                                     std::string_view where);

/// A value and its place. Every reading function throws InputError{file, pointer, ...} when the value does not fit.
class JsonView {
 public:
  JsonView(const Json& value, std::string_view file, std::string pointer = "")
      : value_(&value), file_(file), pointer_(std::move(pointer)) {}

  [[nodiscard]] const Json& value() const { return *value_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] std::string_view file() const { return file_; }

  [[nodiscard]] bool has(std::string_view key) const;  // requires an object
  /// The member; an error if it is missing or this is no object.
  [[nodiscard]] JsonView at(std::string_view key) const;
  [[nodiscard]] JsonView at(std::size_t index) const;
  [[nodiscard]] std::size_t size() const;  // of an array or object

  [[nodiscard]] double number(double low, double high) const;  // finite, low <= value <= high
  [[nodiscard]] float real(float low = -3.4e38F, float high = 3.4e38F) const;
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const;  // 3.0 is not an integer
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;
  /// An array of exactly `out.size()` finite numbers in [low, high].
  void reals(std::span<float> out, float low = -3.4e38F, float high = 3.4e38F) const;
  /// One of `choices`; the error suggests the nearest.
  [[nodiscard]] std::size_t one_of(std::span<const std::string_view> choices) const;

  void require_object() const;
  void require_array() const;
  /// An error for the first key that is not in `known`, with the nearest known key.
  void only_keys(std::span<const std::string_view> known) const;
  /// Always throws InputError at this place.
  [[noreturn]] void fail(std::string_view what) const;

 private:
  const Json* value_;
  std::string_view file_;  // outlives the view
  std::string pointer_;
};

}  // namespace relook
