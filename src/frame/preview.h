// Previews: 8-bit PNG files of a frame over black, exposed, in sRGB or as a display view says, for looking at, never
// for comparing. Deflated in bands of rows that are kept from step to step, so that a step pays for the bands that it
// changed; by ISA-L, four times as fast as zlib, since this is most of what a small edit's files cost.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "frame/changed_pixels.h"
#include "frame/display_view.h"
#include "frame/frame.h"

namespace relook {

/// NaN becomes black. The bytes depend on the frame and the style alone. Taking pixels is quick, and png() needs no
/// frame: it may run on another thread while the next frame is computed.
class PreviewEncoder {
 public:
  PreviewEncoder(std::uint32_t width, std::uint32_t height, PreviewStyle style = {});

  /// Takes all pixels.
  void update(const Frame& frame);
  /// Takes the pixels that changed since the last update.
  void update(const Frame& frame, const ChangedPixels& changed_pixels);
  /// Deflates the bands of the pixels taken since the last call; the bytes of the file.
  [[nodiscard]] Bytes png();
  /// What was taken: [height * width * 3], row 0 on top.
  [[nodiscard]] std::span<const unsigned char> codes() const { return codes_; }

 private:
  struct Band {
    bool is_stale = true;
    Bytes deflated;              // whole bytes, no reference to other bands
    std::uint32_t checksum = 1;  // Adler-32 of the filtered rows
  };
  /// `count` pixels of a row.
  void take(const Frame& frame, std::uint32_t x, std::uint32_t y, std::uint32_t count);
  [[nodiscard]] std::uint32_t end_row(std::size_t band) const;
  [[nodiscard]] std::vector<unsigned char> filtered_rows(std::size_t band) const;

  std::uint32_t width_, height_;
  std::shared_ptr<const DisplayView> view_;
  float gain_;
  std::vector<unsigned char> codes_;  // [height * width * 3], row 0 on top
  std::vector<Band> bands_;
};

/// Whether a PNG file with this start, 64 bytes at least, is one that this program has written.
[[nodiscard]] bool is_own_preview(std::string_view start);

[[nodiscard]] Bytes encode_png(const Frame& frame, PreviewStyle style = {});

/// What R, G and B are multiplied by.
[[nodiscard]] float gain_of(double exposure);
/// For what is drawn onto a frame before it is encoded without exposure.
void expose(Frame& frame, double exposure);

}  // namespace relook
