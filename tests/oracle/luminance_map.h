// How standard path tracers draw directions to an environment: in proportion to the luminance of its interpolated
// texels times their solid angle.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "reference_tracer.h"

namespace relook {

/// Of a lat-long image as scenes have it, +y up and -z in the middle, unturned.
class LuminanceMap {
 public:
  /// `luminance`: of a texel by column and row, at least 0.
  LuminanceMap(std::uint32_t width, std::uint32_t height,
               const std::function<double(std::uint32_t, std::uint32_t)>& luminance);

  /// Is all of it black, so that nothing may be drawn?
  [[nodiscard]] bool empty() const { return rows_.back() <= 0; }
  /// A unit direction for a point of the unit square.
  [[nodiscard]] Vec draw(double u, double v) const;
  /// Per steradian, of a unit direction; 0 where the map is empty.
  [[nodiscard]] double density(const Vec& way) const;

 private:
  /// The texels around a cell.
  struct Corners {
    double upper_left, upper_right, lower_left, lower_right;
    [[nodiscard]] double mean() const { return (upper_left + upper_right + lower_left + lower_right) / 4; }
  };
  [[nodiscard]] Corners corners(std::size_t column, std::size_t row) const;
  /// Of a row's upper edge, from the top of the image, 0 to 1.
  [[nodiscard]] double edge(std::size_t row) const;
  /// In the middle of a row.
  [[nodiscard]] double sine(std::size_t row) const;

  // Cells between the middles of four texels: column c left of texel c's middle, row r above texel r's. The first and
  // the last row are half as high, and even from top to bottom.
  std::size_t width_, texel_rows_;
  std::vector<double> texels_;   // [texel_rows * width]
  std::vector<double> columns_;  // [(texel_rows + 1) * (width + 1)]: sums of luminance from the left
  std::vector<double> rows_;     // [texel_rows + 2]: sums of luminance times solid angle from the top
};

}  // namespace relook
