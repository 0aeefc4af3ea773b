#include "cache/image_parts.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "base/error.h"

namespace relook {
namespace {

std::size_t tiles_per_group(std::uint32_t samples) {
  constexpr std::size_t kGroupSamples = 32 * kTileSize * kTileSize;
  return std::max<std::size_t>(kGroupSamples / (std::size_t{kTileSize} * kTileSize * samples), 1);
}

/// `tiles`: of the image.
TileGroup group_of(std::size_t tiles, std::uint32_t samples, std::size_t group) {
  const std::size_t first = group * tiles_per_group(samples);
  return {first, std::min(first + tiles_per_group(samples), tiles)};
}

void check_colors(const std::vector<Rgba>& colors, const char* section) {
  for (const Rgba& color : colors)
    check_sound(std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b) && std::isfinite(color.a),
                "a number that is not finite in section ", section);
}

/// The pixels of a tile, in its order.
std::vector<Rgba> pixels_of_tile(const Frame& frame, std::size_t tile) {
  const TileRect rect = tile_rect(tile, frame.width, frame.height);
  std::vector<Rgba> pixels;
  pixels.reserve(rect.pixels());
  for (std::uint32_t y = rect.y0; y < rect.y1; ++y) {
    const Rgba* row = frame.pixels.data() + std::size_t{y} * frame.width;
    pixels.insert(pixels.end(), row + rect.x0, row + rect.x1);
  }
  return pixels;
}

/// At one sample a pixel the frame says it all.
bool colors_are_pixels(const Image& image, std::size_t first_tile, std::size_t last_tile) {
  if (image.view.samples != 1) return false;
  for (std::size_t tile = first_tile; tile < last_tile; ++tile) {
    const std::vector<Rgba> pixels = pixels_of_tile(image.frame, tile);
    const std::vector<Rgba>& colors = image.sample_colors[tile];
    if (std::memcmp(pixels.data(), colors.data(), pixels.size() * sizeof(Rgba)) != 0) return false;
  }
  return true;
}

/// How many samples the tiles [first, last) have each.
std::vector<std::size_t> tile_samples(const Image& image, std::size_t first, std::size_t last) {
  std::vector<std::size_t> samples;
  for (std::size_t tile = first; tile < last; ++tile)
    samples.push_back(sample_count(tile_rect(tile, image.frame.width, image.frame.height), image.view.samples));
  return samples;
}

}  // namespace

std::size_t cache_group_count(const Camera& camera, std::uint32_t samples) {
  return (tile_count(camera.width, camera.height) + tiles_per_group(samples) - 1) / tiles_per_group(samples);
}

std::size_t cache_group_of(std::uint32_t samples, std::size_t tile) { return tile / tiles_per_group(samples); }

TileGroup cache_group(const Camera& camera, std::uint32_t samples, std::size_t group) {
  return group_of(tile_count(camera.width, camera.height), samples, group);
}

TileGroup cache_group(const Image& image, std::size_t group) {
  return group_of(tile_count(image.frame.width, image.frame.height), image.view.samples, group);
}

Bytes encode_frame(const Image& image, const CacheIdentity& identity) {
  require(image.frame.pixels.size() == std::size_t{image.frame.width} * image.frame.height, "the frame is whole");
  ContainerWriter writer;
  writer.add_column("pixels", image.frame.pixels, sizeof(Rgba));
  return writer.finish(identity);
}

Bytes encode_paths(const Image& image, const CacheIdentity& identity) {
  ContainerWriter writer;
  writer.add("words", std::as_bytes(image.paths.all_words()), sizeof(std::uint32_t));
  writer.add("offsets", std::as_bytes(image.paths.all_offsets()), sizeof(std::uint64_t));
  return writer.finish(identity);
}

Bytes encode_trees(const Image& image, std::size_t group, const CacheIdentity& identity) {
  std::vector<std::uint32_t> paths, primitives;
  std::vector<float> u, v;
  std::vector<Rgba> colors;
  std::vector<std::uint8_t> kept;
  const auto [first, last] = cache_group(image, group);
  const std::vector<std::size_t> samples = tile_samples(image, first, last);
  const bool has_sums = image.view.integrator == Integrator::path;
  for (std::size_t tile = first; tile < last; ++tile) {
    const TileTrees& trees = image.trees[tile];
    require(trees.paths.size() == samples[tile - first], "a tile has all samples");
    for (const PathId path : trees.paths) paths.push_back(path.index());
    kept.push_back(trees.first_hit.empty() ? 0 : 1);
    for (const Hit& hit : trees.hits) {
      primitives.push_back(hit.primitive);
      u.push_back(hit.u);
      v.push_back(hit.v);
    }
    if (has_sums) continue;
    const std::vector<Rgba>& tile_colors = image.sample_colors[tile];
    require(tile_colors.size() == trees.paths.size(), "a tile has the colours of all samples");
    colors.insert(colors.end(), tile_colors.begin(), tile_colors.end());
  }
  ContainerWriter writer;
  writer.add_column("paths", paths, sizeof(std::uint32_t));
  if (std::ranges::find(kept, 0) != kept.end()) writer.add_column("kept", kept, sizeof(std::uint8_t));
  writer.add_column("primitives", primitives, sizeof(std::uint32_t));
  writer.add_column("u", u, sizeof(float));
  writer.add_column("v", v, sizeof(float));
  if (has_sums)
    add_sums(writer, std::span(image.light_sums).subspan(first, last - first));
  else if (!colors_are_pixels(image, first, last))
    writer.add_column("colors", colors, sizeof(Rgba));
  return writer.finish(identity);
}

void decode_frame(BytesView file, const CacheIdentity& identity, Image& image) {
  const ContainerReader reader(file, identity);
  image.frame.pixels = reader.column<Rgba>("pixels", std::uint64_t{image.frame.width} * image.frame.height);
  check_colors(image.frame.pixels, "pixels");
}

void decode_paths(BytesView file, const CacheIdentity& identity, CacheContent& content) {
  const ContainerReader reader(file, identity);
  std::vector<std::uint32_t> words = reader.column<std::uint32_t>("words", reader.count<std::uint32_t>("words"));
  const Frame& frame = content.image.frame;
  const std::uint64_t most = std::uint64_t{frame.width} * frame.height * content.image.view.samples + 1;
  check_sound(reader.count<std::uint64_t>("offsets") <= most, "more paths than samples in section offsets");
  std::vector<std::uint64_t> offsets = reader.column<std::uint64_t>("offsets", reader.count<std::uint64_t>("offsets"));
  check_sound(!offsets.empty() && offsets.front() == 0 && offsets.back() == words.size() &&
                  std::is_sorted(offsets.begin(), offsets.end(), std::less_equal<>()),
              "the offsets of section offsets do not increase");
  const PathLayout layout{content.lights, content.image.view.shadow_bits};
  PathTable& paths = content.image.paths;
  paths = PathTable::from_columns(std::move(words), std::move(offsets));
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const auto path = paths.words(PathId(static_cast<std::uint32_t>(i)));
    const std::vector<std::string> broken = broken_invariants(path, content.objects, layout);
    check_sound(broken.empty(), broken.empty() ? "" : "path " + std::to_string(i) + ": " + broken.front());
  }
}

namespace {

/// Cuts the columns of a group into tiles, from the front.
struct GroupColumns {
  std::vector<std::uint32_t> paths, primitives;
  std::vector<float> u, v;
  std::vector<Rgba> colors;
  std::vector<std::uint8_t> kept;  // by tile: are there hits?
  std::size_t next_sample = 0, next_hit = 0;

  TileTrees take_tile(std::size_t samples, bool has_hits, std::span<const std::size_t> hits_of_path) {
    TileTrees trees;
    trees.paths.reserve(samples);
    if (!has_hits) {
      for (std::size_t i = 0; i < samples; ++i) trees.paths.emplace_back(paths[next_sample++]);
      return trees;
    }
    trees.first_hit.reserve(samples + 1);
    trees.first_hit.push_back(0);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      const std::uint32_t path = paths[next_sample++];
      trees.paths.emplace_back(path);
      hits += hits_of_path[path];
      trees.first_hit.push_back(static_cast<std::uint32_t>(hits));
    }
    trees.hits.reserve(hits);
    for (std::size_t i = 0; i < hits; ++i, ++next_hit)
      trees.hits.push_back({primitives[next_hit], u[next_hit], v[next_hit]});
    return trees;
  }
};

void check_weights(const std::vector<float>& weights, const char* section) {
  constexpr float kLargestWeight = 2;
  for (const float weight : weights)
    check_sound(std::abs(weight) <= kLargestWeight, "a weight beyond a triangle in section ", section);
}

/// `tile_samples`: of each tile of the group.
GroupColumns read_columns(const ContainerReader& reader, std::span<const std::size_t> tile_samples, bool has_colors,
                          std::span<const std::size_t> hits_of_path) {
  GroupColumns columns;
  const std::uint64_t samples = std::accumulate(tile_samples.begin(), tile_samples.end(), std::uint64_t{0});
  columns.paths = reader.column<std::uint32_t>("paths", samples);
  columns.kept.assign(tile_samples.size(), 1);
  if (reader.has("kept")) columns.kept = reader.column<std::uint8_t>("kept", tile_samples.size());
  std::uint64_t hits = 0;
  const std::uint32_t* path = columns.paths.data();
  for (std::size_t tile = 0; tile < tile_samples.size(); ++tile) {
    check_sound(columns.kept[tile] <= 1, "neither yes nor no in section kept");
    for (std::size_t i = 0; i < tile_samples[tile]; ++i, ++path) {
      check_sound(*path < hits_of_path.size(), "a path that does not exist in section paths");
      if (columns.kept[tile] == 1) hits += hits_of_path[*path];
    }
  }
  check_sound(hits <= std::numeric_limits<std::uint32_t>::max(), "more hits than a tile group can have");
  columns.primitives = reader.column<std::uint32_t>("primitives", hits);
  columns.u = reader.column<float>("u", hits);
  columns.v = reader.column<float>("v", hits);
  check_weights(columns.u, "u");
  check_weights(columns.v, "v");
  if (has_colors) {
    columns.colors = reader.column<Rgba>("colors", samples);
    check_colors(columns.colors, "colors");
  }
  return columns;
}

}  // namespace

void decode_trees(BytesView file, const CacheIdentity& identity, std::size_t group,
                  std::span<const std::size_t> hits_of_path, CacheContent& content) {
  const ContainerReader reader(file, identity);
  Image& image = content.image;
  const bool has_sums = image.view.integrator == Integrator::path;
  const auto [first, last] = cache_group(image, group);
  const std::vector<std::size_t> samples = tile_samples(image, first, last);
  const bool has_colors = !has_sums && reader.has("colors");
  check_sound(has_sums || has_colors || image.view.samples == 1, "no section colors");
  GroupColumns columns = read_columns(reader, samples, has_colors, hits_of_path);
  for (std::size_t tile = first; tile < last; ++tile) {
    const auto first_color = static_cast<std::ptrdiff_t>(columns.next_sample);
    image.trees[tile] = columns.take_tile(samples[tile - first], columns.kept[tile - first] == 1, hits_of_path);
    if (has_sums) continue;
    if (!has_colors)
      image.sample_colors[tile] = pixels_of_tile(image.frame, tile);
    else
      image.sample_colors[tile].assign(columns.colors.begin() + first_color,
                                       columns.colors.begin() + static_cast<std::ptrdiff_t>(columns.next_sample));
  }
  if (!has_sums) return;
  const std::size_t sums = content.lights - content.shared + kSumsBesideLights;
  read_sums(reader, sums, image.frame, first, std::span(image.light_sums).subspan(first, last - first));
}

}  // namespace relook
