#include "luminance_map.h"

#include <algorithm>
#include <cmath>

#include "pi.h"

namespace relook {
namespace {

struct Cell {
  std::size_t number;
  double rest;  // [0, 1]
};
/// Where `share` of the last of some increasing sums lies.
Cell cell_in(const double* sums, std::size_t cells, double share) {
  const double at = share * sums[cells];
  const auto above = static_cast<std::size_t>(std::upper_bound(sums, sums + cells + 1, at) - sums);
  const std::size_t number = std::clamp<std::size_t>(above, 1, cells) - 1;
  const double width = sums[number + 1] - sums[number];
  return {number, width > 0 ? std::clamp((at - sums[number]) / width, 0.0, 1.0) : 0};
}

double mixed(double a, double b, double share) { return a + (b - a) * share; }
/// In [0, 1], with a density that runs from `a` to `b`.
double linear_place(double a, double b, double u) {
  const double sum = a + std::sqrt(mixed(a * a, b * b, u));
  return sum > 0 ? std::min(u * (a + b) / sum, 1.0) : u;
}

}  // namespace

LuminanceMap::LuminanceMap(std::uint32_t width, std::uint32_t height,
                           const std::function<double(std::uint32_t, std::uint32_t)>& luminance)
    : width_(width), texel_rows_(height), rows_(1, 0.0) {
  for (std::uint32_t row = 0; row < height; ++row)
    for (std::uint32_t column = 0; column < width; ++column) texels_.push_back(luminance(column, row));
  for (std::size_t row = 0; row <= height; ++row) {
    double sum = 0;
    columns_.push_back(0);
    for (std::size_t column = 0; column < width; ++column) columns_.push_back(sum += corners(column, row).mean());
    const double solid_angle = 2 * kPi * kPi * sine(row) * (edge(row + 1) - edge(row)) / width;
    rows_.push_back(rows_.back() + sum * solid_angle);
  }
}

double LuminanceMap::edge(std::size_t row) const {
  return std::clamp((static_cast<double>(row) - 0.5) / static_cast<double>(texel_rows_), 0.0, 1.0);
}

double LuminanceMap::sine(std::size_t row) const { return std::sin(kPi * (edge(row) + edge(row + 1)) / 2); }

LuminanceMap::Corners LuminanceMap::corners(std::size_t column, std::size_t row) const {
  const std::size_t left = (column + width_ - 1) % width_;
  const double* upper = &texels_[(row > 0 ? row - 1 : 0) * width_];
  const double* lower = &texels_[std::min(row, texel_rows_ - 1) * width_];
  return {upper[left], upper[column], lower[left], lower[column]};
}

Vec LuminanceMap::draw(double u, double v) const {
  const Cell row = cell_in(rows_.data(), texel_rows_ + 1, v);
  const Cell column = cell_in(&columns_[row.number * (width_ + 1)], width_, u);
  const Corners c = corners(column.number, row.number);
  const double down = linear_place(c.upper_left + c.upper_right, c.lower_left + c.lower_right, row.rest);
  const double right =
      linear_place(mixed(c.upper_left, c.lower_left, down), mixed(c.upper_right, c.lower_right, down), column.rest);
  const double turn =
      2 * kPi * ((static_cast<double>(column.number) - 0.5 + right) / static_cast<double>(width_) - 0.5);
  const double tilt = kPi * mixed(edge(row.number), edge(row.number + 1), down);
  return {std::sin(tilt) * std::sin(turn), std::cos(tilt), -std::sin(tilt) * std::cos(turn)};
}

double LuminanceMap::density(const Vec& way) const {
  if (empty()) return 0;
  const double tilt = std::acos(std::clamp(way.y, -1.0, 1.0));
  const double across = (0.5 + std::atan2(way.x, -way.z) / (2 * kPi)) * static_cast<double>(width_) + 0.5;
  const auto row = std::min(static_cast<std::size_t>(tilt / kPi * static_cast<double>(texel_rows_) + 0.5), texel_rows_);
  const Corners c = corners(static_cast<std::size_t>(across) % width_, row);
  const double right = across - std::floor(across), down = (tilt / kPi - edge(row)) / (edge(row + 1) - edge(row));
  const double luminance = mixed(mixed(c.upper_left, c.upper_right, right), mixed(c.lower_left, c.lower_right, right),
                                 std::clamp(down, 0.0, 1.0));
  return luminance * sine(row) / (std::max(std::sin(tilt), 1e-9) * rows_.back());
}

}  // namespace relook
