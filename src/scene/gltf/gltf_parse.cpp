// The only file that sees tinygltf. It parses a copy of the checked document that is reduced to geometry: without
// extras and extensions, whose generic values cost hundreds of bytes each, and with buffers that are served from
// memory, so that no path of a scene ever reaches a library.
#include <tiny_gltf.h>

#include <charconv>
#include <exception>

#include "base/error.h"
#include "scene/gltf/gltf_model.h"
#include "scene/gltf/packed/gltf_unpack.h"

namespace relook {
namespace {

using BufferTable = std::vector<std::vector<unsigned char>>;

/// tinygltf refuses empty files: a placeholder goes in as one byte.
std::size_t buffer_bytes(const std::vector<unsigned char>& buffer) { return buffer.empty() ? 1 : buffer.size(); }

/// Members of `object` named in `keys`.
Json reduced(const Json& object, std::initializer_list<const char*> keys) {
  Json copy = Json::object();
  for (const char* key : keys)
    if (const auto found = object.find(key); found != object.end()) copy[key] = *found;
  return copy;
}

Json reduced_array(const Json& gltf, const char* key, std::initializer_list<const char*> keys) {
  Json copy = Json::array();
  if (const auto found = gltf.find(key); found != gltf.end())
    for (const Json& entry : *found) copy.push_back(reduced(entry, keys));
  return copy;
}

Json geometry_document(const Json& gltf, const BufferTable& buffers) {
  Json document = Json::object();
  document["asset"] = {{"version", "2.0"}};
  document["buffers"] = Json::array();
  for (std::size_t i = 0; i < buffers.size(); ++i)
    document["buffers"].push_back({{"byteLength", buffer_bytes(buffers[i])}, {"uri", std::to_string(i)}});
  document["bufferViews"] = reduced_array(gltf, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"});
  document["accessors"] = reduced_array(
      gltf, "accessors", {"bufferView", "byteOffset", "componentType", "count", "normalized", "sparse", "type"});
  for (Json& accessor : document["accessors"])
    if (const auto sparse = accessor.find("sparse"); sparse != accessor.end())
      *sparse = {{"count", (*sparse)["count"]},
                 {"indices", reduced((*sparse)["indices"], {"bufferView", "byteOffset", "componentType"})},
                 {"values", reduced((*sparse)["values"], {"bufferView", "byteOffset"})}};
  document["meshes"] = Json::array();
  if (const auto meshes = gltf.find("meshes"); meshes != gltf.end())
    for (const Json& mesh : *meshes) {
      Json primitives = Json::array();
      for (const Json& primitive : mesh["primitives"])  // tinygltf refuses indices without a view, which Draco data has
        primitives.push_back(draco_extension(JsonView(primitive, ""))
                                 ? reduced(primitive, {"attributes", "mode", "targets"})
                                 : reduced(primitive, {"attributes", "indices", "mode", "targets"}));
      document["meshes"].push_back({{"primitives", std::move(primitives)}});
    }
  return document;
}

std::vector<unsigned char>* buffer_named(const std::string& name, void* table) {
  auto& buffers = *static_cast<BufferTable*>(table);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  const bool is_name = error == std::errc() && end == name.data() + name.size();
  return is_name && index < buffers.size() ? &buffers[index] : nullptr;
}

tinygltf::FsCallbacks memory_callbacks(BufferTable& buffers) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string& name, void* table) { return buffer_named(name, table) != nullptr; };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& name, void* table) {
    auto* buffer = buffer_named(name, table);
    if (buffer == nullptr) return false;
    *out = buffer->empty() ? std::vector<unsigned char>(1) : std::move(*buffer);
    return true;
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  callbacks.user_data = &buffers;
  return callbacks;
}

std::size_t index_of(int index) { return index < 0 ? kNoIndex : static_cast<std::size_t>(index); }

GltfAccessor accessor_of(const tinygltf::Accessor& parsed) {
  GltfAccessor accessor;
  accessor.view = index_of(parsed.bufferView);
  accessor.offset = parsed.byteOffset;
  accessor.count = parsed.count;
  accessor.component = static_cast<Component>(parsed.componentType);
  switch (parsed.type) {
    case TINYGLTF_TYPE_SCALAR:
      accessor.width = 1;
      break;
    case TINYGLTF_TYPE_VEC2:
      accessor.width = 2;
      break;
    case TINYGLTF_TYPE_VEC3:
      accessor.width = 3;
      break;
    case TINYGLTF_TYPE_VEC4:
      accessor.width = 4;
      break;
    case TINYGLTF_TYPE_MAT4:
      accessor.width = 16;
      break;
    default:
      accessor.width = 0;
  }
  accessor.normalized = parsed.normalized;
  if (!parsed.sparse.isSparse) return accessor;
  accessor.sparse_count = static_cast<std::size_t>(parsed.sparse.count);
  accessor.sparse_index_view = index_of(parsed.sparse.indices.bufferView);
  accessor.sparse_index_offset = static_cast<std::size_t>(parsed.sparse.indices.byteOffset);
  accessor.sparse_index_component = static_cast<Component>(parsed.sparse.indices.componentType);
  accessor.sparse_value_view = index_of(parsed.sparse.values.bufferView);
  accessor.sparse_value_offset = static_cast<std::size_t>(parsed.sparse.values.byteOffset);
  return accessor;
}

GltfPrimitive primitive_of(const tinygltf::Primitive& parsed) {
  GltfPrimitive primitive;
  for (const auto& [name, index] : parsed.attributes) primitive.attributes[name] = index_of(index);
  for (const auto& target : parsed.targets) {
    GltfAttributes& attributes = primitive.targets.emplace_back();
    for (const auto& [name, index] : target) attributes[name] = index_of(index);
  }
  primitive.indices = index_of(parsed.indices);
  primitive.mode = parsed.mode;
  return primitive;
}

GltfModel model_of(tinygltf::Model parsed) {
  GltfModel model;
  for (auto& buffer : parsed.buffers) model.buffers.push_back(std::move(buffer.data));
  for (const auto& view : parsed.bufferViews)
    model.views.push_back({index_of(view.buffer), view.byteOffset, view.byteLength, view.byteStride});
  for (const auto& accessor : parsed.accessors) model.accessors.push_back(accessor_of(accessor));
  for (const auto& mesh : parsed.meshes) {
    auto& primitives = model.meshes.emplace_back();
    for (const auto& primitive : mesh.primitives) primitives.push_back(primitive_of(primitive));
  }
  return model;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

GltfModel parse_model(const Json& gltf, std::vector<std::vector<unsigned char>> buffers, std::string_view file) {
  const std::string text = geometry_document(gltf, buffers).dump();
  if (text.size() > std::numeric_limits<unsigned int>::max()) throw InputError(file, "", "is too large");
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks(memory_callbacks(buffers));
  tinygltf::Model parsed;
  std::vector<bool> is_placeholder;
  for (const auto& buffer : buffers) is_placeholder.push_back(buffer.empty());
  std::string error, warning;
  bool is_parsed = false;
  try {
    is_parsed = parser.LoadASCIIFromString(&parsed, &error, &warning, text.data(),
                                           static_cast<unsigned int>(text.size()), "", 0);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  if (!is_parsed) throw InputError(file, "", error.empty() ? "tinygltf refuses the file" : first_line(error));
  GltfModel model = model_of(std::move(parsed));
  for (std::size_t i = 0; i < model.buffers.size(); ++i)
    if (is_placeholder[i]) model.buffers[i].clear();
  return model;
}

}  // namespace relook
