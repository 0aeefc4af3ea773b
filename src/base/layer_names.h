// Names of layers in OpenEXR files: unique, and free of what divides channels or our own lists.
#pragma once
#include <map>
#include <string>
#include <string_view>

namespace relook {

/// A name as part of a channel's: ASCII's letters, digits, "_" and "-" stay, and the characters of other alphabets; of
/// the rest some divide channels or our own lists, each is "_".
[[nodiscard]] std::string channel_name(std::string_view name);

/// Gives layers names that differ and that channels can have.
class LayerNames {
 public:
  [[nodiscard]] std::string take(const std::string& wanted);

 private:
  std::map<std::string, int> next_;  // by name that is taken: what its next copy is numbered
};

}  // namespace relook
