#include "compare_text.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"

namespace relook {
namespace {

std::string pixel_text(const Rgba& pixel) {
  return short_number(double{pixel.r}) + " " + short_number(double{pixel.g}) + " " + short_number(double{pixel.b}) +
         " " + short_number(double{pixel.a});
}

std::string names_text(const char* what, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + printable(name);
  return text.empty() ? "" : std::string("; ") + what + ": " + text;
}

std::string counts_text(const std::string& name, std::uint64_t different, std::uint64_t compared) {
  return name + ": " + std::to_string(different) + " of " + std::to_string(compared) + " pixels differ";
}

std::string errors_text(double max_error, double rms_error) {
  return ", max error " + short_number(max_error) + ", RMS error " + short_number(rms_error);
}

std::string layer_text(const std::string& name, const LayerDifference& layer) {
  std::string line = counts_text(name + ": " + printable(layer_place(layer)), layer.figures.pixels_different,
                                 layer.figures.pixels_compared);
  if (layer.has_quantities) line += errors_text(layer.figures.max_error, layer.rms_error);
  line += ", first channel " + printable(layer.first_channel) + beyond_figures(layer);
  if (layer.verdict == Verdict::within) line += "; within the thresholds";
  return line;
}

std::string picture_text(const std::string& name, const FrameComparison& comparison) {
  std::string line = difference_text(name, comparison.difference);
  if (comparison.psnr) line += ", PSNR " + short_number(*comparison.psnr) + " dB";
  if (comparison.worst && comparison.ssim) line += ", SSIM " + short_number(*comparison.ssim);
  if (comparison.flip) line += ", FLIP " + short_number(comparison.flip->mean);
  if (const auto& worst = comparison.worst)
    line += ", worst at " + std::to_string(worst->x) + "," + std::to_string(worst->y) + ": " + pixel_text(worst->a) +
            " and " + pixel_text(worst->b);
  if (comparison.own_layer < comparison.layers.size()) line += beyond_figures(comparison.layers[comparison.own_layer]);
  return line;
}

}  // namespace

std::string short_number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string difference_text(const std::string& name, const FrameDifference& difference) {
  return counts_text(name, difference.pixels_different, difference.pixels_compared) +
         errors_text(difference.max_error, difference.rms_error);
}

std::vector<std::string> comparison_text(const std::string& name, const FrameComparison& comparison) {
  const std::size_t others = layers_different(comparison);
  std::string line = comparison.has_picture
                         ? picture_text(name, comparison)
                         : name + ": " + std::to_string(others) + " of " + std::to_string(comparison.layers.size()) +
                               " layers differ, no picture";
  if (!comparison.first_difference.empty()) line += "; first difference: " + printable(comparison.first_difference);
  if (comparison.verdict == Verdict::within) line += "; within the thresholds";
  std::vector<std::string> lines{std::move(line)};
  for (std::size_t i = 0; i < comparison.layers.size(); ++i) {
    const bool is_said = comparison.has_picture && i == comparison.own_layer;
    if (!is_said && comparison.layers[i].verdict != Verdict::equal)
      lines.push_back(layer_text(name, comparison.layers[i]));
  }
  return lines;
}

std::string beyond_figures(const LayerDifference& layer) {
  std::string text;
  if (layer.pixels_other_ids > 0) text += "; other ids in " + std::to_string(layer.pixels_other_ids) + " pixels";
  return text + names_text("only in the first", layer.only_a) + names_text("only in the second", layer.only_b) +
         names_text("uint in one only", layer.other_kinds);
}

std::size_t layers_different(const FrameComparison& comparison) {
  return static_cast<std::size_t>(
      std::ranges::count_if(comparison.layers, [](const auto& layer) { return layer.verdict != Verdict::equal; }));
}

}  // namespace relook
