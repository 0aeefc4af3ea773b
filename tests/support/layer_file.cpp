#include "layer_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <sstream>

namespace relook {

std::vector<std::string> LayerFile::layers_of_sum(const std::string& attribute) const {
  std::istringstream text(attributes.at(attribute));
  std::vector<std::string> layers;
  for (std::string layer; text >> layer;) layers.push_back(layer);
  return layers;
}

std::vector<float> LayerFile::sum(const std::string& attribute, const std::string& name) const {
  const std::vector<std::string> layers = layers_of_sum(attribute);
  std::vector<float> sum = channel(layers.at(0) + "." + name);
  for (std::size_t layer = 1; layer < layers.size(); ++layer) {
    const std::vector<float>& values = channel(layers[layer] + "." + name);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
  }
  return sum;
}

LayerFile read_layers(const std::filesystem::path& path) {
  Imf::InputFile input(path.c_str());
  const Imf::Header& header = input.header();
  LayerFile file;
  const Imath::Box2i window = header.dataWindow();
  file.width = static_cast<std::uint32_t>(window.max.x + 1);
  file.height = static_cast<std::uint32_t>(window.max.y + 1);
  Imf::FrameBuffer target;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    std::vector<float>& values = file.channels[it.name()];
    values.resize(std::size_t{file.width} * file.height);
    target.insert(it.name(),
                  Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float), sizeof(float) * file.width));
  }
  input.setFrameBuffer(target);
  input.readPixels(window.min.y, window.max.y);
  for (auto it = header.begin(); it != header.end(); ++it)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
      file.attributes[it.name()] = text->value();
  return file;
}

LayerFile read_layers(BytesView bytes, const std::filesystem::path& scratch) {
  write_file(scratch, bytes);
  return read_layers(scratch);
}

}  // namespace relook
