// What a run keeps of a frame so that it can be lit otherwise without a ray (replay --relight): a layer for each sum of
// light that the frame is made of, half, as an OpenEXR file. Frames of Integrator::path are sums over lights of colour
// times exact sum (frame/light_sums.h); a layer is that sum for white light of `scale`, a power of four near the
// light's own: so a tile's bytes stay the same while colours change within a power, and a layer serves a colour of any
// hue.
//
//     frame = sum over layers of colour_l / scale_l * layer_l,       up to the rounding of halves
//
// The header attribute relook:relight is the JSON that relight_json() makes: layers, scales, and what of the look
// document scales which.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cache/residency/residency.h"
#include "frame/frame_file.h"
#include "frame/image.h"
#include "scene/light_controls.h"

namespace relook {

/// The name of the attribute.
inline constexpr const char* kRelightAttribute = "relook:relight";

struct RelightLayer {
  std::string name;     // as layers of --aovs
  std::size_t sum = 0;  // by place in light_sums()
  double scale = 1;     // a power of four
  bool operator==(const RelightLayer&) const = default;
};

/// Layers and controls of a frame. A control's sums are by place in `layers`.
struct RelightTable {
  /// `state`: of Integrator::path.
  explicit RelightTable(const SceneState& state);
  std::vector<RelightLayer> layers;
  std::vector<LightControl> controls;
};
/// {"layers": [{"name", "scale"}], "controls": [{"kind", "name", "layers": [places], "unit", "settings": [{"color":
/// {"path", "value"}, "intensity": likewise or null}]}]}
[[nodiscard]] Json relight_json(const RelightTable& table);

/// Makes the files of one run's frames, one after the other. Tiles whose layers are those of the frame before are not
/// compressed again.
class RelightEncoder {
 public:
  /// `keeps_tiles`: else nothing stays in memory between two files.
  explicit RelightEncoder(bool keeps_tiles) : keeps_tiles_(keeps_tiles) {}

  /// The file of the frame that `state` and `image` have. `versions`: by tile, a number that is another one whenever
  /// its sums are; empty: not known. `residency`: of the sums.
  [[nodiscard]] Bytes exr(const SceneState& state, const Image& image, const std::vector<std::uint32_t>& versions,
                          Residency& residency, const FrameMeta& meta);

 private:
  bool keeps_tiles_;
  std::vector<RelightLayer> layers_;     // of tiles_
  std::vector<std::uint32_t> versions_;  // of tiles_
  std::vector<Bytes> tiles_;             // compressed; none: nothing is kept
};

}  // namespace relook
