// What `relook compare` is given: single frames, or folders of frames, each compared with the first.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "compare/frame_comparison.h"
#include "terminal/console.h"

namespace relook {

inline constexpr std::size_t kMostPictures = 24;
inline constexpr std::size_t kMostPixelBytes = 64'000'000;  // of them, of a pair

/// Frames by name in one folder: that of a run, or any folder with .exr files.
struct FrameFolder {
  std::filesystem::path folder;
  std::set<std::string> names;
};
/// Throws InputError when there is no frame.
[[nodiscard]] FrameFolder frame_folder(const std::filesystem::path& path);

/// PNG files of two frames that differ, and of where: FLIP's errors from black (0) over red and yellow to white (1);
/// without FLIP, the pixels that differ in white.
struct Pictures {
  Bytes a, b, errors;
  Bytes pixels_a, pixels_b;  // as frames (frame_file.h), in one format that holds both exactly; empty: no room
  std::uint32_t width = 0, height = 0;
  double badness = 0;  // how far apart they are: mean FLIP or, without, the largest error
};

struct PairComparison {
  std::vector<std::pair<std::string, FrameComparison>> frames;  // by name, without flip_errors
  std::map<std::string, Pictures> pictures;                     // by name, of the kMostPictures that differ most
  std::vector<std::string> missing;                             // in one of the two folders only
  FrameDifference total;                                        // of the frames' own figures
  std::size_t layers_different = 0;                             // of all frames
  Verdict verdict = Verdict::equal;                             // the worst of all frames; failure when one is missing
};

/// Throws InputError for files that are no frames, or frames of two sizes.
[[nodiscard]] PairComparison compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                                           const Arguments& arguments);
[[nodiscard]] PairComparison compare_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                                             const Arguments& arguments, Console& console);

}  // namespace relook
