#include "scene/look/counted_assets.h"

#include "base/import_memory.h"

namespace relook {
namespace {

struct AssetsDeleter {
  std::shared_ptr<ImportShare> share = std::make_shared<ImportShare>();
  void operator()(const Assets* assets) const { delete assets; }
};

std::uint64_t geometry_bytes(const LookDocument& document) {
  std::uint64_t bytes = 0;
  const auto add = [&](const auto& column) { bytes += column.size() * sizeof column[0]; };
  for (const Mesh& mesh : document.assets->meshes) {
    add(mesh.positions), add(mesh.triangles), add(mesh.normals), add(mesh.tangents), add(mesh.colors);
    for (const auto& uv : mesh.uv) add(uv);
    add(mesh.targets), add(mesh.joints), add(mesh.joint_weights);
    for (const MorphTarget& target : mesh.targets) add(target.positions), add(target.normals), add(target.tangents);
  }
  for (const auto& [node, matrices] : document.instances) add(matrices);
  for (const auto& [skin, matrices] : document.inverse_binds) add(matrices);
  return bytes;
}

}  // namespace

std::shared_ptr<Assets> counted_assets() { return {new Assets, AssetsDeleter()}; }

void count_geometry(const LookDocument& document) {
  const auto* deleter = std::get_deleter<AssetsDeleter>(document.assets);
  if (deleter == nullptr) return;
  *deleter->share = ImportShare();  // given back by the temporary
  *deleter->share = ImportShare(geometry_bytes(document), document.file, "the geometry");
}

}  // namespace relook
