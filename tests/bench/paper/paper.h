// Tables 2 and 3 of Brière & Poulin 1996: their complex scene (Figure 4) at 256x256, one sample a pixel.
#pragma once
#include <array>
#include <string_view>

namespace relook::paper {

inline constexpr double kFullSeconds = 640, kPreprocessSeconds = 1100;
inline constexpr double kSamples = 256.0 * 256.0;

/// Table 2; 0: the paper gives none.
struct Pieces {
  double number = 0, megabytes = 0;
};
inline constexpr Pieces kColorTrees{66000, 20.5}, kRayPaths{5300, 0}, kGroups{12100, 0}, kRayTrees{66000, 3.7},
    kTunnels{10900, 4.3};

/// A colour or optical row of Table 3, seconds; 0: the paper gives none.
struct Look {
  std::string_view step;
  double without_groups = 0, with_groups = 0;  // selection-dependent preprocessing
  std::array<double, 4> by_ray_trees{};        // only ray paths; 1 %, 10 %, all ray trees
  double color_trees = 0, compressed = 0;
};

using ByTunnels = std::array<double, 3>;  // 0, 1, 2 a region
/// A geometric row, seconds; 0: the paper, or the text of it at hand, gives none.
struct Move {
  std::string_view step;
  double removing = 0;
  std::array<ByTunnels, 3> rendering{}, adding{};  // all, 10 %, 1 % ray trees
};

/// The row of a step; all 0 if the table has none of this name.
[[nodiscard]] Look look(std::string_view step);
[[nodiscard]] Move move(std::string_view step);

}  // namespace relook::paper
