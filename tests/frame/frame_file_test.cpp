// Frames on disk: what is written is read back exactly, the bytes are the same in every run and however the frame came
// about, and damaged or foreign files are refused.
#include "frame/frame_file.h"

#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "compare/compare.h"
#include "frame/half_bits.h"
#include "frame/preview.h"
#include "run_program.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {
namespace {

constexpr std::uint32_t kWidth = 150, kHeight = 70;  // 3 x 2 tiles, clipped right and below

Frame gradient_frame() {
  Frame frame{kWidth, kHeight, {}};
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x)
      frame.pixels.emplace_back(static_cast<float>(x) / kWidth, static_cast<float>(y) / kHeight,
                                std::sin(static_cast<float>(x * y)), 1.0F);
  return frame;
}

const FrameMeta kMeta{"scene-hash", "edits-hash", "3_01", "optical", "-2.5", "try", "[]", "[1]", "a note", "Ada", "{}"};

TEST(FrameFile, float_frames_come_back_bit_for_bit) {
  const Frame frame = gradient_frame();
  const Frame back = decode_exr(encode_exr(frame, kMeta, PixelFormat::float32), "frame");
  ASSERT_EQ(back.width, kWidth);
  ASSERT_EQ(back.height, kHeight);
  EXPECT_EQ(compare_frames(frame, back).pixels_different, 0U);
}

TEST(FrameFile, half_frames_round_to_nearest) {
  const Frame frame = gradient_frame();
  const Frame back = decode_exr(encode_exr(frame, kMeta, PixelFormat::half), "frame");
  EXPECT_GT(compare_frames(frame, back).pixels_different, 0U);
  EXPECT_LE(compare_frames(frame, back).max_error, 1.0 / 4096);  // half an ulp below 1
}

TEST(FrameFile, half_bits_are_those_of_openexr) {
  constexpr std::uint32_t kStep = 997;  // all exponents and signs, ties and not
  for (std::uint64_t i = 0; i < std::uint64_t{1} << 32; i += kStep) {
    for (const auto bits : {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i) & 0xFFFFF000}) {
      const auto value = std::bit_cast<float>(bits);
      const float clamped = std::isfinite(value) ? std::clamp(value, -65504.0F, 65504.0F) : value;
      ASSERT_EQ(half_bits(value), half(clamped).bits()) << bits;
    }
  }
}

TEST(FrameFile, half_clamps_finite_values_and_keeps_the_others) {
  Frame frame{2, 1, {Rgba(1e6F, -1e6F, 65519.0F, 1), Rgba(INFINITY, -INFINITY, NAN, 0)}};
  const Frame back = decode_exr(encode_exr(frame, {}, PixelFormat::half), "frame");
  EXPECT_EQ(back.pixels[0], Rgba(65504, -65504, 65504, 1));
  EXPECT_EQ(back.pixels[1].r, INFINITY);
  EXPECT_EQ(back.pixels[1].g, -INFINITY);
  EXPECT_TRUE(std::isnan(back.pixels[1].b));
}

TEST(FrameFile, pixels_beyond_half_are_counted_tile_by_tile) {
  Frame frame = gradient_frame();
  EXPECT_EQ(clipped_pixels(frame), 0U);
  frame.pixels[0] = Rgba(1e5F, -1e9F, 0, 1);
  frame.pixels[1] = Rgba(65504, -65504, INFINITY, NAN);
  frame.pixels[149] = Rgba(0, 0, 65505, 1);
  frame.pixels[kWidth * 69 + 149] = Rgba(0, -1e5F, 0, 1);
  FrameEncoder encoder(kWidth, kHeight, PixelFormat::half);
  encoder.update(frame);
  EXPECT_EQ(clipped_pixels(frame), 3U);
  EXPECT_EQ(encoder.clipped_pixels(), 3U);
  const std::vector<std::uint32_t> changed{0, kWidth * 69 + 3};
  frame.pixels[changed[0]] = frame.pixels[149] = Rgba(1, 1, 1, 1);  // 149: another tile, not announced
  frame.pixels[changed[1]] = Rgba(1, 1, 7e4F, 1);
  encoder.update(frame, ChangedPixels(changed, kWidth));
  EXPECT_EQ(encoder.clipped_pixels(), 3U);
  encoder.update(frame);
  EXPECT_EQ(encoder.clipped_pixels(), 2U);
  FrameEncoder whole(kWidth, kHeight, PixelFormat::float32);
  whole.update(frame);
  EXPECT_EQ(whole.clipped_pixels(), 0U);
}

TEST(FrameFile, bytes_depend_on_nothing_but_frame_and_meta) {
  const Frame frame = gradient_frame();
  set_thread_count(1);
  const Bytes one = encode_exr(frame, kMeta, PixelFormat::half);
  set_thread_count(0);
  EXPECT_EQ(one, encode_exr(frame, kMeta, PixelFormat::half));
  FrameMeta other = kMeta;
  other.step = "4";
  EXPECT_NE(one, encode_exr(frame, other, PixelFormat::half));
}

TEST(FrameFile, updated_tiles_give_the_bytes_of_a_fresh_encoding) {
  Frame frame = gradient_frame();
  FrameEncoder encoder(kWidth, kHeight, PixelFormat::half);
  encoder.update(frame);
  const std::vector<std::uint32_t> changed{5, 63, 64, kWidth * 69 + 149};
  for (const std::uint32_t pixel : changed) frame.pixels[pixel] = Rgba(9, 9, 9, 1);
  encoder.update(frame, ChangedPixels(changed, kWidth));
  EXPECT_EQ(encoder.exr(kMeta), encode_exr(frame, kMeta, PixelFormat::half));
}

TEST(FrameFile, unchanged_tiles_are_not_encoded_again) {
  Frame frame = gradient_frame();
  FrameEncoder encoder(kWidth, kHeight, PixelFormat::half);
  encoder.update(frame);
  const Bytes before = encoder.exr(kMeta);
  frame.pixels[149].r = 7;  // in the third tile, not announced
  encoder.update(frame, ChangedPixels(std::vector<std::uint32_t>{0}, kWidth));
  EXPECT_EQ(encoder.exr(kMeta), before);
}

TEST(FrameFile, header_names_scene_journal_step_and_class) {
  const Bytes bytes = encode_exr(gradient_frame(), kMeta, PixelFormat::half);
  const std::string_view text = text_of(bytes);
  for (const char* expected : {"relook:scene", "scene-hash", "relook:edits", "edits-hash", "relook:step", "3_01",
                               "relook:class", "optical", "chromaticities", "tiles"})
    EXPECT_NE(text.find(expected), std::string_view::npos) << expected;
  EXPECT_EQ(text.find("capDate"), std::string_view::npos);
}

TEST(FrameFile, every_truncation_is_refused) {
  const Bytes bytes = encode_exr(gradient_frame(), kMeta, PixelFormat::half);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 200)
    EXPECT_THROW(static_cast<void>(decode_exr(BytesView(bytes).first(size), "cut.exr")), InputError) << size;
}

TEST(FrameFile, flipped_bytes_never_crash) {
  const Bytes sound = encode_exr(gradient_frame(), kMeta, PixelFormat::half);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < sound.size(); i += i < 700 ? 1 : 97) {
    Bytes damaged = sound;
    damaged[i] ^= std::byte{0x81};
    try {
      static_cast<void>(decode_exr(damaged, "damaged.exr"));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0U);
}

TEST(FrameFile, files_that_are_no_frames_are_refused_with_one_line) {
  for (const char* text : {"", "not an image", "\x76\x2f\x31\x01 but nothing more"}) {
    try {
      static_cast<void>(decode_exr(bytes_of(text), "note.exr"));
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with("note.exr: ")) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos);
    }
  }
}

TEST(Preview, is_a_png_of_srgb_codes) {
  Frame frame{3, 1, {Rgba(0, 0.5F, 1, 1), Rgba(-1, 2, NAN, 1), Rgba(0.0031308F, 0.214041F, 0.001F, 0)}};
  const Bytes png = encode_png(frame);
  EXPECT_EQ(png, encode_png(frame));
  const ImageHeader header = read_image_header(png, "preview", "");
  EXPECT_EQ(header.width, 3U);
  EXPECT_EQ(header.height, 1U);
  const auto pyramid = decode_pyramid(png, true, "preview", "");
  const std::vector<std::uint8_t> row(pyramid->texels8.begin(), pyramid->texels8.begin() + 12);
  EXPECT_EQ(row, (std::vector<std::uint8_t>{0, 188, 255, 255, 0, 255, 0, 255, 10, 127, 3, 255}));
}

TEST(Preview, codes_change_where_srgb_says) {
  Frame frame{255 * 2, 1, {}};
  std::vector<std::uint8_t> expected;
  for (int k = 0; k < 255; ++k) {
    const double encoded = (k + 0.5) / 255;  // halfway to the next code
    const auto edge =
        static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    for (const float value : {std::nextafter(edge, 0.0F), edge}) frame.pixels.emplace_back(value, value, value, 1.0F);
    expected.push_back(static_cast<std::uint8_t>(k));
    expected.push_back(static_cast<std::uint8_t>(k + 1));
  }
  const auto pyramid = decode_pyramid(encode_png(frame), true, "preview", "");
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(pyramid->texels8[4 * i], expected[i]) << i;
}

TEST(Preview, updated_bands_give_the_bytes_of_a_fresh_encoding) {
  Frame frame = gradient_frame();
  PreviewEncoder encoder(kWidth, kHeight);
  encoder.update(frame);
  EXPECT_EQ(encoder.png(), encode_png(frame));
  frame.pixels[kWidth * 69 + 3] = Rgba(0.2F, 0.9F, 0.4F, 1);
  encoder.update(frame, ChangedPixels(std::vector<std::uint32_t>{kWidth * 69 + 3}, kWidth));
  EXPECT_EQ(encoder.png(), encode_png(frame));
  EXPECT_EQ(decode_pyramid(encoder.png(), true, "preview", "")->levels[0].height, kHeight);
}

TEST(Compare, counts_bits_and_measures_errors) {
  Frame a{2, 2, std::vector<Rgba>(4, Rgba(0, 0, 0, 1))}, b = a;
  b.pixels[3].g = 0.5F;
  b.pixels[1].b = -0.0F;
  const FrameDifference difference = compare_frames(a, b);
  EXPECT_EQ(difference.pixels_compared, 4U);
  EXPECT_EQ(difference.pixels_different, 2U);  // -0 has other bits than 0
  EXPECT_EQ(difference.max_error, 0.5);
  EXPECT_DOUBLE_EQ(difference.rms_error, std::sqrt(0.25 / 16));
}

TEST(Compare, a_percentage_takes_that_share_of_the_tiles) {
  const Frame frame{640, 640, std::vector<Rgba>(640 * 640)};
  EXPECT_EQ(compare_frames(frame, frame, 100).pixels_compared, 640U * 640);
  EXPECT_EQ(compare_frames(frame, frame, 50).pixels_compared, 50U * 64 * 64);
  EXPECT_EQ(compare_frames(frame, frame, 0.01).pixels_compared, 64U * 64);
}

}  // namespace
}  // namespace relook
