// Frames as OpenEXR files (frame/exr_tiles.h): R,G,B,A. The bytes are the same in every run: no dates, no names of
// hosts. Compressed tiles are kept from step to step, so that a step pays for the tiles that it changed.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/files.h"
#include "frame/changed_pixels.h"
#include "frame/exr_tiles.h"
#include "frame/frame.h"

namespace relook {

/// What a frame's header says of its origin: the string attributes relook:scene, relook:edits and so on. Empty ones are
/// left out.
struct FrameMeta {
  std::string scene_hash;
  std::string edits_hash;    // of the edits up to this frame (report/edit_hashes.h)
  std::string step;          // "3", "3_01"
  std::string change_class;  // change_class_name()
  std::string exposure;      // exposure_text(): how its previews are exposed; the frame is not
  std::string name;          // of the step
  std::string edit;          // the JSON Patch that led here from the frame before, or from where its step starts
  std::string values;        // of a wedge, as in report.json
  std::string note, author, extras;  // as the journal has them; extras as JSON
  bool operator==(const FrameMeta&) const = default;
};
/// The attribute of each member.
inline constexpr std::array<std::pair<std::string_view, std::string FrameMeta::*>, 11> kFrameAttributes{
    {{"relook:scene", &FrameMeta::scene_hash},
     {"relook:edits", &FrameMeta::edits_hash},
     {"relook:step", &FrameMeta::step},
     {"relook:class", &FrameMeta::change_class},
     {"relook:exposure", &FrameMeta::exposure},
     {"relook:name", &FrameMeta::name},
     {"relook:edit", &FrameMeta::edit},
     {"relook:values", &FrameMeta::values},
     {"relook:note", &FrameMeta::note},
     {"relook:author", &FrameMeta::author},
     {"relook:extras", &FrameMeta::extras}}};
/// Stops, as few digits as tell them: "-2.5". "" for none.
[[nodiscard]] std::string exposure_text(double exposure);
[[nodiscard]] ExrAttributes frame_attributes(const FrameMeta& meta);

/// The compressed tiles of one frame. Taking pixels is quick, and exr() needs no frame: it may run on another thread
/// while the next frame is computed.
class FrameEncoder {
 public:
  FrameEncoder(std::uint32_t width, std::uint32_t height, PixelFormat format);

  /// Takes all tiles.
  void update(const Frame& frame);
  /// Takes the tiles of the pixels that changed since the last update.
  void update(const Frame& frame, const ChangedPixels& changed_pixels);
  /// Compresses the tiles taken since the last call; the bytes of the file.
  [[nodiscard]] Bytes exr(const FrameMeta& meta);
  /// Pixels of the frame last taken of which a half cannot hold a finite value; 0 with float32.
  [[nodiscard]] std::uint64_t clipped_pixels() const;

 private:
  void take(const Frame& frame, std::span<const std::uint32_t> tiles);
  void compress_taken();

  std::uint32_t width_, height_;
  PixelFormat format_;
  std::vector<std::vector<unsigned char>> taken_;  // [tile_count], uncompressed; empty when the chunk is up to date
  std::vector<Bytes> chunks_;                      // [tile_count]
  std::vector<std::uint32_t> clipped_;             // [tile_count], pixels
};

/// Pixels of which a half cannot hold a finite value.
[[nodiscard]] std::uint64_t clipped_pixels(const Frame& frame);
/// "12 pixels are beyond half's range (65504); --float keeps them"
[[nodiscard]] std::string clipping_sentence(std::uint64_t pixels);

[[nodiscard]] Bytes encode_exr(const Frame& frame, const FrameMeta& meta, PixelFormat format);

/// Whether a file is a frame as this program writes them: these attributes and no others, so that what a painting or
/// compositing program has saved under the name of a frame is told apart.
[[nodiscard]] bool is_own_frame(const std::filesystem::path& path);
/// What such a file's header says of its origin; none if it is no frame of this program.
[[nodiscard]] std::optional<FrameMeta> own_frame_meta(const std::filesystem::path& path);

/// Reads R, G, B and A (1 if missing) of any OpenEXR image, flat, half or float. Throws InputError.
[[nodiscard]] Frame decode_exr(const std::filesystem::path& path);
[[nodiscard]] Frame decode_exr(BytesView bytes, std::string_view file);

}  // namespace relook
