#include "input/compare_inputs.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "base/error.h"
#include "compare/file_comparison.h"
#include "compare_text.h"
#include "frame/frame_file.h"
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
  return {encode_png(a, {nullptr, exposure}),
          encode_png(b, {nullptr, exposure}),
          encode_png(errors),
          {},
          {},
          a.width,
          a.height,
          0};
}

bool are_halves(const Frame& frame) {
  const auto is_half = [](float value) { return std::isnan(value) || stored_value(value, PixelFormat::half) == value; };
  return std::ranges::all_of(
      frame.pixels, [&](const Rgba& p) { return is_half(p.r) && is_half(p.g) && is_half(p.b) && is_half(p.a); });
}

double badness_of(const FrameComparison& comparison) {
  const double value = comparison.flip ? comparison.flip->mean : comparison.difference.max_error;
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

/// Keeps the pictures of two frames while they are among those that differ most.
void keep_pictures(const std::string& name, const FileComparison& files, double exposure, PairComparison& pair) {
  const double badness = badness_of(files.comparison);
  const auto least =
      std::ranges::min_element(pair.pictures, {}, [](const auto& entry) { return entry.second.badness; });
  if (pair.pictures.size() >= kMostPictures) {
    if (badness <= least->second.badness) return;
    pair.pictures.erase(least);
  }
  Pictures pictures = pictures_of(files.a, files.b, files.comparison, exposure);
  pictures.badness = badness;
  const PixelFormat format = are_halves(files.a) && are_halves(files.b) ? PixelFormat::half : PixelFormat::float32;
  pictures.pixels_a = encode_exr(files.a, {}, format);
  pictures.pixels_b = encode_exr(files.b, {}, format);
  pair.pictures[name] = std::move(pictures);
  // Those that differ least lose their pixels first.
  for (;;) {
    std::size_t bytes = 0;
    Pictures* mildest = nullptr;
    for (auto& [other, kept] : pair.pictures) {
      bytes += kept.pixels_a.size() + kept.pixels_b.size();
      if (!kept.pixels_a.empty() && (mildest == nullptr || kept.badness < mildest->badness)) mildest = &kept;
    }
    if (bytes <= kMostPixelBytes || mildest == nullptr) return;
    mildest->pixels_a = mildest->pixels_b = {};
  }
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
  if (has_page && files.comparison.worst) keep_pictures(name, files, arguments.exposure, pair);
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
