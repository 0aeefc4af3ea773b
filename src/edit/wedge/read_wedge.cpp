#include "edit/wedge/read_wedge.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "edit/growth.h"
#include "edit/journal.h"

namespace relook {
namespace {

constexpr double kLargestOfRange = 1e30;
constexpr std::size_t kMostNumbers = 16;  // of one value: a matrix
constexpr std::int64_t kMostCount = 1'000'000'000'000;

/// `is_log`: the ratio of two of them is taken.
void require_range_value(const JsonView& value, bool is_log) {
  constexpr double kSmallestOfRatio = 1e-30;
  (void)value.number(is_log ? kSmallestOfRatio : -kLargestOfRange, kLargestOfRange);
}

/// How many values a range has by its step.
std::size_t count_by_step(const JsonView& range, const WedgeAxis& axis) {
  const JsonView step = range.at("step");
  const double from = axis.from.get<double>(), to = axis.to.get<double>();
  const bool is_log = axis.scale == RangeScale::log;
  if (is_log ? axis.step == 1 : axis.step == 0) step.fail(is_log ? "a step of a log range is a factor, and 1 leads nowhere" : "it leads nowhere");
  const double steps = is_log ? std::log(to / from) / std::log(axis.step) : (to - from) / axis.step;
  if (steps < 0) step.fail("it leads away from \"to\"");
  constexpr double kRounding = 1e-9;  // 0, 0.1, ... 1 ends at 1
  const double count = std::floor(steps * (1 + kRounding) + kRounding) + 1;
  if (count > static_cast<double>(kMostCount)) step.fail("it is too small: the range has too many values");
  return static_cast<std::size_t>(count);
}

RangeScale read_scale(const JsonView& range) {
  constexpr std::array<std::string_view, 3> kScales{"linear", "log", "step"};
  if (!range.has("scale")) return RangeScale::linear;
  const std::size_t scale = range.at("scale").one_of(kScales);
  if (scale == 2 && !range.has("step")) range.fail("a range of scale \"step\" has a \"step\"");
  return scale == 1 ? RangeScale::log : RangeScale::linear;
}

void read_range(const JsonView& range, WedgeAxis& axis) {
  constexpr std::array<std::string_view, 5> kKeys{"from", "to", "count", "step", "scale"};
  range.only_keys(kKeys);
  const JsonView from = range.at("from"), to = range.at("to");
  if (range.has("count") == range.has("step")) range.fail("a range has either \"count\" or \"step\"");
  axis.scale = read_scale(range);
  const bool is_log = axis.scale == RangeScale::log;
  if (from.value().is_array()) {
    to.require_array();
    if (from.size() > kMostNumbers) from.fail("expected at most " + std::to_string(kMostNumbers) + " numbers");
    if (to.size() != from.size()) to.fail("expected as many numbers as in \"from\"");
    for (std::size_t k = 0; k < from.size(); ++k) {
      require_range_value(from.at(k), is_log);
      require_range_value(to.at(k), is_log);
    }
  } else {
    require_range_value(from, is_log);
    require_range_value(to, is_log);
  }
  axis.from = from.value();
  axis.to = to.value();
  if (range.has("count")) {
    axis.count = static_cast<std::size_t>(range.at("count").integer(2, kMostCount));
    return;
  }
  if (!axis.from.is_number()) range.at("step").fail("a range of several numbers has \"count\"");
  axis.step = range.at("step").number(is_log ? 1e-6 : -kLargestOfRange, kLargestOfRange);
  axis.count = count_by_step(range, axis);
}

std::vector<std::string> read_labels(const JsonView& labels, std::size_t values) {
  labels.require_array();
  if (labels.size() != values) labels.fail("expected as many texts as there are values, " + std::to_string(values));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < labels.size(); ++i) texts.push_back(labels.at(i).text());
  return texts;
}

WedgeAxis read_axis(const JsonView& view) {
  constexpr std::array<std::string_view, 5> kKeys{"path", "values", "range", "label", "labels"};
  view.only_keys(kKeys);
  if (view.has("values") == view.has("range")) view.fail("a wedge has either \"values\" or \"range\"");
  WedgeAxis axis;
  axis.path = read_pointer(view.at("path"));
  axis.where = view.pointer();
  if (view.has("label")) axis.label = view.at("label").text();
  if (view.has("range")) {
    read_range(view.at("range"), axis);
  } else {
    const JsonView list = view.at("values");
    list.require_array();
    if (list.size() == 0) list.fail("expected at least one value");
    axis.count = list.size();
    axis.values = list.value().get_ref<const Json::array_t&>();
  }
  if (view.has("labels")) axis.labels = read_labels(view.at("labels"), axis.count);
  return axis;
}

/// Where the number of an axis' values is written.
JsonView place_of_count(const JsonView& axis) {
  if (axis.has("values")) return axis.at("values");
  const JsonView range = axis.at("range");
  return range.at(range.has("count") ? "count" : "step");
}

}  // namespace

void FrameCount::add(std::size_t frames, const JsonView& place) {
  if (frames > kMostFrames - frames_)
    throw JournalLimitError(
        place.file(), place.pointer(),
        "with this the journal has more than " + std::to_string(kMostFrames) + " frames, the most that one may have");
  frames_ += frames;
}

std::string read_pointer(const JsonView& view) {
  std::string pointer = view.text();
  if (!pointer.empty()) (void)split_pointer(pointer, view.file(), view.pointer());
  return pointer;
}

Wedge read_wedge(const JsonView& view, FrameCount& frames) {
  constexpr std::size_t kMostAxes = 2;
  Wedge wedge;
  if (!view.value().is_array()) {
    wedge.axes.push_back(read_axis(view));
    frames.add(wedge.axes[0].count, place_of_count(view));
    return wedge;
  }
  if (view.size() == 0 || view.size() > kMostAxes) view.fail("expected one wedge, or two for a grid");
  for (std::size_t i = 0; i < view.size(); ++i) {
    wedge.axes.push_back(read_axis(view.at(i)));
    // Each alone is too much already when their product would not fit a number.
    FrameCount(frames).add(wedge.axes[i].count, place_of_count(view.at(i)));
  }
  if (wedge.axes.size() > 1 && wedge.axes[0].path == wedge.axes[1].path)
    view.at(1).at("path").fail("both wedges of a grid are of this parameter");
  frames.add(wedge.size(), view);
  return wedge;
}

}  // namespace relook
