// A display view (frame/display_view.h) as a lattice of 33 x 33 x 33 colours, for browsers, which have no OpenColorIO:
// cli/page/assets/curves.js interpolates it between the corners of tetrahedra, as show() does. How far that is off is
// measured against the view itself and stands beside it. Used by run_page.cpp.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/json.h"
#include "base/math.h"
#include "frame/display_view.h"

namespace relook {

class ViewLut {
 public:
  static constexpr std::size_t kSize = 33;  // colours a side
  /// Along a side a linear value v lies at log2(1 + v / kOffset), its end is kMost: zero is a corner, dark values stand
  /// evenly, light ones by stops, of which a cell is 0.4. Values beyond are taken for the nearest.
  static constexpr double kOffset = 0.005, kMost = 32;

  explicit ViewLut(const DisplayView& view);

  /// What the lattice makes of scene-linear Rec.709: display values, not clamped. Alpha is 1.
  [[nodiscard]] Rgba show(const Rgba& linear) const;

  /// In codes of 8 bits, over `points` colours spread evenly in the lattice, a quarter of them grey.
  struct Error {
    double mean = 0, most = 0;
    std::size_t points = 0;
  };
  [[nodiscard]] const Error& error() const { return error_; }

  /// {"size", "offset", "most", "low", "high", "error": {"mean", "most", "points"}, "codes"}: colours are low + code *
  /// (high - low) / 65535, the codes base64 of a zlib stream of: for R, G and B each the differences to the code
  /// before, red running fastest, blue slowest; of all three first the low bytes, then the high ones.
  [[nodiscard]] Json json() const;

 private:
  [[nodiscard]] Error measured(const DisplayView& view) const;

  float low_ = 0, high_ = 1;          // display values, of the codes 0 and 65535
  std::vector<std::uint16_t> codes_;  // [3][kSize][kSize][kSize]: channel, blue, green, red
  Error error_;
};

/// json() of a view's lattice with its "name".
[[nodiscard]] Json view_lut_json(const DisplayView& view);

}  // namespace relook
