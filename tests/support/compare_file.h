// OpenEXR files as other programs write them, for comparisons: any parts, windows, kinds of channels.
#pragma once
#include <ImathBox.h>
#include <ImfCompression.h>
#include <ImfPixelType.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"

namespace relook {

struct FilePartChannel {
  Imf::PixelType type = Imf::FLOAT;
  Bytes samples;  // [height * width] of the data window

  static FilePartChannel halves(const std::vector<float>& values);
  static FilePartChannel floats(const std::vector<float>& values);
  static FilePartChannel uints(const std::vector<std::uint32_t>& values);
  /// Changes the last bit of a sample.
  void flip_bit(std::size_t pixel);
  /// Requires: half or float.
  void set(std::size_t pixel, float value);
};

struct FilePart {
  std::string name;  // "": none
  Imath::Box2i display{{0, 0}, {7, 5}}, data{{0, 0}, {7, 5}};
  std::map<std::string, FilePartChannel> channels;
  std::map<std::string, std::string> attributes;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  unsigned tile_size = 0;  // 0: no tiles, but rows

  [[nodiscard]] std::size_t pixels() const;
  /// A channel of floats, the same value everywhere.
  FilePart& fill(const std::string& channel, float value);
};

void write_parts(const std::filesystem::path& path, const std::vector<FilePart>& parts);
/// Flat parts, with string attributes.
[[nodiscard]] std::vector<FilePart> read_parts(const std::filesystem::path& path);

}  // namespace relook
