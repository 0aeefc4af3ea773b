// EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are compressed.
#include <algorithm>
#include <array>
#include <map>

#include "base/error.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/import_rules.h"
#include "scene/gltf/packed/gltf_unpack.h"
#include "scene/gltf/packed/mesh_library.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 2> kExtensions{"EXT_meshopt_compression", "KHR_meshopt_compression"};

const std::map<std::string_view, MeshoptMode> kModes{
    {"ATTRIBUTES", MeshoptMode::attributes}, {"TRIANGLES", MeshoptMode::triangles}, {"INDICES", MeshoptMode::indices}};
const std::map<std::string_view, MeshoptFilter> kFilters{{"NONE", MeshoptFilter::none},
                                                         {"OCTAHEDRAL", MeshoptFilter::octahedral},
                                                         {"QUATERNION", MeshoptFilter::quaternion},
                                                         {"EXPONENTIAL", MeshoptFilter::exponential}};

/// What the first byte of a stream says of it: its codec, and the versions of that which are read.
struct Codec {
  unsigned char tag;
  unsigned versions;  // below this
};
Codec codec_of(MeshoptMode mode) {
  if (mode == MeshoptMode::attributes) return {0xA0, 1};
  return {static_cast<unsigned char>(mode == MeshoptMode::triangles ? 0xE0 : 0xD0), 2};
}

/// One compressed view. Counts are as declared.
struct PackedView {
  JsonView place;  // of the extension
  MeshoptStream stream;
  std::size_t length = 0, stride = 0;  // of the view, bytes; stride 0: none
};

void check_stride(const PackedView& packed) {
  const auto& [bytes, count, stride, mode, filter] = packed.stream;
  const JsonView place = packed.place.at("byteStride");
  if (mode == MeshoptMode::attributes) {
    if (stride % 4 != 0) place.fail("must be a multiple of 4");
    if (packed.stride != 0 && packed.stride != stride)
      place.fail("is " + std::to_string(stride) + ", that of the buffer view is " + std::to_string(packed.stride));
  } else if (stride != 2 && stride != 4) {
    place.fail("indices have 2 or 4 bytes");
  }
  if (mode == MeshoptMode::triangles && count % 3 != 0) packed.place.at("count").fail("triangles have three indices");
  if (filter == MeshoptFilter::none) return;
  if (mode != MeshoptMode::attributes) packed.place.at("filter").fail("only attributes are filtered");
  if ((filter == MeshoptFilter::octahedral && stride != 4 && stride != 8) ||
      (filter == MeshoptFilter::quaternion && stride != 8))
    place.fail("the filter does not have this stride");
}

/// What is declared must be what the view holds, and not more than so many bytes can say: an attribute needs two bits
/// for 16 elements of a byte, three indices a byte.
void check_size(const PackedView& packed) {
  const MeshoptStream& stream = packed.stream;
  const std::uint64_t unpacked = bounded_product(stream.count, stream.stride);
  if (unpacked < packed.length && packed.length - unpacked > 3)
    packed.place.fail("unpacks to " + std::to_string(unpacked) + " bytes, its buffer view has " +
                      std::to_string(packed.length));
  constexpr std::uint64_t kMostGrowth = 64, kIndicesPerByte = 3;
  const std::uint64_t most = stream.mode == MeshoptMode::attributes ? kMostGrowth * stream.bytes.size() / stream.stride
                                                                    : kIndicesPerByte * stream.bytes.size();
  if (stream.count > most)
    packed.place.at("count").fail(std::to_string(stream.count) + " elements do not fit " +
                                  std::to_string(stream.bytes.size()) + " bytes");
}

/// Empty, or what the decoder does not know of the stream.
std::string newer_part(const JsonView& place, std::span<const unsigned char> bytes) {
  const std::string mode = place.at("mode").text();
  const auto filter = member(place, "filter");
  const std::string filter_name = filter ? filter->text() : "NONE";
  if (!kModes.contains(mode))
    return "mode " + printable(mode) + " is not supported; ATTRIBUTES, TRIANGLES and INDICES are";
  if (!kFilters.contains(filter_name))
    return "filter " + printable(filter_name) + " is not supported; OCTAHEDRAL, QUATERNION and EXPONENTIAL are";
  const Codec codec = codec_of(kModes.at(mode));
  const unsigned version = bytes[0] & 0x0FU;
  if ((bytes[0] & 0xF0U) == codec.tag && version >= codec.versions)
    return "version " + std::to_string(version) + " of the codec of " + mode + " is not supported; versions below " +
           std::to_string(codec.versions) + " are";
  return "";
}

std::span<const unsigned char> packed_bytes(const GltfModel& model, const JsonView& place) {
  const auto& buffer = model.buffers[static_cast<std::size_t>(place.at("buffer").integer(0, INT64_MAX))];
  if (buffer.empty()) place.at("buffer").fail("the buffer has no data");
  const std::size_t offset =
      place.has("byteOffset") ? static_cast<std::size_t>(place.at("byteOffset").integer(0, INT64_MAX)) : 0;
  return std::span(buffer).subspan(offset, static_cast<std::size_t>(place.at("byteLength").integer(1, INT64_MAX)));
}

void unpack_view(const JsonView& place, std::size_t number, GltfModel& model, std::vector<std::string>& warnings,
                 ImportShare& share) {
  GltfBufferView& view = model.views[number];
  PackedView packed{place, {packed_bytes(model, place)}, view.length, view.stride};
  if (const std::string part = newer_part(place, packed.stream.bytes); !part.empty()) {
    if (model.buffers[view.buffer].empty()) place.fail(part + "; " + std::string(kUnpackCommand));
    warnings.push_back(place.pointer() + ": " + part + ": the uncompressed data of the buffer view is read");
    return;
  }
  packed.stream.mode = kModes.at(place.at("mode").text());
  if (const auto filter = member(place, "filter")) packed.stream.filter = kFilters.at(filter->text());
  packed.stream.count = static_cast<std::size_t>(place.at("count").integer(1, INT64_MAX));
  packed.stream.stride = static_cast<std::size_t>(place.at("byteStride").integer(1, INT64_MAX));
  check_stride(packed);
  check_size(packed);
  const std::size_t bytes = std::max(packed.stream.count * packed.stream.stride, view.length);
  share.add(ImportShare(bytes, place.file(), place.pointer() + ": the buffer view"));
  std::vector<unsigned char> unpacked(bytes);
  if (!unpack_meshopt(packed.stream, unpacked.data())) place.fail("the compressed data is damaged");
  view.buffer = model.buffers.size();
  view.offset = 0;
  model.buffers.push_back(std::move(unpacked));
}

/// A reference that is wrong is for whoever reads it to say.
void add_named(const JsonView& owner, std::string_view key, bool is_needed, const GltfModel& model,
               std::vector<ReadAccessor>& accessors) {
  if (!owner.has(key)) return;
  const Json& index = owner.at(key).value();
  if (index.is_number_unsigned() && index.get<std::uint64_t>() < model.accessors.size())
    accessors.push_back({index.get<std::size_t>(), is_needed});
}

}  // namespace

std::optional<JsonView> meshopt_extension(const JsonView& view) {
  for (const std::string_view name : kExtensions)
    if (auto found = extension(view, name)) return found;
  return std::nullopt;
}

void unpack_meshopt(const JsonView& root, GltfModel& model, const std::vector<ReadAccessor>& accessors,
                    std::vector<std::string>& warnings, ImportShare& share) {
  std::vector<bool> is_read(array_size(root, "bufferViews"), false), is_needed(is_read.size(), false);
  for (const ReadAccessor& read : accessors) {
    const GltfAccessor& accessor = model.accessors[read.index];
    const auto mark = [&](std::size_t view) {
      if (view >= is_read.size()) return;
      is_read[view] = true;
      if (read.is_needed) is_needed[view] = true;
    };
    mark(accessor.view);
    if (accessor.sparse_count > 0) mark(accessor.sparse_index_view), mark(accessor.sparse_value_view);
  }
  for (std::size_t i = 0; i < is_read.size(); ++i) {
    if (!is_read[i]) continue;
    const auto place = meshopt_extension(root.at("bufferViews").at(i));
    if (!place) continue;
    try {
      unpack_view(*place, i, model, warnings, share);
    } catch (const InputError&) {
      if (is_needed[i]) throw;
      tolerate(place->file(), place->pointer(), "the data cannot be read; the scene does not use it: ignored",
               warnings);
      model.views[i].buffer = model.buffers.size();
      model.buffers.emplace_back();
    }
  }
}

std::vector<ReadAccessor> accessors_of_scene(const JsonView& root, const GltfModel& model, const GltfUse& use) {
  std::vector<ReadAccessor> accessors;
  for (std::size_t m = 0; m < model.meshes.size(); ++m)
    for (std::size_t p = 0; p < model.meshes[m].size(); ++p) {
      const GltfPrimitive& primitive = model.meshes[m][p];
      if (primitive.mode < 4) continue;
      const auto add_all = [&](const GltfAttributes& attributes) {
        for (const auto& [name, accessor] : attributes)
          if (!name.starts_with('_')) accessors.push_back({accessor, use.reads(m, p, name)});
      };
      add_all(primitive.attributes);
      for (const GltfAttributes& target : primitive.targets) add_all(target);
      if (primitive.indices != kNoIndex) accessors.push_back({primitive.indices, use.meshes[m]});
    }
  for_each_object(root, "skins", [&](const JsonView& skin, std::size_t i) {
    add_named(skin, "inverseBindMatrices", use.skins[i], model, accessors);
  });
  for_each_object(root, "nodes", [&](const JsonView& node, std::size_t i) {
    const auto instances = extension(node, "EXT_mesh_gpu_instancing");
    if (!instances || !instances->has("attributes") || !instances->at("attributes").value().is_object()) return;
    const JsonView attributes = instances->at("attributes");
    for (const auto& [name, index] : attributes.value().items())
      add_named(attributes, name, use.nodes[i], model, accessors);
  });
  return accessors;
}

std::vector<ReadAccessor> accessors_of_animations(const JsonView& root, const GltfModel& model) {
  std::vector<ReadAccessor> accessors;
  for_each_object(root, "animations", [&](const JsonView& animation, std::size_t) {
    for_each_object(animation, "samplers", [&](const JsonView& sampler, std::size_t) {
      add_named(sampler, "input", true, model, accessors);
      add_named(sampler, "output", true, model, accessors);
    });
  });
  return accessors;
}

}  // namespace relook
