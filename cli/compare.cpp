#include "engine/compare.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <set>
#include <utility>

#include "engine/frame_file.h"
#include "verbs.h"

namespace relook {
namespace {

struct Comparison {
  FrameDifference total;
  std::vector<std::pair<std::string, FrameDifference>> frames;  // by name
  std::vector<std::string> missing;                             // in one of the two runs only
};

FrameDifference compare_files(const std::filesystem::path& a, const std::filesystem::path& b) {
  const Frame first = decode_exr(a), second = decode_exr(b);
  if (first.width != second.width || first.height != second.height)
    throw InputError(b.string(), "",
                     std::to_string(second.width) + "x" + std::to_string(second.height) + " pixels, not the " +
                         std::to_string(first.width) + "x" + std::to_string(first.height) + " of " + a.string());
  return compare_frames(first, second);
}

std::set<std::string> frame_files(const std::filesystem::path& run) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(run / "frames", error))
    if (entry.path().extension() == ".exr") names.insert(entry.path().filename().string());
  if (error || names.empty()) throw InputError(run.string(), "frames", "no frames: not a run");
  return names;
}

Comparison compare_runs(const std::filesystem::path& a, const std::filesystem::path& b, Console& console) {
  const std::set<std::string> first = frame_files(a), second = frame_files(b);
  Comparison comparison;
  std::set_symmetric_difference(first.begin(), first.end(), second.begin(), second.end(),
                                std::back_inserter(comparison.missing));
  const Progress progress = console.stage("compare");
  double done = 0;
  for (const std::string& name : first) {
    progress(done++ / static_cast<double>(first.size()));
    if (!second.contains(name)) continue;
    comparison.frames.emplace_back(name, compare_files(a / "frames" / name, b / "frames" / name));
    comparison.total += comparison.frames.back().second;
  }
  console.end_stage();
  return comparison;
}

std::string short_number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.4g", value);
  return digits;
}

std::string text(const std::string& name, const FrameDifference& difference) {
  return name + ": " + std::to_string(difference.pixels_different) + " of " +
         std::to_string(difference.pixels_compared) + " pixels differ, max error " +
         short_number(difference.max_error) + ", RMS error " + short_number(difference.rms_error);
}

Json comparison_json(const Arguments& arguments, const Comparison& comparison) {
  Json frames = Json::object();
  for (const auto& [name, difference] : comparison.frames) frames[printable(name)] = difference_json(difference);
  Json missing = Json::array();
  for (const std::string& name : comparison.missing) missing.push_back(printable(name));
  return {{"a", arguments.inputs[0]},
          {"b", arguments.inputs[1]},
          {"total", difference_json(comparison.total)},
          {"frames", std::move(frames)},
          {"missing", std::move(missing)}};
}

}  // namespace

ExitCode run_compare(const Arguments& arguments, Console& console) {
  const std::filesystem::path a = arguments.inputs[0], b = arguments.inputs[1];
  std::error_code error;
  const bool are_runs = std::filesystem::is_directory(a, error);
  if (are_runs != std::filesystem::is_directory(b, error))
    throw InputError((are_runs ? b : a).string(), "", "not a run folder: two frames or two runs are compared");
  Comparison comparison;
  if (are_runs) {
    comparison = compare_runs(a, b, console);
  } else {
    comparison.total = compare_files(a, b);
    comparison.frames.emplace_back(b.filename().string(), comparison.total);
  }
  for (const std::string& name : comparison.missing) console.line(printable(name) + ": in one run only");
  for (const auto& [name, difference] : comparison.frames) console.line(text(printable(name), difference));
  if (are_runs) console.line(text("total", comparison.total));
  const Json result = comparison_json(arguments, comparison);
  console.json(result);
  if (!arguments.output.empty()) {
    make_folders(arguments.output);
    write_file(std::filesystem::path(arguments.output) / "compare.json", result.dump(2) + "\n");
  }
  const bool is_equal = comparison.total.pixels_different == 0 && comparison.missing.empty();
  return is_equal ? ExitCode::ok : ExitCode::difference;
}

}  // namespace relook
