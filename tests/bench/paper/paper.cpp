#include "paper.h"

#include <algorithm>

namespace relook::paper {
namespace {

constexpr std::array<Look, 5> kLooks{Look{"leaves color left tree", 1.5, 1.1, {4.65, 4.45, 1.26, 1.26}, 0.28, 0.23},
                                     {"highlight left sphere", 1.5, 1.1, {0.94, 0.66, 0.52, 0.52}, 0.12, 0.09},
                                     {"marble color on Beethoven", 1.91, 1.43, {8.36, 7.78, 5.09, 4.91}, 0.35, 0.32},
                                     {"ground color", 2.17, 1.59, {7.60, 7.28, 4.50, 2.49}, 0.47, 0.44},
                                     {"index of refraction", 1.53, 1.12, {8.55, 8.51, 8.47, 8.47}, 0, 0}};

// In the text at hand the cells below the first geometric row are scattered: they make up one more row (a removing and
// six times three times) for two names. Here they are those of "flying furthest tree": they are the last ones, and
// removing takes a quarter of what it takes for the central sphere, as a small thing far away would. Those of "move
// refractive sphere" are lost.
constexpr std::array<Move, 2> kMoves{Move{"transform central sphere",
                                          51.0,
                                          {{{37.8, 8.8, 7.8}, {82.9, 11.4, 7.8}, {88.8, 16.2, 12.4}}},
                                          {{{38.4, 13.3, 12.2}, {79.2, 13.3, 12.3}, {85.0, 17.0, 14.5}}}},
                                     {"flying furthest tree",
                                      12.6,
                                      {{{39.4, 6.0, 5.7}, {85.6, 6.2, 5.7}, {90.5, 6.9, 6.4}}},
                                      {{{38.5, 16.0, 13.8}, {76.0, 16.0, 13.8}, {80.5, 22.0, 19.0}}}}};

template <class Row, std::size_t N>
Row find(const std::array<Row, N>& rows, std::string_view step) {
  const auto found = std::ranges::find(rows, step, &Row::step);
  return found == rows.end() ? Row{step} : *found;
}

}  // namespace

Look look(std::string_view step) { return find(kLooks, step); }
Move move(std::string_view step) { return find(kMoves, step); }

}  // namespace relook::paper
