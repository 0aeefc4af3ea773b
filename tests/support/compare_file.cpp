#include "compare_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputPart.h>
#include <half.h>

#include <cstring>

namespace relook {
namespace {

template <class Value>
Bytes bytes_of_values(const std::vector<Value>& values) {
  const auto bytes = std::as_bytes(std::span<const Value>(values));
  return {bytes.begin(), bytes.end()};
}

std::size_t type_bytes(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

Imf::Header header_of(const FilePart& part) {
  Imf::Header header(part.display, part.data);
  header.compression() = part.compression;
  header.setType(part.tile_size > 0 ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
  if (part.tile_size > 0) header.setTileDescription(Imf::TileDescription(part.tile_size, part.tile_size));
  if (!part.name.empty()) header.setName(part.name);
  for (const auto& [name, channel] : part.channels) header.channels().insert(name, Imf::Channel(channel.type));
  for (const auto& [name, value] : part.attributes) header.insert(name, Imf::StringAttribute(value));
  return header;
}

Imf::FrameBuffer frame_buffer(std::map<std::string, FilePartChannel>& channels, const Imath::Box2i& window) {
  Imf::FrameBuffer buffer;
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  for (auto& [name, channel] : channels) {
    const std::size_t bytes = type_bytes(channel.type);
    buffer.insert(name, Imf::Slice::Make(channel.type, channel.samples.data(), window, bytes, bytes * width));
  }
  return buffer;
}

}  // namespace

FilePartChannel FilePartChannel::halves(const std::vector<float>& values) {
  std::vector<half> rounded(values.begin(), values.end());
  return {Imf::HALF, bytes_of_values(rounded)};
}
FilePartChannel FilePartChannel::floats(const std::vector<float>& values) {
  return {Imf::FLOAT, bytes_of_values(values)};
}
FilePartChannel FilePartChannel::uints(const std::vector<std::uint32_t>& values) {
  return {Imf::UINT, bytes_of_values(values)};
}

void FilePartChannel::flip_bit(std::size_t pixel) { samples[pixel * type_bytes(type)] ^= std::byte{1}; }

void FilePartChannel::set(std::size_t pixel, float value) {
  const half rounded(value);
  const void* from = type == Imf::HALF ? static_cast<const void*>(&rounded) : &value;
  std::memcpy(&samples[pixel * type_bytes(type)], from, type_bytes(type));
}

std::size_t FilePart::pixels() const {
  return static_cast<std::size_t>(data.max.x - data.min.x + 1) * static_cast<std::size_t>(data.max.y - data.min.y + 1);
}

FilePart& FilePart::fill(const std::string& channel, float value) {
  channels[channel] = FilePartChannel::floats(std::vector<float>(pixels(), value));
  return *this;
}

void write_parts(const std::filesystem::path& path, const std::vector<FilePart>& parts) {
  std::vector<Imf::Header> headers;
  for (const FilePart& part : parts) headers.push_back(header_of(part));
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::map<std::string, FilePartChannel> channels = parts[i].channels;
    const Imf::FrameBuffer buffer = frame_buffer(channels, parts[i].data);
    if (parts[i].tile_size > 0) {
      Imf::TiledOutputPart output(file, static_cast<int>(i));
      output.setFrameBuffer(buffer);
      output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
    } else {
      Imf::OutputPart output(file, static_cast<int>(i));
      output.setFrameBuffer(buffer);
      output.writePixels(parts[i].data.max.y - parts[i].data.min.y + 1);
    }
  }
}

std::vector<FilePart> read_parts(const std::filesystem::path& path) {
  Imf::MultiPartInputFile file(path.c_str());
  std::vector<FilePart> parts;
  for (int i = 0; i < file.parts(); ++i) {
    const Imf::Header& header = file.header(i);
    FilePart part;
    if (header.hasName()) part.name = header.name();
    part.display = header.displayWindow(), part.data = header.dataWindow();
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
      part.channels[it.name()] = {it.channel().type, Bytes(part.pixels() * type_bytes(it.channel().type))};
    for (auto it = header.begin(); it != header.end(); ++it) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
      if (text != nullptr && std::string(it.name()) != "type" && std::string(it.name()) != "name")
        part.attributes[it.name()] = text->value();
    }
    Imf::InputPart input(file, i);
    input.setFrameBuffer(frame_buffer(part.channels, part.data));
    input.readPixels(part.data.min.y, part.data.max.y);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace relook
