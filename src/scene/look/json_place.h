// Where a value of a JSON document is, without a string for what turns out to be right: for the checks that walk over
// whole documents (look_walk.cpp, gltf/check/gltf_values.cpp).
#pragma once
#include <string>
#include <string_view>

#include "base/json.h"

namespace relook {

/// The way down to a value; spelled out only when something is wrong there.
struct JsonPlace {
  const JsonPlace* parent = nullptr;  // outlives this; none: `key` is a pointer
  std::string_view key;               // empty: `index` counts
  std::size_t index = 0;

  [[nodiscard]] std::string text() const {
    if (parent == nullptr) return std::string(key);
    return parent->text() + "/" + (key.empty() ? std::to_string(index) : escape_token(key));
  }
};

}  // namespace relook
