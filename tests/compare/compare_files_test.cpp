// Whatever two OpenEXR files hold is compared: parts, levels, windows, kinds of numbers; what is no quantity passes no
// threshold, and what cannot be read is refused.
#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "compare/file_comparison.h"
#include "compare_file.h"
#include "run_program.h"

namespace relook {
namespace {

const Thresholds kLenient{.fail = 1e30, .fail_percent = 100};

class CompareFiles : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path at(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] static FrameComparison compare(const std::filesystem::path& a, const std::filesystem::path& b,
                                               const Thresholds& thresholds = {}) {
    return compare_exr_files(ExrFile(read_file(a), "a"), ExrFile(read_file(b), "b"), thresholds, DisplayWhite())
        .comparison;
  }
  [[nodiscard]] FrameComparison compare(const std::vector<FilePart>& a, const std::vector<FilePart>& b,
                                        const Thresholds& thresholds = {}) const {
    write_parts(at("a.exr"), a);
    write_parts(at("b.exr"), b);
    return compare(at("a.exr"), at("b.exr"), thresholds);
  }
  [[nodiscard]] std::string refusal(const std::filesystem::path& path) const {
    try {
      static_cast<void>(ExrFile(read_file(path), "a"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  ScratchFolder folder_{"compare_files"};
};

FilePart picture(const std::string& name = "") {
  FilePart part;
  part.name = name;
  for (const char* channel : {"R", "G", "B", "A"}) part.fill(channel, 0.5F);
  return part;
}

const LayerDifference& layer(const FrameComparison& comparison, const std::string& name) {
  const auto found = std::ranges::find(comparison.layers, name, &LayerDifference::layer);
  if (found == comparison.layers.end()) throw std::runtime_error("no layer " + name);
  return *found;
}

TEST_F(CompareFiles, equal_files_have_every_layer_equal) {
  FilePart part = picture();
  part.fill("depth.Z", 1e10F).fill("Z", 2).fill("light_a.b.R", 3);
  const FrameComparison same = compare({part}, {part});
  EXPECT_EQ(same.verdict, Verdict::equal);
  EXPECT_EQ(same.first_difference, "");
  ASSERT_EQ(same.layers.size(), 4U);
  EXPECT_EQ(same.layers[0].layer, "RGBA");
  EXPECT_EQ(same.layers[1].layer, "Z");
  EXPECT_EQ(same.layers[2].layer, "depth");
  EXPECT_EQ(same.layers[3].layer, "light_a.b");
}

TEST_F(CompareFiles, a_missing_alpha_is_not_one) {
  FilePart with = picture(), without = with;
  with.fill("A", 1);
  without.channels.erase("A");
  for (const Thresholds& thresholds : {Thresholds{}, kLenient}) {
    const FrameComparison missing = compare({with}, {without}, thresholds);
    EXPECT_EQ(missing.verdict, Verdict::failure);
    EXPECT_EQ(missing.first_difference, "channel A, only in the first");
    EXPECT_EQ(missing.difference.pixels_different, 48U);
    EXPECT_EQ(compare({without}, {with}, thresholds).first_difference, "channel A, only in the second");
  }
  EXPECT_EQ(compare({without}, {without}).verdict, Verdict::equal);
}

TEST_F(CompareFiles, parts_are_matched_by_name) {
  const FilePart left = picture("left");
  FilePart right = picture("right");
  right.fill("R", 0.25F);
  EXPECT_EQ(compare({left, right}, {right, left}).verdict, Verdict::equal) << "in any order";
  FilePart other = right;
  other.channels["G"].flip_bit(47);
  const FrameComparison changed = compare({left, right}, {left, other});
  EXPECT_EQ(changed.verdict, Verdict::failure);
  EXPECT_EQ(changed.difference.pixels_different, 0U) << "of the picture, which is that of the first part";
  EXPECT_EQ(changed.first_difference, "part right, channel G");
  for (const auto& [a, b, place] : {std::tuple{std::vector{left, right}, std::vector{left}, "first"},
                                    {std::vector{left}, std::vector{left, right}, "second"}}) {
    const FrameComparison missing = compare(a, b, kLenient);
    EXPECT_EQ(missing.verdict, Verdict::failure);
    EXPECT_EQ(missing.first_difference, std::string("part right, channel A, only in the ") + place);
  }
}

TEST_F(CompareFiles, a_part_without_name_is_the_others_first) {
  EXPECT_EQ(compare({picture()}, {picture("rgba")}).verdict, Verdict::equal);
  EXPECT_EQ(compare({picture("rgba")}, {picture()}).verdict, Verdict::equal);
  const FrameComparison more = compare({picture()}, {picture("rgba"), picture("more")});
  EXPECT_EQ(more.first_difference, "part more, channel A, only in the second");
}

TEST_F(CompareFiles, ids_are_no_quantities) {
  FilePart part = picture();
  part.channels["id"] = FilePartChannel::uints(std::vector<std::uint32_t>(48, 0x8000'0001U));
  part.fill("Crypto00.R", 1).fill("Crypto00.G", 1).fill("Crypto.R", 1).fill("Cryptography.R", 1);
  part.attributes["cryptomatte/1234567/name"] = "Crypto";
  for (const char* id : {"id", "Crypto00.R", "Crypto00.G"}) {
    FilePart other = part;
    other.channels[id].flip_bit(20);
    const FrameComparison changed = compare({part}, {other}, kLenient);
    EXPECT_EQ(changed.verdict, Verdict::failure) << id;
    EXPECT_EQ(changed.first_difference, std::string("channel ") + id);
    EXPECT_EQ(layer(changed, layer_name(id)).pixels_other_ids, 1U);
    EXPECT_TRUE(layer_json(layer(changed, layer_name(id)))["max_error"].is_null());
  }
  for (const char* quantity : {"Crypto.R", "Cryptography.R", "R"}) {
    FilePart other = part;
    other.channels[quantity].flip_bit(20);
    EXPECT_EQ(compare({part}, {other}, kLenient).verdict, Verdict::within) << quantity;
    EXPECT_EQ(compare({part}, {other}).verdict, Verdict::failure) << quantity;
  }
  FilePart unnamed = part;
  unnamed.attributes.clear();
  FilePart other = unnamed;
  other.channels["Crypto00.R"].flip_bit(20);
  EXPECT_EQ(compare({unnamed}, {other}, kLenient).verdict, Verdict::within);
  EXPECT_EQ(compare({unnamed}, {part}).verdict, Verdict::equal) << "headers are not compared";
}

TEST_F(CompareFiles, thresholds_hold_for_each_layer) {
  FilePart part = picture();
  part.fill("depth.Z", 1);
  FilePart other = part;
  other.channels["depth.Z"].set(9, 1.25F);
  EXPECT_EQ(compare({part}, {other}, {.fail = 0.25}).verdict, Verdict::within);
  EXPECT_EQ(compare({part}, {other}, {.fail = 0.2}).verdict, Verdict::failure);
  EXPECT_EQ(compare({part}, {other}, {.fail_percent = 3}).verdict, Verdict::within);
  EXPECT_EQ(compare({part}, {other}, {.fail_percent = 2}).verdict, Verdict::failure);
  EXPECT_EQ(compare({part}, {other}, {.fail_percent = 3, .hard_fail = 0.2}).verdict, Verdict::failure);
  EXPECT_EQ(compare({part}, {other}, {.fail = 1, .warn = 0.1}).verdict, Verdict::warning);
  const LayerDifference depth = layer(compare({part}, {other}), "depth");
  EXPECT_EQ(depth.figures.pixels_different, 1U);
  EXPECT_EQ(depth.figures.max_error, 0.25);
  EXPECT_DOUBLE_EQ(depth.rms_error, std::sqrt(0.25 * 0.25 / 48));
}

TEST_F(CompareFiles, layers_keep_the_rules_for_nan) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float value : {nan, infinity, -infinity}) {
    FilePart part = picture();
    part.fill("depth.Z", 1);
    FilePart other = part;
    other.channels["depth.Z"].set(9, value);
    EXPECT_EQ(compare({other}, {other}).verdict, Verdict::equal) << value;
    const FrameComparison changed = compare({part}, {other}, kLenient);
    EXPECT_EQ(changed.verdict, Verdict::failure) << value;
    EXPECT_TRUE(layer_json(layer(changed, "depth"))["rms_error"].is_null());
    FilePart bits = other;
    bits.channels["depth.Z"].flip_bit(9);
    EXPECT_EQ(compare({bits}, {other}, kLenient).verdict, Verdict::failure) << value << " with other bits";
  }
  FilePart zero = picture();
  zero.fill("depth.Z", 0);
  FilePart negative = zero;
  negative.channels["depth.Z"].set(9, -0.0F);
  EXPECT_EQ(compare({zero}, {negative}).verdict, Verdict::failure);
  EXPECT_EQ(compare({zero}, {negative}, {.fail = 0}).verdict, Verdict::within);
}

TEST_F(CompareFiles, kinds_of_numbers_are_compared_by_value) {
  FilePart floats = picture();
  FilePart halves = floats;
  for (auto& [name, channel] : halves.channels) channel = FilePartChannel::halves(std::vector<float>(48, 0.5F));
  EXPECT_EQ(compare({floats}, {halves}).verdict, Verdict::equal);
  FilePart near = floats;
  near.channels["B"].set(5, std::nextafter(0.5F, 1.0F));
  EXPECT_EQ(compare({near}, {halves}).first_difference, "channel B");
  FilePart other = halves;
  other.channels["B"].flip_bit(5);
  EXPECT_EQ(compare({halves}, {other}).difference.pixels_different, 1U);
  FilePart uints = floats;
  uints.fill("count", 3);
  floats = uints;
  uints.channels["count"] = FilePartChannel::uints(std::vector<std::uint32_t>(48, 3));
  EXPECT_EQ(compare({floats}, {uints}, kLenient).first_difference, "channel count, uint in one only");
}

TEST_F(CompareFiles, files_without_a_picture_are_compared) {
  FilePart depth, ids;
  depth.fill("Z", 3);
  ids.channels["id"] = FilePartChannel::uints(std::vector<std::uint32_t>(48, 7));
  for (const auto& [part, channel] : {std::pair{depth, "Z"}, {ids, "id"}}) {
    const FrameComparison same = compare({part}, {part});
    EXPECT_EQ(same.verdict, Verdict::equal);
    EXPECT_EQ(same.difference.pixels_compared, 48U);
    FilePart other = part;
    other.channels[channel].flip_bit(11);
    const FrameComparison changed = compare({part}, {other});
    EXPECT_EQ(changed.verdict, Verdict::failure);
    EXPECT_EQ(changed.difference.pixels_different, 1U);
    EXPECT_FALSE(changed.has_picture);
    EXPECT_TRUE(comparison_json(changed)["flip"].is_null());
  }
  const FrameComparison none = compare({depth}, {picture()}, kLenient);
  EXPECT_EQ(none.verdict, Verdict::failure) << "nothing in common";
}

FilePart windowed(const Imath::Box2i& window) {
  FilePart part;
  part.data = window;
  for (const char* channel : {"R", "G", "B", "A", "depth.Z"}) part.fill(channel, 0);
  return part;
}

TEST_F(CompareFiles, windows_are_compared_over_their_union) {
  FilePart whole = windowed({{0, 0}, {7, 5}}), crop = windowed({{2, 1}, {4, 3}});
  EXPECT_EQ(compare({whole}, {crop}).verdict, Verdict::equal) << "0 outside";
  whole.channels["G"].set(1 * 8 + 2, 0.5F);
  crop.channels["G"].set(0, 0.5F);
  EXPECT_EQ(compare({whole}, {crop}).verdict, Verdict::equal);
  EXPECT_EQ(compare({crop}, {whole}).verdict, Verdict::equal);
  whole.channels["depth.Z"].set(5 * 8 + 7, 0.5F);
  for (const FrameComparison& beside : {compare({whole}, {crop}), compare({crop}, {whole})}) {
    EXPECT_EQ(beside.first_difference, "channel depth.Z");
    EXPECT_EQ(layer(beside, "depth").figures.pixels_different, 1U);
    EXPECT_EQ(layer(beside, "depth").figures.pixels_compared, 48U);
  }
}

TEST_F(CompareFiles, a_moved_data_window_is_found) {
  const FilePart zero = windowed({{1, 1}, {4, 3}});
  FilePart part = zero;
  part.channels["R"].set(0, 0.5F);
  FilePart moved = part, moved_zero = zero;
  moved.data = moved_zero.data = {{-2, 2}, {1, 4}};
  const FrameComparison comparison = compare({part}, {moved});
  EXPECT_EQ(comparison.verdict, Verdict::failure);
  EXPECT_EQ(comparison.difference.pixels_compared, 7U * 4);
  EXPECT_EQ(comparison.difference.pixels_different, 2U);
  ASSERT_TRUE(comparison.worst);
  EXPECT_EQ(comparison.worst->x, 1);
  EXPECT_EQ(comparison.worst->y, 1);
  EXPECT_EQ(compare({moved}, {part}).worst->x, 1);
  EXPECT_EQ(compare({zero}, {moved_zero}).verdict, Verdict::equal) << "no pixel differs";
  moved.data = {{5'000'000, 1}, {5'000'003, 3}};
  EXPECT_THROW(static_cast<void>(compare({part}, {moved})), InputError);
}

TEST_F(CompareFiles, display_windows_are_compared) {
  const FilePart part = picture();
  FilePart moved = part, larger = part;
  moved.display = moved.data = {{10, 20}, {17, 25}};
  const FrameComparison comparison = compare({part}, {moved}, kLenient);
  EXPECT_EQ(comparison.verdict, Verdict::failure);
  EXPECT_EQ(comparison.first_difference, "origin of the display window");
  EXPECT_EQ(comparison.difference.pixels_different, 0U) << "pixels are counted from its corner";
  larger.display.max.x = 8;
  EXPECT_THROW(static_cast<void>(compare({part}, {larger})), InputError);
}

TEST_F(CompareFiles, storage_makes_no_difference) {
  FilePart part;
  part.data = part.display = {{0, 0}, {40, 300}};
  for (const char* channel : {"R", "G", "B", "depth.Z"}) {
    std::vector<float> values(part.pixels());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 97) / 16;
    part.channels[channel] = FilePartChannel::floats(values);
  }
  for (const auto compression :
       {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    for (const unsigned tile_size : {0U, 32U}) {
      FilePart stored = part;
      stored.compression = compression;
      stored.tile_size = tile_size;
      if (compression != Imf::DWAB_COMPRESSION) {
        EXPECT_EQ(compare({part}, {stored}).verdict, Verdict::equal) << compression << " " << tile_size;
      }
      stored.channels["depth.Z"].set(part.pixels() - 1, 100);
      const FrameComparison changed = compare({part}, {stored});
      EXPECT_EQ(changed.verdict, Verdict::failure) << compression << " " << tile_size;
      EXPECT_GT(layer(changed, "depth").figures.max_error, 50);
    }
  }
}

// Rows are decoded in bands of 32 MiB, however tall an image is; this one is a band of 512 rows and a rest.
TEST_F(CompareFiles, every_band_is_compared) {
  FilePart part;
  part.data = part.display = {{0, 0}, {4095, 599}};
  part.compression = Imf::RLE_COMPRESSION;
  for (const char* channel : {"P.X", "P.Y", "P.Z", "P.W"}) part.fill(channel, 0.5F);
  FilePart other = part;
  for (const std::size_t row : {0U, 511U, 512U, 599U}) other.channels["P.Y"].flip_bit(row * 4096 + row);
  EXPECT_EQ(compare({part}, {other}).difference.pixels_different, 4U);
}

TEST_F(CompareFiles, levels_of_resolution_are_compared) {
  const auto write = [&](const std::string& name, float of_level_1) {
    Imf::Header header(16, 16);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(4, 4, Imf::MIPMAP_LEVELS));
    Imf::TiledOutputFile file(at(name).c_str(), header);
    for (int level = 0; level < file.numLevels(); ++level) {
      std::vector<float> values(256, level == 1 ? of_level_1 : 0.5F);
      Imf::FrameBuffer buffer;
      buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), 4, 4 * 16));
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
  };
  write("a.exr", 0.5F);
  write("b.exr", 0.25F);
  EXPECT_EQ(compare(at("a.exr"), at("a.exr")).layers.size(), 5U);
  EXPECT_EQ(compare(at("a.exr"), at("b.exr")).first_difference, "level 1, channel Y");
}

TEST_F(CompareFiles, deep_and_subsampled_files_are_refused) {
  Imf::Header deep(8, 6);
  deep.channels().insert("Z", Imf::Channel(Imf::FLOAT));
  deep.setType(Imf::DEEPSCANLINE);
  deep.compression() = Imf::ZIPS_COMPRESSION;
  { Imf::DeepScanLineOutputFile file(at("deep.exr").c_str(), deep); }
  EXPECT_EQ(refusal(at("deep.exr")), "a: deep data is not compared");
  Imf::Header chroma(8, 6);
  chroma.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  { Imf::OutputFile file(at("chroma.exr").c_str(), chroma); }
  EXPECT_EQ(refusal(at("chroma.exr")), "a: channels: channel RY is subsampled, which is not compared");
}

void read_all(BytesView bytes) {
  const ExrFile file({bytes.begin(), bytes.end()}, "damaged.exr");
  for (const ExrImage& image : file.images()) {
    ImageRows rows(file, image);
    for (std::int64_t y = image.window.y0; y < image.window.y1; ++y)
      if (!rows.holds(y)) rows.load(y);
  }
}

TEST_F(CompareFiles, damaged_files_are_refused_and_never_crash) {
  FilePart tiled = picture("tiled");
  tiled.tile_size = 4;
  for (const auto& parts : {std::vector{picture()}, std::vector{picture("one"), tiled}}) {
    write_parts(at("sound.exr"), parts);
    const Bytes sound = read_file(at("sound.exr"));
    read_all(sound);
    for (std::size_t size = 0; size < sound.size(); size += 3)
      EXPECT_THROW(read_all(BytesView(sound).first(size)), InputError) << size;
    std::size_t refused = 0;
    for (std::size_t i = 0; i < sound.size(); ++i) {
      Bytes damaged = sound;
      damaged[i] ^= std::byte{0x81};
      try {
        read_all(damaged);
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, sound.size() / 4);
  }
}

// The header of a small file says that its data window is as large as is read, or larger.
TEST_F(CompareFiles, sizes_are_not_believed) {
  FilePart part = picture();
  for (const unsigned tile_size : {0U, 4U}) {
    part.tile_size = tile_size;
    write_parts(at("a.exr"), {part});
    Bytes bytes = read_file(at("a.exr"));
    const std::size_t place = text_of(bytes).find("dataWindow");
    ASSERT_NE(place, std::string_view::npos);
    for (const std::int32_t side : {16384, 30000, 2'000'000'000}) {
      const std::int32_t window[4] = {0, 0, side - 1, side - 1};
      std::memcpy(&bytes[place + sizeof "dataWindow" + sizeof "box2i" + 4], window, sizeof window);
      EXPECT_THROW(read_all(bytes), InputError) << side << " " << tile_size;
    }
  }
}

}  // namespace
}  // namespace relook
