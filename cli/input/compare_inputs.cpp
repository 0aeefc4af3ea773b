#include "input/compare_inputs.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "base/error.h"
#include "compare/file_comparison.h"
#include "compare_text.h"
#include "frame/preview.h"

namespace relook {
namespace {

std::set<std::string> exr_files(const std::filesystem::path& folder) {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".exr") names.insert(entry.path().filename().string());
  return names;
}

Pictures pictures_of(const Frame& a, const Frame& b, const FrameComparison& comparison, double exposure) {
  Frame errors = a;
  for (std::size_t i = 0; i < errors.pixels.size(); ++i) {
    float error = std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(Rgba)) == 0 ? 0.0F : 1.0F;
    if (!comparison.flip_errors.empty()) error = comparison.flip_errors[i];
    errors.pixels[i] = Rgba(3 * error, 3 * error - 1, 3 * error - 2, 1);
  }
  return {encode_png(a, {nullptr, exposure}), encode_png(b, {nullptr, exposure}), encode_png(errors)};
}

FileComparison compared_files(const std::filesystem::path& a, const std::filesystem::path& b,
                              const Arguments& arguments) {
  const ExrFile first(read_file(a), a.string()), second(read_file(b), b.string());
  return compare_exr_files(first, second, arguments.thresholds,
                           arguments.exact_only ? std::nullopt : std::optional(arguments.white));
}

void add_frame(PairComparison& pair, std::string name, FrameComparison comparison) {
  comparison.flip_errors = {};
  pair.total += comparison.difference;
  pair.layers_different += layers_different(comparison);
  pair.verdict = std::max(pair.verdict, comparison.verdict);
  pair.frames.emplace_back(std::move(name), std::move(comparison));
}

void compare_two(const std::string& name, const std::filesystem::path& a, const std::filesystem::path& b,
                 const Arguments& arguments, PairComparison& pair) {
  FileComparison files = compared_files(a, b, arguments);
  const bool has_page = !arguments.html.empty() || !arguments.output.empty();
  if (has_page && files.comparison.worst && pair.pictures.size() < kMostPictures)
    pair.pictures[name] = pictures_of(files.a, files.b, files.comparison, arguments.exposure);
  add_frame(pair, name, std::move(files.comparison));
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
  compare_two(b.filename().string(), a, b, arguments, pair);
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
    if (second.names.contains(name)) compare_two(name, first.folder / name, second.folder / name, arguments, pair);
  }
  console.end_stage();
  return pair;
}

}  // namespace relook
