#include "compare_inputs.h"

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "engine/frame_file.h"

namespace relook {
namespace {

std::set<std::string> exr_files(const std::filesystem::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".exr") names.insert(entry.path().filename().string());
  return names;
}

void add_frame(PairComparison& pair, std::string name, FrameComparison comparison) {
  pair.total += comparison.difference;
  pair.verdict = std::max(pair.verdict, comparison.verdict);
  pair.frames.emplace_back(std::move(name), std::move(comparison));
}

FrameComparison compare_two(const std::filesystem::path& a, const std::filesystem::path& b,
                            const Arguments& arguments) {
  const Frame first = decode_exr(a), second = decode_exr(b);
  if (first.width != second.width || first.height != second.height)
    throw InputError(b.string(), "",
                     std::to_string(second.width) + "x" + std::to_string(second.height) + " pixels, not the " +
                         std::to_string(first.width) + "x" + std::to_string(first.height) + " of " + a.string());
  return compare_closely(first, second, arguments.thresholds, !arguments.exact_only);
}

}  // namespace

FrameFolder frame_folder(const std::filesystem::path& path) {
  FrameFolder run{path / "frames", exr_files(path / "frames")};
  if (!run.names.empty()) return run;
  FrameFolder plain{path, exr_files(path)};
  if (plain.names.empty()) throw InputError(path.string(), "frames", "no frames: not a run");
  return plain;
}

PairComparison compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const Arguments& arguments) {
  PairComparison pair;
  add_frame(pair, b.filename().string(), compare_two(a, b, arguments));
  return pair;
}

PairComparison compare_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                               const Arguments& arguments, Console& console) {
  const FrameFolder first = frame_folder(a), second = frame_folder(b);
  PairComparison pair;
  std::ranges::set_symmetric_difference(first.names, second.names, std::back_inserter(pair.missing));
  if (!pair.missing.empty()) pair.verdict = Verdict::failure;
  const Progress progress = console.stage("compare");
  double done = 0;
  for (const std::string& name : first.names) {
    progress(done++ / static_cast<double>(first.names.size()));
    if (second.names.contains(name))
      add_frame(pair, name, compare_two(first.folder / name, second.folder / name, arguments));
  }
  console.end_stage();
  return pair;
}

}  // namespace relook
