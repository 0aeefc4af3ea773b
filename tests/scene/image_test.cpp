// Image decoding and mip pyramids: values as stored in the file, damage refused, and exact box filters.
#include <ImfRgbaFile.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "scene/texture/decode_pyramid.h"
#include "scene/texture/exr_header.h"
#include "scene/texture/image_stream.h"

namespace relook {
namespace {

std::string big_endian(std::uint32_t value, int bytes = 4) {
  std::string out;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xFF);
  return out;
}

/// Bit by bit, as the PNG specification writes it: an oracle for the table in the program.
std::uint32_t crc_of(const std::string& data) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : data) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

std::string png_chunk(const std::string& type, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(crc_of(type + data));
}

std::string png_header(std::uint32_t width, std::uint32_t height, int bits, int color_type) {
  const std::string tail = {static_cast<char>(bits), static_cast<char>(color_type), 0, 0, 0};
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big_endian(width) + big_endian(height) + tail);
}

/// Rows without filters in one stored (uncompressed) deflate block. color_type: 0 grey, 2 RGB, 4 grey-alpha, 6 RGBA.
std::string png(std::uint32_t width, std::uint32_t height, int bits, int color_type, const std::string& samples) {
  std::string rows;
  const std::size_t row_bytes = samples.size() / height;
  for (std::uint32_t y = 0; y < height; ++y) rows += '\0' + samples.substr(y * row_bytes, row_bytes);
  std::uint32_t a = 1, b = 0;
  for (const char c : rows) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint32_t>(rows.size());
  std::string zlib = "\x78\x01\x01";
  for (const std::uint32_t length : {size, ~size})
    zlib += {static_cast<char>(length & 0xFF), static_cast<char>(length >> 8 & 0xFF)};
  zlib += rows + big_endian(b << 16 | a);
  return png_header(width, height, bits, color_type) + png_chunk("tEXt", "Comment") + png_chunk("IDAT", zlib) +
         png_chunk("IEND", "");
}

/// An 8 x 8 grey JPEG of value 128, with `segments` after its start.
std::string jpeg(const std::string& segments = "") {
  const auto segment = [](int marker, const std::string& data) {
    return std::string("\xFF") + static_cast<char>(marker) +
           big_endian(static_cast<std::uint32_t>(data.size() + 2), 2) + data;
  };
  const std::string one_code = '\x01' + std::string(15, '\0') + '\0';
  return "\xFF\xD8" + segments + segment(0xDB, '\0' + std::string(64, '\x01')) +
         segment(0xC0, std::string("\x08\0\x08\0\x08\x01\x01\x11\0", 9)) + segment(0xC4, '\0' + one_code) +
         segment(0xC4, '\x10' + one_code) + segment(0xDA, std::string("\x01\x01\0\0\x3F\0", 6)) + "\x3F\xFF\xD9";
}

std::shared_ptr<const TexturePyramid> decoded(std::string_view bytes, bool color = true) {
  return decode_pyramid(bytes_of(bytes), color, "scene", "/images/0");
}

std::string refusal(std::string_view bytes) {
  try {
    (void)decoded(bytes);
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("scene: /images/0: ")) << error.what();
    return error.what();
  }
  return "";
}

using Texels8 = std::vector<std::uint8_t>;

TEST(Image, png_values_stay_as_stored) {
  const auto pyramid = decoded(png(2, 1, 8, 6, std::string("\xC8\x64\x32\x00\x01\x02\x03\x80", 8)));
  EXPECT_EQ(pyramid->format, TexelFormat::srgb8);
  ASSERT_EQ(pyramid->levels.size(), 2U);
  EXPECT_EQ(Texels8(pyramid->texels8.begin(), pyramid->texels8.begin() + 8),
            (Texels8{0xC8, 0x64, 0x32, 0, 1, 2, 3, 0x80}))
      << "colour is not multiplied by alpha";
  EXPECT_EQ(decoded(png(1, 1, 8, 2, "abc"), false)->format, TexelFormat::linear8);
}

TEST(Image, grey_becomes_rgb_and_missing_alpha_one) {
  EXPECT_EQ(decoded(png(1, 1, 8, 0, "\x40"))->texels8, (Texels8{64, 64, 64, 255}));
  EXPECT_EQ(decoded(png(1, 1, 8, 4, "\x40\x20"))->texels8, (Texels8{64, 64, 64, 32}));
  EXPECT_EQ(decoded(png(1, 1, 8, 2, "\x01\x02\x03"))->texels8, (Texels8{1, 2, 3, 255}));
}

TEST(Image, sixteen_bits_become_linear_floats) {
  const std::string sample("\x80\x00\x40\x00\x00\x00\xFF\xFF", 8);
  const auto linear = decoded(png(1, 1, 16, 6, sample), false);
  EXPECT_EQ(linear->format, TexelFormat::float32);
  EXPECT_EQ(linear->texels32, (std::vector<float>{32768.0F / 65535.0F, 16384.0F / 65535.0F, 0, 1}));
  const auto color = decoded(png(1, 1, 16, 6, sample), true);
  EXPECT_NEAR(color->texels32[0], std::pow((32768.0 / 65535.0 + 0.055) / 1.055, 2.4), 1e-6);
  EXPECT_EQ(color->texels32[3], 1.0F);
}

TEST(Image, radiance_hdr) {
  const std::string bytes("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\0\0\0\0", 54);
  const auto pyramid = decoded(bytes);
  EXPECT_EQ(pyramid->format, TexelFormat::float32);
  EXPECT_EQ(std::vector<float>(pyramid->texels32.begin(), pyramid->texels32.begin() + 8),
            (std::vector<float>{1, 0.5F, 0.25F, 1, 0, 0, 0, 1}));
}

TEST(Image, exr_texels_are_finite_and_not_negative) {
  const auto path =
      std::filesystem::path(testing::TempDir()) / ("relook_texels_" + std::to_string(::getpid()) + ".exr");
  const float infinity = std::numeric_limits<float>::infinity();
  const Imf::Rgba row[3] = {{infinity, -infinity, std::nanf(""), 1}, {-2, 3, 0.5F, 1}, {1, 2, 3, 0.25F}};
  {
    Imf::RgbaOutputFile file(path.c_str(), 3, 1, Imf::WRITE_RGBA);
    file.setFrameBuffer(row, 1, 3);
    file.writePixels(1);
  }
  const Bytes bytes = read_file(path);
  std::filesystem::remove(path);
  const auto pyramid = decoded(text_of(bytes));
  EXPECT_EQ(std::vector<float>(pyramid->texels32.begin(), pyramid->texels32.begin() + 12),
            (std::vector<float>{0, 0, 0, 1, 0, 3, 0.5F, 1, 1, 2, 3, 0.25F}));
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_NE(refusal(text_of(bytes).substr(0, length)), "") << length;
}

TEST(Image, jpeg) {
  const auto pyramid = decoded(jpeg());
  EXPECT_EQ(pyramid->levels.size(), 4U);
  EXPECT_EQ(Texels8(pyramid->texels8.begin(), pyramid->texels8.begin() + 4), (Texels8{128, 128, 128, 255}));
}

TEST(Image, jpeg_metadata_never_reaches_the_decoder) {
  // OpenImageIO 2.4 crashes on a Photoshop segment like this one.
  const std::string iptc = std::string("Photoshop 3.0\0", 14) + "8BIM" +
                           std::string("\x04\x06\0\0\0\0\0\x07\xFF\xFF\x01\x01\x01\x01\x01\0", 16) + "8BIM" +
                           std::string("\x04\x25\0\0\0\0\0\x10", 8) + std::string(16, '\0');
  const std::string segment = "\xFF\xED" + big_endian(static_cast<std::uint32_t>(iptc.size() + 2), 2) + iptc;
  EXPECT_EQ(text_of(jpeg_pixels(bytes_of(jpeg(segment))).bytes), jpeg());
  EXPECT_EQ(decoded(jpeg(segment))->texels8, decoded(jpeg())->texels8);
}

std::string little_endian(std::uint32_t value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }

/// The start of an OpenEXR file whose header has one attribute.
std::string exr_start(const std::string& type, const std::string& value, std::uint32_t size) {
  return little_endian(20000630) + little_endian(2) + "a" + std::string(1, '\0') + type + std::string(1, '\0') +
         little_endian(size) + value + std::string(1, '\0');
}
std::string exr_fault(const std::string& type, const std::string& value, std::uint32_t size) {
  return read_exr_header(bytes_of(exr_start(type, value, size))).fault;
}

TEST(Image, sizes_in_the_header_of_an_exr_are_not_believed) {
  const std::string wrong_size = "the OpenEXR header's attribute at byte 8 is not of the size that it says";
  EXPECT_EQ(exr_fault("x", "1234", 4), "");
  for (const std::uint32_t size : {6U, 1634692198U, 0xFFFFFFFFU}) EXPECT_EQ(exr_fault("x", "1234", size), wrong_size);
  EXPECT_EQ(exr_fault("preview", little_endian(1) + little_endian(2) + "abcdefgh", 16), "");
  EXPECT_EQ(exr_fault("preview", little_endian(30000) + little_endian(20000) + "abcdefgh", 16), wrong_size);
  EXPECT_EQ(exr_fault("stringvector", little_endian(2) + "ab" + little_endian(0), 10), "");
  EXPECT_EQ(exr_fault("stringvector", little_endian(0x7FFFFFF0) + "abcdef", 10), wrong_size);
  const std::string channel = std::string("R\0", 2) + std::string(16, '\0'), end(1, '\0');
  EXPECT_EQ(exr_fault("chlist", channel + end, 19), "");
  EXPECT_EQ(exr_fault("chlist", channel + end + "next", 23), wrong_size) << "the library would go on at \"next\"";
  EXPECT_EQ(exr_fault("box2i", std::string(17, 'b'), 17), wrong_size);
  EXPECT_NE(read_exr_header(bytes_of(little_endian(20000630))).fault, "");
  EXPECT_NE(refusal(exr_start("x", "1234", 1634692198)).find(wrong_size), std::string::npos);
}

TEST(Image, tiles_and_rows_of_an_exr_are_counted_before_it_is_opened) {
  const auto attribute = [](const std::string& name, const std::string& type, const std::string& value) {
    return name + std::string(1, '\0') + type + std::string(1, '\0') +
           little_endian(static_cast<std::uint32_t>(value.size())) + value;
  };
  const auto header = [&](std::uint32_t last_column, const std::string& more) {
    const std::string zero = little_endian(0);
    const std::string channel = std::string("R\0", 2) + little_endian(1) + zero + little_endian(1) + little_endian(1);
    return little_endian(20000630) + little_endian(2) +
           attribute("channels", "chlist", channel + std::string(1, '\0')) +
           attribute("dataWindow", "box2i", zero + zero + little_endian(last_column) + little_endian(299)) + more +
           std::string(1, '\0');
  };
  const auto tiles = [&](std::uint32_t columns, std::uint32_t rows) {
    return attribute("tiles", "tiledesc", little_endian(columns) + little_endian(rows) + std::string(1, '\0'));
  };
  EXPECT_EQ(read_exr_header(bytes_of(header(9, ""))).block_bytes, 10U * 256 * 2);
  EXPECT_EQ(read_exr_header(bytes_of(header(9, tiles(4, 0x1B000000)))).block_bytes, 4ULL * 0x1B000000 * 2);
  for (const std::string& large : {header(9, tiles(0x10000, 0x10000)), header(0x7FFFFFF0, "")})
    EXPECT_THROW(decoded(large), ResourceError);
}

TEST(Image, every_cut_and_every_flipped_byte_of_a_png_is_refused) {
  const std::string bytes = png(3, 2, 8, 2, "abcdefghijklmnopqr");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_NE(refusal(bytes.substr(0, i)), "") << i;
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_NE(refusal(damaged), "") << i;
  }
  EXPECT_EQ(refusal(bytes + "trailing"), "");
}

TEST(Image, every_cut_of_a_jpeg_is_refused) {
  const std::string bytes = jpeg();
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_NE(refusal(bytes.substr(0, length)), "") << length;
}

TEST(Image, other_formats_are_named_as_such) {
  for (const std::string bytes : {"", "GIF89a", "II*\0", "<svg>", "\x89PNG"})
    EXPECT_EQ(refusal(bytes),
              "scene: /images/0: cannot decode the image: it is not a PNG, JPEG, WebP, Radiance HDR or OpenEXR image");
}

TEST(Image, sizes_are_checked_before_anything_is_decoded) {
  const std::string end = png_chunk("IDAT", "x") + png_chunk("IEND", "");
  EXPECT_NE(refusal(png_header(40'000, 40'000, 8, 2) + end).find("40000x40000 pixels are too many"), std::string::npos);
  EXPECT_NE(refusal(png_header(8000, 8000, 8, 2) + end).find("too short for 8000x8000 pixels"), std::string::npos);
  EXPECT_NE(refusal(png_header(0, 5, 8, 2) + end), "");
  const ImageHeader header = read_image_header(bytes_of(png(3, 1, 16, 0, "aabbcc")), "scene", "");
  EXPECT_TRUE(header.width == 3 && header.height == 1 && header.is_float);
}

TEST(PyramidStore, decodes_once_and_names_what_is_missing) {
  Assets assets;
  const std::string bytes = png(1, 1, 8, 0, "x");
  const BytesView view = bytes_of(bytes);
  assets.images["Wood"] = {"Wood", std::make_shared<const Bytes>(view.begin(), view.end())};
  assets.images["Void"] = {"Void", nullptr};
  PyramidStore store;
  const auto first = store.get(assets, "Wood", true, "f", "/w");
  EXPECT_EQ(store.get(assets, "Wood", true, "f", "/w"), first);
  EXPECT_NE(store.get(assets, "Wood", false, "f", "/w"), first);
  EXPECT_EQ(store.all().size(), 2U);
  EXPECT_THROW((void)store.get(assets, "Void", true, "f", "/w"), InputError);
  EXPECT_THROW((void)store.get(assets, "Iron", true, "f", "/w"), InputError);
}

TEST(Pyramid, levels_halve_down_to_one_texel) {
  const TexturePyramid pyramid = build_pyramid(TexelFormat::linear8, 5, 2, Texels8(5 * 2 * 4, 7));
  ASSERT_EQ(pyramid.levels.size(), 3U);
  EXPECT_TRUE(pyramid.levels[1].width == 2 && pyramid.levels[1].height == 1 && pyramid.levels[1].offset == 10);
  EXPECT_TRUE(pyramid.levels[2].width == 1 && pyramid.levels[2].height == 1 && pyramid.levels[2].offset == 12);
  EXPECT_EQ(pyramid.texels8.size(), 13U * 4);
}

TEST(Pyramid, a_constant_image_is_constant_on_every_level) {
  for (int value = 0; value < 256; ++value)
    for (const TexelFormat format : {TexelFormat::srgb8, TexelFormat::linear8}) {
      const Texels8 texels(7 * 6 * 4, static_cast<std::uint8_t>(value));
      const TexturePyramid pyramid = build_pyramid(format, 7, 6, texels);
      for (const std::uint8_t byte : pyramid.texels8) ASSERT_EQ(byte, value);
      EXPECT_EQ(pyramid.smallest, pyramid.largest);
    }
}

TEST(Pyramid, means_are_taken_in_the_linear_domain) {
  const Texels8 texels = {0, 0, 0, 0, 255, 255, 255, 255};
  const TexturePyramid srgb = build_pyramid(TexelFormat::srgb8, 2, 1, texels);
  EXPECT_EQ(Texels8(srgb.texels8.begin() + 8, srgb.texels8.end()), (Texels8{188, 188, 188, 128}));
  EXPECT_EQ(srgb.smallest, Rgba(0, 0, 0, 0));
  EXPECT_EQ(srgb.largest, Rgba(1, 1, 1, 1));
}

TEST(Pyramid, odd_sides_are_weighted_by_area) {
  // Five texels over two: each covers two and a half.
  std::vector<float> texels;
  for (const float value : {1.0F, 2.0F, 4.0F, 8.0F, 16.0F}) texels.insert(texels.end(), {value, 0, 0, 1});
  const TexturePyramid pyramid = build_pyramid(5, 1, texels);
  EXPECT_NEAR(pyramid.texels32[20], (1 + 2 + 4 * 0.5) / 2.5, 1e-6);
  EXPECT_NEAR(pyramid.texels32[24], (4 * 0.5 + 8 + 16) / 2.5, 1e-5);
  EXPECT_NEAR(pyramid.texels32[28], (1 + 2 + 4 + 8 + 16) / 5.0, 1e-5);
  EXPECT_EQ(pyramid.largest.r, 16);
}

TEST(Pyramid, bytes_are_rounded_to_the_nearest_code) {
  // Oracle: encode the exact mean with libm in double.
  const auto linear = [](double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); };
  const auto encoded = [](double l) { return l <= 0.0031308 ? l * 12.92 : 1.055 * std::pow(l, 1 / 2.4) - 0.055; };
  for (int a = 0; a < 256; a += 5)
    for (int b = 0; b < 256; b += 3) {
      const auto ua = static_cast<std::uint8_t>(a), ub = static_cast<std::uint8_t>(b);
      const TexturePyramid pyramid = build_pyramid(TexelFormat::srgb8, 2, 1, {ua, ua, ua, ua, ub, ub, ub, ub});
      const double exact = 255 * encoded((linear(a / 255.0) + linear(b / 255.0)) / 2);
      EXPECT_LT(std::abs(exact - pyramid.texels8[8]), 0.5001) << a << " " << b;
      EXPECT_LE(std::abs((a + b) / 2.0 - pyramid.texels8[11]), 0.5) << "alpha is linear";
    }
}

}  // namespace
}  // namespace relook
