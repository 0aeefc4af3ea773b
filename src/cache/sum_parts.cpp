// Of image_parts.h the sums of light: how wide each is packed, and their values byte by byte.
#include <array>
#include <limits>

#include "base/error.h"
#include "cache/image_parts.h"

namespace relook {
namespace {

constexpr std::size_t kMostWidth = 16;
using WidthBytes = std::array<std::uint8_t, 2>;  // SumShape::dropped and ::width

/// Bytes of all values of a sum of a tile. The last of `sums` + 1 is the coverage, of one value a pixel.
std::size_t sum_bytes(std::size_t pixels, std::size_t sum, std::size_t sums, std::size_t width) {
  return pixels * (sum < sums ? 3 : 1) * width;
}

/// Values of `width` bytes: byte 0 of all of them, then byte 1, and so on, which compresses better.
void to_planes(BytesView values, std::size_t width, std::byte* planes) {
  for (std::size_t byte = 0; byte < width; ++byte)
    for (std::size_t i = byte; i < values.size(); i += width) *planes++ = values[i];
}

/// The other way.
void from_planes(BytesView planes, std::size_t width, std::byte* values) {
  const std::byte* plane = planes.data();
  for (std::size_t byte = 0; byte < width; ++byte)
    for (std::size_t i = byte; i < planes.size(); i += width) values[i] = *plane++;
}

}  // namespace

void add_sums(ContainerWriter& writer, std::span<const PackedSums> tiles) {
  std::vector<WidthBytes> widths;
  std::vector<std::uint64_t> clamped;
  Bytes planes;
  for (const PackedSums& packed : tiles) {
    const std::size_t sums = packed.sums();
    require(!packed.empty() && sums == tiles.front().sums(), "a tile has all sums of light");
    BytesView values = packed.values();
    for (std::size_t i = 0; i <= sums; ++i) {
      const SumShape shape = packed.shapes()[i];
      widths.push_back({shape.dropped, shape.width});
      clamped.push_back(shape.clamped);
      const std::size_t bytes = sum_bytes(packed.pixels(), i, sums, shape.width), start = planes.size();
      planes.resize(start + bytes);
      to_planes(values.first(bytes), shape.width, planes.data() + start);
      values = values.subspan(bytes);
    }
  }
  writer.add_column("sum_widths", widths, sizeof(WidthBytes));
  writer.add_column("sum_clamped", clamped, sizeof(std::uint64_t));
  writer.add_column("sums", planes, 1);
}

void read_sums(const ContainerReader& reader, std::size_t sums, const Frame& frame, std::size_t first,
               std::span<PackedSums> tiles) {
  const std::size_t rows = tiles.size() * (sums + 1);
  const auto widths = reader.column<WidthBytes>("sum_widths", rows);
  const auto clamped = reader.column<std::uint64_t>("sum_clamped", rows);
  const auto pixels_of = [&](std::size_t k) { return tile_rect(first + k, frame.width, frame.height).pixels(); };
  std::uint64_t bytes = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    check_sound(widths[row][1] <= kMostWidth, "a width that no sum has in section sum_widths");
    bytes += sum_bytes(pixels_of(row / (sums + 1)), row % (sums + 1), sums, widths[row][1]);
  }
  const auto planes = reader.column<std::byte>("sums", bytes);
  BytesView rest = planes;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    std::vector<SumShape> shapes;
    Bytes values;
    for (std::size_t i = 0; i <= sums; ++i) {
      const std::size_t row = k * (sums + 1) + i;
      shapes.push_back({widths[row][0], widths[row][1], clamped[row]});
      const std::size_t of_sum = sum_bytes(pixels_of(k), i, sums, widths[row][1]), start = values.size();
      values.resize(start + of_sum);
      from_planes(rest.first(of_sum), widths[row][1], values.data() + start);
      rest = rest.subspan(of_sum);
    }
    try {
      tiles[k] = PackedSums::of_parts(std::move(shapes), pixels_of(k), values);
    } catch (const InputError& error) {
      throw CacheDamage(CacheFault::damaged, error.what());
    }
  }
}

}  // namespace relook
