// textures-<hash>.rlk: the encoded images, for edits that show them for the first time, and the pyramids made so far.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/import_memory.h"
#include "base/json.h"
#include "cache/scene_parts.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 3> kFormats{"srgb8", "linear8", "float32"};

std::string blob_name(const char* kind, std::size_t index) { return kind + std::to_string(index); }

Json pyramid_entry(const std::string& image, bool color, const TexturePyramid& pyramid) {
  Json levels = Json::array();
  for (const TexturePyramid::Level& level : pyramid.levels) levels.push_back(Json::array({level.width, level.height}));
  return {{"image", image},
          {"color", color},
          {"format", kFormats[static_cast<std::size_t>(pyramid.format)]},
          {"levels", std::move(levels)}};
}

/// Reads the sizes of the levels, each half of the one before. `texels`: adds up those of all levels.
std::vector<TexturePyramid::Level> read_levels(const JsonView& view, std::uint64_t& texels) {
  constexpr std::int64_t kLargestSide = std::int64_t{1} << 28;
  view.require_array();
  std::vector<TexturePyramid::Level> levels;
  for (std::size_t i = 0; i < view.size(); ++i) {
    TexturePyramid::Level level;
    level.width = static_cast<std::uint32_t>(view.at(i).at(std::size_t{0}).integer(1, kLargestSide));
    level.height = static_cast<std::uint32_t>(view.at(i).at(std::size_t{1}).integer(1, kLargestSide));
    level.offset = texels;
    if (i > 0 && (level.width != std::max(levels.back().width / 2, 1U) ||
                  level.height != std::max(levels.back().height / 2, 1U)))
      view.at(i).fail("not half the size of the level before");
    texels += std::uint64_t{level.width} * level.height;
    if (texels > 2 * kMostImagePixels) view.fail("too many texels");
    levels.push_back(level);
  }
  if (levels.empty()) view.fail("no levels");
  return levels;
}

std::shared_ptr<const TexturePyramid> read_pyramid(const JsonView& entry, const std::string& blob,
                                                   std::span<const Rgba> range, const ContainerReader& reader) {
  TexturePyramid pyramid;
  pyramid.format = static_cast<TexelFormat>(entry.at("format").one_of(kFormats));
  std::uint64_t texels = 0;
  pyramid.levels = read_levels(entry.at("levels"), texels);
  const bool is_float = pyramid.format == TexelFormat::float32;
  ImportShare share(texels * (is_float ? 16 : 4), "", "image " + printable(entry.at("image").text()));
  if (is_float) {
    pyramid.texels32 = reader.column<float>(blob, texels * 4);
    for (const float value : pyramid.texels32)
      check_sound(std::isfinite(value), "a number that is not finite in section ", blob);
  } else {
    pyramid.texels8 = reader.column<std::uint8_t>(blob, texels * 4);
  }
  pyramid.smallest = range[0];
  pyramid.largest = range[1];
  return kept_with(std::move(share), std::move(pyramid));
}

/// Numbers of the distinct images, by the address of their bytes: images that share bytes share a section.
using BlobNumbers = std::map<const Bytes*, std::size_t>;

Json image_entries(const Assets& assets, BlobNumbers& blobs) {
  Json entries = Json::array();
  for (const auto& [name, image] : assets.images) {
    if (image.bytes == nullptr) continue;
    const std::size_t next = blobs.size();
    const std::size_t number = blobs.emplace(image.bytes.get(), next).first->second;
    entries.push_back({{"name", name}, {"blob", number}});
  }
  return entries;
}

void read_images(const JsonView& entries, const ContainerReader& reader, Assets& assets) {
  entries.require_array();
  std::map<std::int64_t, std::shared_ptr<const Bytes>> blobs;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const JsonView entry = entries.at(i);
    const std::int64_t number = entry.at("blob").integer(0, static_cast<std::int64_t>(entries.size()));
    std::shared_ptr<const Bytes>& bytes = blobs[number];
    const std::string section = blob_name("image", static_cast<std::size_t>(number));
    if (bytes == nullptr) {
      const std::uint64_t size = reader.raw_bytes(section);
      ImportShare share(size, "", "section " + section);
      bytes = kept_with(std::move(share), reader.column<std::byte>(section, size));
    }
    const std::string name = entry.at("name").text();
    assets.images[name] = {name, bytes};
  }
}

}  // namespace

Bytes encode_textures(const Assets& assets, const PyramidStore& pyramids, const CacheIdentity& identity) {
  ContainerWriter writer;
  BlobNumbers blobs;
  Json images = image_entries(assets, blobs);
  Json pyramid_entries = Json::array();
  std::vector<Rgba> ranges;
  const auto all = pyramids.all();
  for (const auto& [key, pyramid] : all) {
    pyramid_entries.push_back(pyramid_entry(key.first, key.second, *pyramid));
    ranges.push_back(pyramid->smallest);
    ranges.push_back(pyramid->largest);
  }
  writer.add("names", bytes_of(Json{{"images", std::move(images)}, {"pyramids", std::move(pyramid_entries)}}.dump()));
  writer.add_column("ranges", ranges, sizeof(float));
  std::vector<const Bytes*> ordered(blobs.size());
  for (const auto& [bytes, number] : blobs) ordered[number] = bytes;
  for (std::size_t i = 0; i < ordered.size(); ++i) writer.add(blob_name("image", i), *ordered[i]);
  std::size_t number = 0;
  for (const auto& [key, pyramid] : all) {
    const std::string name = blob_name("pyramid", number++);
    if (pyramid->format == TexelFormat::float32)
      writer.add_column(name, pyramid->texels32, sizeof(float));
    else
      writer.add_column(name, pyramid->texels8, 1);
  }
  return writer.finish(identity);
}

void decode_textures(BytesView file, const CacheIdentity& identity, Assets& assets, PyramidStore& pyramids) {
  const ContainerReader reader(file, identity);
  const std::string text = reader.text("names");
  try {
    const Json json = parse_json(text, "");
    const JsonView names(json, "");
    read_images(names.at("images"), reader, assets);
    const JsonView entries = names.at("pyramids");
    entries.require_array();
    const std::vector<Rgba> ranges = reader.column<Rgba>("ranges", std::uint64_t{entries.size()} * 2);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const JsonView entry = entries.at(i);
      pyramids.put(
          entry.at("image").text(), entry.at("color").boolean(),
          read_pyramid(entry, blob_name("pyramid", i), std::span<const Rgba>(ranges).subspan(2 * i, 2), reader));
    }
  } catch (const InputError& fault) {
    throw CacheDamage(CacheFault::damaged, fault.what());
  }
}

}  // namespace relook
