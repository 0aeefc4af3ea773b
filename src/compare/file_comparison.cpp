#include "compare/file_comparison.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "base/error.h"

namespace relook {
namespace {

struct ImagePair {
  const ExrImage *a = nullptr, *b = nullptr;  // one may be missing
};

bool is_same_place(const ExrImage& a, const ExrImage& b) {
  if (a.level_x != b.level_x || a.level_y != b.level_y) return false;
  if (a.part.empty() || b.part.empty()) return a.part_index == 0 && b.part_index == 0;
  return a.part == b.part;
}

/// In the order of the first file; what only the second has comes last.
std::vector<ImagePair> matched(const ExrFile& a, const ExrFile& b) {
  std::vector<ImagePair> pairs;
  std::vector<const ExrImage*> rest;
  for (const ExrImage& image : b.images()) rest.push_back(&image);
  for (const ExrImage& image : a.images()) {
    const auto found = std::ranges::find_if(rest, [&](const ExrImage* other) { return is_same_place(image, *other); });
    pairs.push_back({&image, found == rest.end() ? nullptr : *found});
    if (found != rest.end()) rest.erase(found);
  }
  for (const ExrImage* image : rest) pairs.push_back({nullptr, image});
  return pairs;
}

/// Has it R, G and B, and A if at all, in numbers that are colours?
bool is_picture(const ExrImage& image) {
  std::size_t colors = 0;
  for (const StoredChannel& channel : image.channels) {
    if (layer_name(channel.name) != "RGBA" || channel.name.size() != 1) continue;
    if (channel.kind == SampleKind::uint32) return false;
    colors += channel.name == "A" ? 0 : 1;
  }
  return colors == 3;
}

const ExrImage* picture_of(const ExrFile& file) {
  const auto found = std::ranges::find_if(file.images(), is_picture);
  return found == file.images().end() ? nullptr : &*found;
}

PixelWindow window_around(const PixelWindow& a, const PixelWindow& b, const std::string& file) {
  const PixelWindow window{std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
  if (!is_read_size(window.width(), window.height()))
    throw InputError(file, "dataWindow", "too far from that of the other file to be compared");
  return window;
}

std::string size_text(const PixelWindow& window) {
  return std::to_string(window.width()) + "x" + std::to_string(window.height());
}

std::string level_text(const ExrImage& image) {
  if (image.level_x == 0 && image.level_y == 0) return "";
  if (image.level_x == image.level_y) return std::to_string(image.level_x);
  return std::to_string(image.level_x) + "," + std::to_string(image.level_y);
}

void set_place(std::vector<LayerDifference>& layers, const ImagePair& pair, bool has_parts) {
  const ExrImage& image = pair.a != nullptr && (pair.b == nullptr || !pair.a->part.empty()) ? *pair.a : *pair.b;
  for (LayerDifference& layer : layers) {
    if (has_parts) layer.part = image.part;
    layer.level = level_text(image);
  }
}

Frame black(const PixelWindow& window) {
  return {static_cast<std::uint32_t>(window.width()), static_cast<std::uint32_t>(window.height()),
          std::vector<Rgba>(static_cast<std::size_t>(window.width() * window.height()), Rgba(0, 0, 0, 0))};
}

/// The frame's own figures, when there is a picture: all of its pixels differ when only one file has an alpha.
void set_picture(FileComparison& files, const PixelWindow& window, const Thresholds& thresholds,
                 const std::optional<DisplayWhite>& white) {
  FrameComparison comparison = compare_closely(files.a, files.b, thresholds, white);
  comparison.layers = std::move(files.comparison.layers);
  comparison.own_layer = files.comparison.own_layer;
  if (comparison.worst) {
    comparison.worst->x += static_cast<std::int32_t>(window.x0);
    comparison.worst->y += static_cast<std::int32_t>(window.y0);
  }
  LayerDifference& layer = comparison.layers[comparison.own_layer];
  if (layer.has_other_channels()) comparison.difference.pixels_different = layer.figures.pixels_different;
  layer.verdict = std::max(layer.verdict, comparison.verdict);  // FLIP has thresholds, too
  files.comparison = std::move(comparison);
}

/// The frame's own figures, when there is none: those of the first layer that differs.
void set_layer(FrameComparison& comparison) {
  comparison.has_picture = false;
  if (comparison.layers.empty()) return;
  const auto found =
      std::ranges::find_if(comparison.layers, [](const auto& layer) { return layer.verdict != Verdict::equal; });
  const auto own = found == comparison.layers.end() ? comparison.layers.begin() : found;
  comparison.own_layer = static_cast<std::size_t>(own - comparison.layers.begin());
  comparison.difference.pixels_compared = own->figures.pixels_compared;
  comparison.difference.pixels_different = own->figures.pixels_different;
  comparison.difference.max_error = own->figures.max_error;
  comparison.difference.rms_error = own->rms_error;
  comparison.difference.squares =
      own->rms_error * own->rms_error * 4 * static_cast<double>(own->figures.pixels_compared);
  comparison.pixels_above_fail = own->figures.pixels_above_fail;
  comparison.pixels_above_warn = own->figures.pixels_above_warn;
}

void set_whole_verdict(FrameComparison& comparison, bool has_display_moved) {
  if (has_display_moved) {
    comparison.first_difference = "origin of the display window";
    comparison.verdict = Verdict::failure;
  }
  for (const LayerDifference& layer : comparison.layers) {
    comparison.verdict = std::max(comparison.verdict, layer.verdict);
    if (comparison.first_difference.empty()) comparison.first_difference = first_difference(layer);
  }
}

}  // namespace

FileComparison compare_exr_files(const ExrFile& a, const ExrFile& b, const Thresholds& thresholds,
                                 const std::optional<DisplayWhite>& white) {
  if (size_text(a.display()) != size_text(b.display()))
    throw InputError(b.name(), "",
                     size_text(b.display()) + " pixels, not the " + size_text(a.display()) + " of " + a.name());
  std::vector<std::string> cryptomattes = a.cryptomattes();
  cryptomattes.insert(cryptomattes.end(), b.cryptomattes().begin(), b.cryptomattes().end());
  const LayerRules rules{thresholds, cryptomattes};
  const ExrImage *picture_a = picture_of(a), *picture_b = picture_of(b);
  FileComparison files;
  std::optional<KeptPictures> pictures;
  for (const ImagePair& pair : matched(a, b)) {
    std::vector<LayerDifference> layers;
    if (pair.a != nullptr && pair.b != nullptr) {
      const PixelWindow window = window_around(pair.a->window, pair.b->window, b.name());
      const bool has_pictures = pair.a == picture_a && pair.b == picture_b;
      if (has_pictures) {
        pictures = KeptPictures{window, black(window), black(window)};
        files.comparison.own_layer = files.comparison.layers.size();  // RGBA is the first layer of its image
      }
      ImageRows rows_a(a, *pair.a), rows_b(b, *pair.b);
      layers = compare_layers(rows_a, rows_b, window, rules, has_pictures ? &*pictures : nullptr);
    } else {
      layers = pair.a != nullptr ? lacking_layers(*pair.a, true) : lacking_layers(*pair.b, false);
    }
    set_place(layers, pair, a.part_count() > 1 || b.part_count() > 1);
    std::ranges::move(layers, std::back_inserter(files.comparison.layers));
  }
  if (pictures) {
    files.a = std::move(pictures->a), files.b = std::move(pictures->b);
    set_picture(files, pictures->window, thresholds, white);
  } else {
    set_layer(files.comparison);
  }
  set_whole_verdict(files.comparison, a.display().x0 != b.display().x0 || a.display().y0 != b.display().y0);
  return files;
}

}  // namespace relook
