#include "frame/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledInputPart.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "frame/memory_stream.h"

namespace relook {
namespace {

constexpr std::int64_t kBandBytes = std::int64_t{32} << 20;         // about so much is decoded at a time
constexpr std::int64_t kLargestChunkBytes = std::int64_t{1} << 30;  // of the least that can be decoded

/// Runs `read`; what OpenEXR throws becomes an InputError.
template <class Read>
auto as_input(const std::string& file, Read&& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(file, "", std::string("not a readable OpenEXR image: ") + error.what());
  }
}

PixelWindow pixel_window(const Imath::Box2i& box, std::int64_t origin_x, std::int64_t origin_y) {
  return {box.min.x - origin_x, box.min.y - origin_y, box.max.x - origin_x + 1, box.max.y - origin_y + 1};
}

bool is_tiled(const Imf::Header& header) {
  return header.hasType() ? header.type() == Imf::TILEDIMAGE : header.hasTileDescription();
}

/// Rows that are compressed together.
std::int64_t chunk_rows(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 32;
  }
}

SampleKind sample_kind(Imf::PixelType type) {
  return type == Imf::HALF ? SampleKind::half : type == Imf::FLOAT ? SampleKind::float32 : SampleKind::uint32;
}

Imf::PixelType pixel_type(SampleKind kind) {
  return kind == SampleKind::half ? Imf::HALF : kind == SampleKind::float32 ? Imf::FLOAT : Imf::UINT;
}

std::vector<StoredChannel> stored_channels(const Imf::Header& header, const std::string& file) {
  std::vector<StoredChannel> channels;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw InputError(file, "channels", std::string("channel ") + it.name() + " is subsampled, which is not compared");
    channels.push_back({it.name(), sample_kind(it.channel().type)});
  }
  return channels;
}

/// Requires: what OpenEXR keeps for a part is in proportion to its file, and a band of it fits in memory.
void check_size(const Imf::Header& header, const ExrImage& image, std::size_t file_bytes, const std::string& file) {
  const std::int64_t width = image.window.width(), height = image.window.height();
  const auto pixel_bytes = static_cast<std::int64_t>(image.pixel_bytes());
  bool is_read = is_read_size(width, height);
  if (is_read && is_tiled(header)) {
    const Imf::TileDescription& tiles = header.tileDescription();
    const std::int64_t tile_width = tiles.xSize, tile_height = tiles.ySize;
    is_read = tile_width >= 1 && tile_height >= 1 && tile_width <= kLargestChunkBytes &&
              tile_height <= kLargestChunkBytes / tile_width / std::max<std::int64_t>(1, pixel_bytes) &&
              width * std::min(height, tile_height) <= kLargestChunkBytes / std::max<std::int64_t>(1, pixel_bytes);
    const auto tile_count =
        is_read ? ((width + tile_width - 1) / tile_width) * ((height + tile_height - 1) / tile_height) : 0;
    if (static_cast<std::size_t>(tile_count) > file_bytes / sizeof(std::uint64_t))
      throw InputError(file, "tiles", "more tiles than the file has room for");
  } else if (is_read) {
    is_read = chunk_rows(header.compression()) * width <= kLargestChunkBytes / std::max<std::int64_t>(1, pixel_bytes);
  }
  if (!is_read) throw InputError(file, "dataWindow", "an image this large is not read");
}

}  // namespace

std::size_t ExrImage::pixel_bytes() const {
  std::size_t bytes = 0;
  for (const StoredChannel& channel : channels) bytes += sample_bytes(channel.kind);
  return bytes;
}

struct ExrFile::Input {
  explicit Input(BytesView bytes) : stream(bytes), file(stream, 0) {}
  MemoryStream stream;
  Imf::MultiPartInputFile file;
};

ExrFile::ExrFile(Bytes bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {
  as_input(name_, [&] {
    input_ = std::make_unique<Input>(bytes_);
    display_ = pixel_window(input_->file.header(0).displayWindow(), 0, 0);
    for (int part = 0; part < input_->file.parts(); ++part) read_part(part);
  });
}

ExrFile::~ExrFile() = default;

std::size_t ExrFile::part_count() const { return static_cast<std::size_t>(input_->file.parts()); }

void ExrFile::read_part(int part) {
  const Imf::Header& header = input_->file.header(part);
  ExrImage image;
  if (header.hasName()) image.part = header.name();
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw InputError(name_, image.part, "deep data is not compared");
  image.part_index = static_cast<std::size_t>(part);
  image.window = pixel_window(header.dataWindow(), display_.x0, display_.y0);
  image.channels = stored_channels(header, name_);
  check_size(header, image, bytes_.size(), name_);
  for (auto it = header.begin(); it != header.end(); ++it) {
    const std::string_view attribute = it.name();
    if (!attribute.starts_with("cryptomatte/") || !attribute.ends_with("/name")) continue;
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
      cryptomattes_.push_back(text->value());
  }
  images_.push_back(image);
  if (!is_tiled(header) || header.tileDescription().mode == Imf::ONE_LEVEL) return;
  Imf::TiledInputPart tiles(input_->file, part);
  for (int y = 0; y < tiles.numYLevels(); ++y) {
    for (int x = 0; x < tiles.numXLevels(); ++x) {
      if ((x == 0 && y == 0) || !tiles.isValidLevel(x, y)) continue;
      image.level_x = x, image.level_y = y;
      image.window = pixel_window(tiles.dataWindowForLevel(x, y), display_.x0, display_.y0);
      images_.push_back(image);
    }
  }
}

ImageRows::ImageRows(const ExrFile& file, const ExrImage& image) : file_(file), image_(image) {
  const Imf::Header& header = file.input_->file.header(static_cast<int>(image.part_index));
  const auto row_bytes =
      std::max<std::int64_t>(1, image.window.width() * static_cast<std::int64_t>(image.pixel_bytes()));
  // Tiles are decoded a row of them at a time, others in whole chunks.
  const std::int64_t rows = is_tiled(header) ? header.tileDescription().ySize : chunk_rows(header.compression());
  band_rows_ = std::max<std::int64_t>(1, kBandBytes / row_bytes / rows) * rows;
  std::size_t offset = 0;
  for (const StoredChannel& channel : image.channels) {
    offsets_.push_back(offset);
    offset += sample_bytes(channel.kind);
  }
}

PixelWindow ImageRows::band_around(std::int64_t y) const {
  PixelWindow band = image_.window;
  band.y0 += (y - image_.window.y0) / band_rows_ * band_rows_;
  band.y1 = std::min(band.y0 + band_rows_, image_.window.y1);
  return band;
}

void ImageRows::load(std::int64_t y) {
  require(y >= image_.window.y0 && y < image_.window.y1, "rows are read within an image's window");
  band_ = {};
  const PixelWindow band = band_around(y);
  if (image_.channels.empty()) {
    band_ = band;
    return;
  }
  const auto width = static_cast<std::size_t>(band.width()), height = static_cast<std::size_t>(band.height());
  samples_.resize(width * height * image_.pixel_bytes());
  as_input(file_.name_, [&] {
    const auto part = static_cast<int>(image_.part_index);
    const Imath::V2i corner(static_cast<int>(band.x0 + file_.display_.x0),
                            static_cast<int>(band.y0 + file_.display_.y0));
    const int last_row = corner.y + static_cast<int>(height) - 1;
    Imf::FrameBuffer target;
    for (std::size_t i = 0; i < image_.channels.size(); ++i) {
      const std::size_t bytes = sample_bytes(image_.channels[i].kind);
      target.insert(image_.channels[i].name,
                    Imf::Slice::Make(pixel_type(image_.channels[i].kind), &samples_[width * height * offsets_[i]],
                                     corner, band.width(), band.height(), bytes, bytes * width));
    }
    if (!is_tiled(file_.input_->file.header(part))) {
      Imf::InputPart input(file_.input_->file, part);
      input.setFrameBuffer(target);
      input.readPixels(corner.y, last_row);
      return;
    }
    Imf::TiledInputPart input(file_.input_->file, part);
    input.setFrameBuffer(target);
    const std::int64_t tile_rows = input.tileYSize();
    input.readTiles(0, input.numXTiles(image_.level_x) - 1, static_cast<int>((band.y0 - image_.window.y0) / tile_rows),
                    static_cast<int>((band.y1 - 1 - image_.window.y0) / tile_rows), image_.level_x, image_.level_y);
  });
  band_ = band;
}

const std::byte* ImageRows::row(std::size_t channel, std::int64_t y) const {
  require(holds(y), "rows are decoded before they are looked at");
  const auto width = static_cast<std::size_t>(band_.width()), height = static_cast<std::size_t>(band_.height());
  const auto row = static_cast<std::size_t>(y - band_.y0);
  return &samples_[width * height * offsets_[channel]] + row * width * sample_bytes(image_.channels[channel].kind);
}

}  // namespace relook
