// A frame with layers as another program would read it: through OpenEXR's C++ library.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"

namespace relook {

struct LayerFile {
  std::uint32_t width = 0, height = 0;
  std::map<std::string, std::vector<float>> channels;  // [height * width]
  std::map<std::string, std::string> attributes;       // strings

  [[nodiscard]] const std::vector<float>& channel(const std::string& name) const { return channels.at(name); }
  /// The layers that an attribute lists, in the order of addition.
  [[nodiscard]] std::vector<std::string> layers_of_sum(const std::string& attribute) const;
  /// Those layers' channels of one name, added up in float32 from first to last.
  [[nodiscard]] std::vector<float> sum(const std::string& attribute, const std::string& channel) const;
};

[[nodiscard]] LayerFile read_layers(const std::filesystem::path& path);
/// `scratch`: a file to write on the way.
[[nodiscard]] LayerFile read_layers(BytesView bytes, const std::filesystem::path& scratch);

}  // namespace relook
