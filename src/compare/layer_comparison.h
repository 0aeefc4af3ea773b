// Two images of OpenEXR files, channel by channel, bit by bit, with figures for each layer: a layer's channels have the
// same name up to the last "."; R, G, B and A without one are the layer RGBA, any other channel without one is a layer
// of its own. Numbers that name things (uint channels, the ranks of Cryptomattes) are no quantities: they are the same
// or not, and no threshold lets a difference pass. What one image lacks is a difference in every pixel.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/json.h"
#include "compare/thresholds.h"
#include "frame/exr_file.h"
#include "frame/frame.h"

namespace relook {

struct LayerDifference {
  std::string part;   // "" when neither file has several
  std::string level;  // of resolution, "1" or, when rows and columns have their own, "1,0"; "" at full size
  std::string layer;
  ErrorFigures figures;                     // errors are those of quantities
  double rms_error = 0;                     // over the quantities; infinite when a difference is not finite
  bool has_quantities = false;              // channels of both that are no ids
  std::uint64_t pixels_other_ids = 0;       // pixels with another id
  std::string first_channel;                // the first that differs, its whole name; "" when equal
  std::vector<std::string> only_a, only_b;  // channels that the other lacks
  std::vector<std::string> other_kinds;     // channels that are uint in one and half or float in the other
  Verdict verdict = Verdict::equal;

  [[nodiscard]] bool has_other_channels() const { return !(only_a.empty() && only_b.empty() && other_kinds.empty()); }
};

/// The layer of a channel.
[[nodiscard]] std::string layer_name(const std::string& channel);

/// Where pictures are kept: frames of the size of the window, 0 where an image has nothing, A 1 where it lacks one.
struct KeptPictures {
  PixelWindow window;
  Frame a, b;
};

struct LayerRules {
  const Thresholds& thresholds;
  std::span<const std::string> cryptomattes;  // names from headers
};

/// Both images over the smallest window around both of theirs; outside of its own, an image is 0. `pictures`: their R,
/// G, B and A, or null.
[[nodiscard]] std::vector<LayerDifference> compare_layers(ImageRows& a, ImageRows& b, const PixelWindow& window,
                                                          const LayerRules& rules, KeptPictures* pictures);
/// An image that one of the files lacks. `is_a`: it is the first file's.
[[nodiscard]] std::vector<LayerDifference> lacking_layers(const ExrImage& image, bool is_a);

/// "part left, level 1, layer depth".
[[nodiscard]] std::string layer_place(const LayerDifference& difference);
/// "part left, channel depth.Z, only in the first"; "" when equal.
[[nodiscard]] std::string first_difference(const LayerDifference& difference);
/// part, level, layer, pixels_compared, pixels_different, max_error and rms_error (null when infinite, and without
/// quantities), verdict; when different also pixels_other_ids, pixels_above_fail, pixels_above_warn, first_channel,
/// only_in_a, only_in_b and other_kinds.
[[nodiscard]] Json layer_json(const LayerDifference& difference);

}  // namespace relook
