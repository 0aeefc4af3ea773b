// KHR_draco_mesh_compression: primitives whose indices and attributes are one compressed mesh.
#include <algorithm>
#include <cstring>
#include <exception>
#include <map>
#include <tuple>

#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/import_rules.h"
#include "scene/gltf/packed/gltf_unpack.h"
#include "scene/gltf/packed/mesh_library.h"

namespace relook {
namespace {

constexpr std::string_view kExtension = "KHR_draco_mesh_compression";

/// A primitive that names the Draco data.
struct DracoUse {
  JsonView place;   // of the primitive
  JsonView packed;  // of its extension
  GltfPrimitive* primitive;
  std::size_t mesh;
  std::map<std::string, std::uint32_t> attributes;  // that the primitive has, too, and relook may read
  std::size_t indices;                              // accessor
};

/// Whether relook may read an attribute: a file may name attributes of its own ("_NAME"), of any type.
bool is_readable(const std::string& name, const GltfAccessor& accessor) {
  return !name.starts_with('_') && accessor.width >= 1 && accessor.width <= 4;
}

DracoUse use_of(const JsonView& place, const JsonView& packed, const GltfModel& model, std::size_t mesh,
                GltfPrimitive& primitive) {
  const auto indices = optional_reference(place, "indices", model.accessors.size(), "accessor");
  if (!indices) place.fail("Draco data needs an accessor of indices");
  if (primitive.mode > 5) place.at("mode").fail("Draco data holds triangles and strips alone");
  DracoUse use{place, packed, &primitive, mesh, {}, *indices};
  const JsonView attributes = packed.at("attributes");
  for (const auto& [name, id] : attributes.value().items())
    if (const auto found = primitive.attributes.find(name); found != primitive.attributes.end())
      if (is_readable(name, model.accessors[found->second])) use.attributes.emplace(name, id.get<std::uint32_t>());
  return use;
}

/// The primitives that name Draco data, by buffer view, in their order.
std::map<std::size_t, std::vector<DracoUse>> uses_of(const JsonView& root, GltfModel& model) {
  std::map<std::size_t, std::vector<DracoUse>> uses;
  for_each_object(root, "meshes", [&](const JsonView& mesh, std::size_t m) {
    for_each_object(mesh, "primitives", [&](const JsonView& place, std::size_t p) {
      GltfPrimitive& primitive = model.meshes[m][p];
      const auto packed = draco_extension(place);
      if (!packed || primitive.mode < 4) return;
      const std::size_t view = reference(packed->at("bufferView"), model.views.size(), "buffer view");
      uses[view].push_back(use_of(place, *packed, model, m, primitive));
    });
  });
  return uses;
}

std::uint64_t declared_faces(const DracoUse& use, const GltfModel& model) {
  const std::uint64_t indices = model.accessors[use.indices].count;
  return use.primitive->mode == 5 ? indices : indices / 3;  // a strip's indices are as many as its triangles, and two
}

/// The most that any of the primitives declares. Encoders split vertices at seams and forget to say so: as many as
/// corners are allowed.
DracoLimits limits_of(const std::vector<DracoUse>& uses, const GltfModel& model) {
  DracoLimits limits;
  for (const DracoUse& use : uses) {
    limits.faces = std::max(limits.faces, declared_faces(use, model));
    for (const auto& [name, accessor] : use.primitive->attributes)
      limits.points = std::max<std::uint64_t>(limits.points, model.accessors[accessor].count);
  }
  limits.points = std::max(limits.points, 3 * limits.faces);
  return limits;
}

/// Whether all that the extension stands for is there without it, too.
bool has_plain_data(const DracoUse& use, const GltfModel& model) {
  const auto has_data = [&](std::size_t accessor) {
    return model.accessors[accessor].view != kNoIndex && data_fault(model, model.accessors[accessor]).empty();
  };
  return has_data(use.indices) && std::ranges::all_of(use.attributes, [&](const auto& attribute) {
           return has_data(use.primitive->attributes.at(attribute.first));
         });
}

/// One Draco mesh, and what was made of it in the model.
class DracoSource {
 public:
  DracoSource(GltfModel& model, const DracoMesh& mesh, ImportShare& share)
      : model_(model), mesh_(mesh), share_(share) {}

  void give(const DracoUse& use, std::vector<std::string>& warnings) {
    warn_of_counts(use, warnings);
    for (const auto& [name, id] : use.attributes) {
      const JsonView place = use.packed.at("attributes").at(name);
      std::size_t& accessor = use.primitive->attributes.at(name);
      accessor = column(id, model_.accessors[accessor], place);
    }
    for (const auto& [name, accessor] : use.primitive->attributes)
      if (model_.accessors[accessor].view == kNoIndex && model_.accessors[accessor].sparse_count == 0)
        use.place.at("attributes").at(name).fail("neither the Draco data nor a buffer view gives this attribute");
    for (const auto& [name, accessor] : use.primitive->attributes)
      if (is_readable(name, model_.accessors[accessor]) && model_.accessors[accessor].count != mesh_.points())
        use.place.at("attributes")
            .at(name)
            .fail("has " + std::to_string(model_.accessors[accessor].count) +
                  " elements, the Draco data of the primitive has " + std::to_string(mesh_.points()) + " vertices");
    use.primitive->indices = indices(use.packed);
    use.primitive->mode = 4;
  }

 private:
  /// What the encoder kept counts, not what the accessors say.
  void warn_of_counts(const DracoUse& use, std::vector<std::string>& warnings) const {
    const std::uint64_t faces = declared_faces(use, model_);
    if (mesh_.faces() > faces)
      use.packed.fail("the Draco data has " + std::to_string(mesh_.faces()) + " triangles, the indices are " +
                      std::to_string(model_.accessors[use.indices].count));
    bool is_other = use.primitive->mode == 4 && mesh_.faces() < faces;
    for (const auto& [name, id] : use.attributes)
      is_other = is_other || mesh_.points() != model_.accessors[use.primitive->attributes.at(name)].count;
    if (is_other)
      warnings.push_back(use.packed.pointer() + ": the Draco data has " + std::to_string(mesh_.faces()) +
                         " triangles and " + std::to_string(mesh_.points()) + " vertices, its accessors say otherwise");
  }

  /// `declared`: a copy, since the model's accessors grow.
  std::size_t column(std::uint32_t id, const GltfAccessor declared, const JsonView& place) {
    const auto width = mesh_.width(id);
    if (!width) place.fail("the Draco data has no attribute " + std::to_string(id));
    if (*width != declared.width)
      place.fail("the Draco data has " + std::to_string(*width) + " numbers a vertex, the accessor has " +
                 std::to_string(declared.width));
    const auto [found, is_new] =
        columns_.try_emplace({id, declared.component, declared.normalized}, model_.accessors.size());
    if (!is_new) return found->second;
    GltfAccessor accessor;
    accessor.component = declared.component;
    accessor.normalized = declared.normalized;
    accessor.width = declared.width;
    const std::size_t number = component_bytes(declared.component);
    unsigned char* const bytes = add(accessor, mesh_.points(), number * declared.width, place);
    if (!mesh_.read(id, static_cast<DracoComponent>(declared.component), bytes))
      place.fail("the values of the Draco data are damaged, or not of the accessor's type");
    return found->second;
  }

  std::size_t indices(const JsonView& place) {
    if (indices_ != kNoIndex) return indices_;
    indices_ = model_.accessors.size();
    GltfAccessor accessor;
    accessor.component = Component::u32;
    std::vector<std::uint32_t> values(3 * mesh_.faces());
    mesh_.read_faces(values.data());
    unsigned char* const bytes = add(accessor, values.size(), sizeof(std::uint32_t), place);
    if (!values.empty()) std::memcpy(bytes, values.data(), values.size() * sizeof(std::uint32_t));
    return indices_;
  }

  /// An accessor of a buffer of its own; returns the bytes to fill.
  unsigned char* add(GltfAccessor accessor, std::size_t count, std::size_t element_bytes, const JsonView& place) {
    share_.add(ImportShare(bounded_product(count, element_bytes), place.file(), place.pointer() + ": the Draco data"));
    accessor.view = model_.views.size();
    accessor.count = count;
    model_.views.push_back({model_.buffers.size(), 0, count * element_bytes, 0});
    model_.accessors.push_back(accessor);
    return model_.buffers.emplace_back(count * element_bytes).data();
  }

  GltfModel& model_;
  const DracoMesh& mesh_;
  ImportShare& share_;
  std::map<std::tuple<std::uint32_t, Component, bool>, std::size_t> columns_;  // accessors
  std::size_t indices_ = kNoIndex;
};

void unpack(std::size_t view, const std::vector<DracoUse>& uses, GltfModel& model, std::vector<std::string>& warnings,
            ImportShare& share) {
  const JsonView place = uses.front().packed;
  const auto [buffer, offset, length, stride] = model.views[view];  // a copy: views are added below
  if (model.buffers[buffer].empty()) place.at("bufferView").fail("the buffer of this buffer view has no data");
  DracoLimits limits = limits_of(uses, model);
  ImportShare working;
  std::uint64_t held = 0;
  std::exception_ptr refusal;  // Draco's own frames see none
  std::string growth;
  limits.may_hold = [&](std::uint64_t bytes) {
    constexpr std::uint64_t kAlwaysFine = std::uint64_t{256} << 20, kMostGrowth = 1024;
    held = bounded_sum(held, bytes);
    if (held > kAlwaysFine + kMostGrowth * length) {
      growth = "the Draco data of " + std::to_string(length) + " bytes needs " + std::to_string(held >> 20) + " MB";
      return false;
    }
    try {
      working.add(ImportShare(bytes, place.file(), place.pointer() + ": the Draco data"));
    } catch (...) {
      refusal = std::current_exception();
    }
    return refusal == nullptr;
  };
  const DracoResult result = open_draco(std::span(model.buffers[buffer]).subspan(offset, length), limits);
  if (refusal) std::rethrow_exception(refusal);
  if (!growth.empty()) place.fail(growth);
  if (result.mesh) {
    DracoSource source(model, *result.mesh, share);
    for (const DracoUse& use : uses) source.give(use, warnings);
    return;
  }
  for (const DracoUse& use : uses) {
    if (!result.is_newer) use.packed.fail(result.error);
    if (!has_plain_data(use, model)) use.packed.fail(result.error + "; " + std::string(kUnpackCommand));
    warnings.push_back(use.packed.pointer() + ": " + result.error + ": the uncompressed data is read");
    use.primitive->indices = use.indices;
  }
}

}  // namespace

std::optional<JsonView> draco_extension(const JsonView& primitive) { return extension(primitive, kExtension); }

void unpack_draco(const JsonView& root, GltfModel& model, const GltfUse& use, std::vector<std::string>& warnings,
                  ImportShare& share) {
  for (const auto& [view, uses] : uses_of(root, model)) {
    const bool is_needed = std::ranges::any_of(uses, [&](const DracoUse& one) { return use.meshes[one.mesh]; });
    try {
      unpack(view, uses, model, warnings, share);
    } catch (const InputError&) {
      if (is_needed) throw;
      const JsonView& place = uses.front().packed;
      tolerate(place.file(), place.pointer(), "the Draco data cannot be read; the scene does not use it: ignored",
               warnings);
      for (const DracoUse& one : uses) one.primitive->attributes.erase("POSITION");
    }
  }
}

}  // namespace relook
