#include "edit/frame_place.h"

#include <algorithm>
#include <cstdio>

namespace relook {
namespace {

std::string numbered(const char* folder, const FramePlace& place, const char* suffix) {
  char step[32];
  std::snprintf(step, sizeof step, "%04u", place.step);
  const std::string label = step_label(place);
  const std::size_t within = label.find('_');
  return std::string(folder) + "/" + step + (within == std::string::npos ? "" : label.substr(within)) + suffix;
}

}  // namespace

std::string step_label(const FramePlace& place) {
  std::string label = std::to_string(place.step);
  if (!place.number) return label;
  const std::string digits = std::to_string(*place.number);
  const std::size_t width = std::max<std::size_t>(2, std::to_string(place.count).size());
  return label + "_" + std::string(width - std::min(width, digits.size()), '0') + digits;
}

std::string frame_name(const FramePlace& place) { return numbered("frames", place, ".exr"); }
std::string preview_name(const FramePlace& place) { return numbered("previews", place, ".png"); }
std::string relight_name(const FramePlace& place) { return numbered("relight", place, ".exr"); }

}  // namespace relook
