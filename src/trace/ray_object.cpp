#include "trace/ray_object.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/compile/compile_transform.h"
#include "scene/compile/deformation.h"
#include "scene/compile/displacement.h"
#include "trace/rounding.h"

namespace relook {
namespace {

Imath::M33f normal_matrix(const Transform& m) {
  // Cofactors of the linear part: the inverse transpose up to the determinant, whose sign is handled by `flipped`.
  const auto cofactor = [&](int r0, int c0, int r1, int c1) { return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0]; };
  return Imath::M33f(cofactor(1, 1, 2, 2), cofactor(1, 2, 2, 0), cofactor(1, 0, 2, 1),  //
                     cofactor(2, 1, 0, 2), cofactor(2, 2, 0, 0), cofactor(2, 0, 0, 1),  //
                     cofactor(0, 1, 1, 2), cofactor(0, 2, 1, 0), cofactor(0, 0, 1, 1));
}

float determinant(const Transform& m, const Imath::M33f& cofactors) {
  return m[0][0] * cofactors[0][0] + m[0][1] * cofactors[0][1] + m[0][2] * cofactors[0][2];
}

/// |M| |M^-1| / 3 in the Frobenius norm; the inverse is the transposed cofactors over the determinant.
float condition_number(const Transform& m, const Imath::M33f& cofactors, float det) {
  double linear = 0, inverse = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      linear += double{m[row][column]} * m[row][column];
      inverse += double{cofactors[row][column]} * cofactors[row][column];
    }
  const double condition = std::sqrt(linear) * std::sqrt(inverse) / (3 * std::fabs(double{det}));
  return condition < 1e6 ? static_cast<float>(std::max(condition, 1.0)) : 1e6F;  // singular ones too
}

/// Coincident hits: what is smaller lies upon what is larger, as decals do; among equals the name decides.
std::uint64_t tie_key(const Object& object, const Box& bounds) {
  constexpr unsigned kSizeBits = 16, kDroppedBits = 15;  // exponent and 8 bits of a positive float
  float size = 0;
  for (int axis = 0; axis < 3 && !bounds.isEmpty(); ++axis)
    for (int i = 0; i < 3; ++i) size += (bounds.max[i] - bounds.min[i]) * std::fabs(object.to_world[i][axis]);
  const std::uint64_t rank = std::bit_cast<std::uint32_t>(size) >> kDroppedBits;
  return rank << (64 - kSizeBits) | object.key >> kSizeBits;
}

/// The largest coordinates in a box by magnitude.
Point largest_in(const Box& bounds) {
  Point largest(0, 0, 0);
  for (int i = 0; i < 3; ++i) largest[i] = std::max(std::fabs(bounds.min[i]), std::fabs(bounds.max[i]));
  return largest;
}

/// Takes the extent along one direction out of a mesh. Its normals then follow from the triangles: across the sheet.
void flatten(Mesh& mesh, const Transform& along) {
  mesh.normals.clear(), mesh.tangents.clear(), mesh.targets.clear(), mesh.joints.clear(), mesh.joint_weights.clear();
  mesh.bounds.makeEmpty();
  for (Point& position : mesh.positions) {
    position = position * along;
    mesh.bounds.extendBy(position);
  }
}

/// Deformed, then displaced, then flattened.
Mesh shaped(const Mesh& mesh, const Object& object, const Transform* sheet) {
  Mesh bent = object.deformation ? deformed(mesh, *object.deformation) : Mesh();
  const Mesh& shape = object.deformation ? bent : mesh;
  Mesh result = object.displacement  ? displaced(shape, *object.displacement)
                : object.deformation ? std::move(bent)
                                     : mesh;
  if (sheet != nullptr) flatten(result, *sheet);
  return result;
}

}  // namespace

RayObject RayObjectMaker::make(const Scene& scene, const Object& object, std::shared_ptr<const Material> material) {
  RayObject ray_object;
  const bool is_sheet = object.alive && dimensions_of(object.to_world) == 2;
  const SheetTransform sheet = is_sheet ? sheet_transform(object.to_world) : SheetTransform{{}, object.to_world};
  ray_object.mesh = mesh_of(scene, object, is_sheet ? std::optional(sheet.flatten) : std::nullopt);
  ray_object.material_id = object.material;
  set_material(ray_object, std::move(material));
  ray_object.to_world = sheet.to_world;
  ray_object.normal_to_world = normal_matrix(sheet.to_world);
  const float det = determinant(sheet.to_world, ray_object.normal_to_world);
  ray_object.offset = rounding_offset(sheet.to_world, largest_in(ray_object.mesh->bounds));
  ray_object.flipped = det < 0;
  ray_object.condition = condition_number(sheet.to_world, ray_object.normal_to_world, det);
  ray_object.alive = object.alive;
  ray_object.key = tie_key(object, ray_object.mesh->bounds);
  return ray_object;
}

void RayObjectMaker::drop_unused() {
  std::erase_if(derived_, [](const auto& known) { return known.second.result.expired(); });
}

void RayObjectMaker::set_material(RayObject& object, std::shared_ptr<const Material> material) {
  object.material = std::move(material);
  object.optics = surface_optics(*object.material, *object.mesh);
  object.blurs = integrator_ == Integrator::path && object.optics.refracts && relook::blurs(*object.material);
  object.turns = object.optics.bent || object.blurs || (object.optics.refracts && dims_otherwise(*object.material));
  const Mesh& mesh = *object.mesh;
  for (std::uint8_t set = 0; set < object.tangents.size(); ++set) {
    const auto needs = [&](Slot which) {
      const TextureSlot& slot = object.material->slot(which);
      return slot.kind != TextureKind::none && slot.mapping == Mapping::uv && slot.texcoord == set;
    };
    const TextureSlot& brush = object.material->slot(Slot::anisotropy);
    const bool is_brushed = object.material->anisotropy > 0 && brush.mapping == Mapping::uv && brush.texcoord == set;
    const bool has_all = !mesh.normals.empty() && mesh.tangents.empty() && !mesh.uv[set].empty();
    object.tangents[set] =
        has_all && (is_brushed || needs(Slot::normal) || needs(Slot::clearcoat_normal)) ? tangents_of(object.mesh, set)
                                                                                        : nullptr;
  }
}

std::shared_ptr<const CornerTangents> RayObjectMaker::tangents_of(const std::shared_ptr<const Mesh>& mesh,
                                                                  std::uint8_t texcoord) {
  const std::pair key(mesh.get(), texcoord);
  if (const auto known = derived_.find(key); known != derived_.end() && known->second.mesh.lock() == mesh)
    if (auto result = known->second.result.lock()) return result;
  auto result = std::make_shared<const CornerTangents>(derive_tangents(*mesh, texcoord));
  derived_.insert_or_assign(key, Derived{mesh, result});
  return result;
}

std::shared_ptr<const Mesh> RayObjectMaker::mesh_of(const Scene& scene, const Object& object,
                                                    const std::optional<Transform>& sheet) {
  const Mesh& mesh = scene.mesh(object.mesh);
  if ((!object.deformation && !object.displacement && !sheet) || !object.alive) return {scene.assets, &mesh};
  std::vector<Shaped>& of_mesh = shaped_[object.mesh];
  std::erase_if(of_mesh, [](const Shaped& known) { return known.result.expired(); });
  for (const Shaped& known : of_mesh)
    if (known.deformation == object.deformation && known.displacement == object.displacement && known.sheet == sheet)
      if (auto result = known.result.lock()) return result;
  auto result = std::make_shared<const Mesh>(shaped(mesh, object, sheet ? &*sheet : nullptr));
  of_mesh.push_back({object.deformation, object.displacement, sheet, result});
  return result;
}

}  // namespace relook
