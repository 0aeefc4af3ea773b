// A part of the module behind scene/gltf/packed/mesh_library.h: Draco's decoder. The only file that sees it. Draco
// allocates by what its stream declares: its two mesh decoders are entered where they have read how much there is, and
// may not go on before that is allowed.
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

#include "scene/gltf/packed/mesh_library.h"

namespace {

constexpr std::uint16_t kVersion2_0 = DRACO_BITSTREAM_VERSION(2, 0), kVersion2_2 = DRACO_BITSTREAM_VERSION(2, 2);

/// The counts at the beginning of the connectivity, read from a copy of the decoder's place.
class Counts {
 public:
  Counts(const draco::DecoderBuffer& buffer, bool has_varints) : buffer_(buffer), has_varints_(has_varints) {}
  std::uint64_t next() {
    std::uint32_t value = 0;
    is_whole_ = is_whole_ && (has_varints_ ? draco::DecodeVarint(&value, &buffer_) : buffer_.Decode(&value));
    return value;
  }
  std::uint64_t next_byte() {
    std::uint8_t value = 0;
    is_whole_ = is_whole_ && buffer_.Decode(&value);
    return value;
  }
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  draco::DecoderBuffer buffer_;
  bool has_varints_, is_whole_ = true;
};

/// What both decoders ask, and why they ended.
class Gate {
 public:
  explicit Gate(const relook::DracoLimits& limits) : limits_(limits) {}

  bool allows_connectivity(std::uint64_t faces, std::uint64_t points, std::uint64_t bytes) {
    if (faces > limits_.faces) return refuse(faces, "triangles", limits_.faces);
    return allows_points(points) && limits_.may_hold(bytes);
  }
  /// All attributes are declared, none has values yet.
  bool allows_attributes(const draco::PointCloud& cloud) {
    const auto points = static_cast<std::uint64_t>(cloud.num_points());
    if (!allows_points(points)) return false;
    std::uint64_t bytes = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      constexpr std::uint64_t kOfPoint = 16, kOfNumber = 16;  // maps and portable values beside the attribute
      const auto stride = static_cast<std::uint64_t>(std::max<std::int64_t>(attribute.byte_stride(), 0));
      bytes += points * (kOfPoint + stride + kOfNumber * static_cast<std::uint64_t>(attribute.num_components()));
    }
    return limits_.may_hold(bytes);
  }
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  bool allows_points(std::uint64_t points) {
    return points <= limits_.points || refuse(points, "vertices", limits_.points);
  }
  bool refuse(std::uint64_t count, const char* what, std::uint64_t most) {
    error_ =
        "the Draco data has " + std::to_string(count) + " " + what + ", its accessors have " + std::to_string(most);
    return false;
  }

  const relook::DracoLimits& limits_;
  std::string error_;
};

class SequentialDecoder final : public draco::MeshSequentialDecoder {
 public:
  explicit SequentialDecoder(Gate& gate) : gate_(gate) {}

 protected:
  bool DecodeConnectivity() override {
    Counts counts(*buffer(), bitstream_version() >= kVersion2_2);
    const std::uint64_t faces = counts.next(), points = counts.next();
    constexpr std::uint64_t kOfFace = 32;
    return counts.is_whole() && gate_.allows_connectivity(faces, points, kOfFace * faces) &&
           MeshSequentialDecoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    return gate_.allows_attributes(*point_cloud()) && MeshSequentialDecoder::DecodeAllAttributes();
  }

 private:
  Gate& gate_;
};

class EdgebreakerDecoder final : public draco::MeshEdgebreakerDecoder {
 public:
  explicit EdgebreakerDecoder(Gate& gate) : gate_(gate) {}

 protected:
  bool DecodeConnectivity() override {
    Counts counts(*buffer(), bitstream_version() >= kVersion2_0);
    if (bitstream_version() < kVersion2_2) (void)counts.next();  // vertices that splits add
    const std::uint64_t vertices = counts.next(), faces = counts.next(), attribute_data = counts.next_byte();
    const std::uint64_t symbols = counts.next(), splits = counts.next();
    // Each vertex belongs to a triangle, each split is a symbol, each symbol a triangle.
    if (!counts.is_whole() || symbols > faces || splits > symbols || vertices > 3 * faces) return false;
    // The corner tables of the mesh and of each attribute with seams, and what walks along them.
    constexpr std::uint64_t kOfFace = 160, kOfFaceAndData = 96, kOfVertex = 48;
    const std::uint64_t bytes = faces * (kOfFace + attribute_data * kOfFaceAndData) + (vertices + splits) * kOfVertex;
    return gate_.allows_connectivity(faces, 0, bytes) && MeshEdgebreakerDecoder::DecodeConnectivity();
  }
  bool DecodeAllAttributes() override {
    return gate_.allows_attributes(*point_cloud()) && MeshEdgebreakerDecoder::DecodeAllAttributes();
  }

 private:
  Gate& gate_;
};

/// A number in another type, if it is in its range.
template <class To, class From>
bool convert(From from, bool is_normalized, To& to) {
  if constexpr (std::is_same_v<To, float>) {
    to = static_cast<float>(from);
    if constexpr (std::is_integral_v<From>)
      if (is_normalized) to = std::max(to / static_cast<float>(std::numeric_limits<From>::max()), -1.0F);
    return true;
  } else {
    const auto value = static_cast<double>(from);
    if (!(value >= static_cast<double>(std::numeric_limits<To>::min()) &&
          value <= static_cast<double>(std::numeric_limits<To>::max())))
      return false;
    to = static_cast<To>(value);
    return true;
  }
}

/// False where a value is missing or does not fit: a damaged stream may leave values and their places out.
template <class To, class From>
bool read_numbers(const draco::PointAttribute& attribute, std::size_t points, To* out) {
  const auto width = static_cast<std::size_t>(attribute.num_components());
  const std::size_t stride = width * sizeof(From);
  if (attribute.byte_stride() != static_cast<std::int64_t>(stride) || attribute.buffer() == nullptr) return false;
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < points) return false;
  const std::size_t values = std::min(attribute.size(), attribute.buffer()->data_size() / stride);
  std::vector<From> numbers(width);
  for (std::size_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (value.value() >= values) return false;
    attribute.GetValue(value, numbers.data());
    for (const From number : numbers)
      if (!convert(number, attribute.normalized(), *out++)) return false;
  }
  return true;
}

template <class To>
bool read_as(const draco::PointAttribute& attribute, std::size_t points, void* bytes) {
  To* const out = static_cast<To*>(bytes);
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      return read_numbers<To, std::int8_t>(attribute, points, out);
    case draco::DT_UINT8:
    case draco::DT_BOOL:
      return read_numbers<To, std::uint8_t>(attribute, points, out);
    case draco::DT_INT16:
      return read_numbers<To, std::int16_t>(attribute, points, out);
    case draco::DT_UINT16:
      return read_numbers<To, std::uint16_t>(attribute, points, out);
    case draco::DT_INT32:
      return read_numbers<To, std::int32_t>(attribute, points, out);
    case draco::DT_UINT32:
      return read_numbers<To, std::uint32_t>(attribute, points, out);
    case draco::DT_FLOAT32:
      return read_numbers<To, float>(attribute, points, out);
    case draco::DT_FLOAT64:
      return read_numbers<To, double>(attribute, points, out);
    default:
      return false;
  }
}

class DecodedMesh final : public relook::DracoMesh {
 public:
  draco::Mesh mesh;

  [[nodiscard]] std::size_t faces() const override { return mesh.num_faces(); }
  [[nodiscard]] std::size_t points() const override { return mesh.num_points(); }
  void read_faces(std::uint32_t* indices) const override {
    for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
      for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) *indices++ = corner.value();
  }
  [[nodiscard]] std::optional<std::size_t> width(std::uint32_t attribute) const override {
    const draco::PointAttribute* const found = mesh.GetAttributeByUniqueId(attribute);
    if (found == nullptr) return std::nullopt;
    return static_cast<std::size_t>(found->num_components());
  }
  [[nodiscard]] bool read(std::uint32_t attribute, relook::DracoComponent type, void* out) const override {
    const draco::PointAttribute& found = *mesh.GetAttributeByUniqueId(attribute);
    switch (type) {
      case relook::DracoComponent::i8:
        return read_as<std::int8_t>(found, points(), out);
      case relook::DracoComponent::u8:
        return read_as<std::uint8_t>(found, points(), out);
      case relook::DracoComponent::i16:
        return read_as<std::int16_t>(found, points(), out);
      case relook::DracoComponent::u16:
        return read_as<std::uint16_t>(found, points(), out);
      case relook::DracoComponent::u32:
        return read_as<std::uint32_t>(found, points(), out);
      case relook::DracoComponent::f32:
        return read_as<float>(found, points(), out);
    }
    return false;
  }
};

/// Every corner is a point.
bool is_sound(const draco::Mesh& mesh) {
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i)))
      if (corner.value() >= mesh.num_points()) return false;
  return true;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] relook::DracoResult relook_open_draco(std::span<const unsigned char> bytes,
                                                                                const relook::DracoLimits& limits) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header;
  draco::DecoderBuffer start = buffer;
  if (!draco::PointCloudDecoder::DecodeHeader(&start, &header).ok()) return {nullptr, "is no Draco data"};
  const std::string version = std::to_string(header.version_major) + "." + std::to_string(header.version_minor);
  if (DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor) > kVersion2_2)
    return {nullptr, "Draco data of version " + version + "; versions up to 2.2 are read", true};
  if (header.encoder_type != draco::TRIANGULAR_MESH) return {nullptr, "the Draco data is no mesh of triangles"};
  Gate gate(limits);
  const draco::DecoderOptions options;
  auto decoded = std::make_unique<DecodedMesh>();
  draco::Status status;
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
    status = SequentialDecoder(gate).Decode(options, &buffer, &decoded->mesh);
  } else if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    status = EdgebreakerDecoder(gate).Decode(options, &buffer, &decoded->mesh);
  } else {
    return {nullptr, "Draco data of an unknown method; sequential and edgebreaker are read", true};
  }
  if (!gate.error().empty()) return {nullptr, gate.error()};
  if (!status.ok() || !is_sound(decoded->mesh)) return {nullptr, "the Draco data is damaged"};
  return {std::move(decoded), ""};
}
