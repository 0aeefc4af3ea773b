#include "color/path/path_programs.h"

#include <mutex>

#include "color/expression/gather.h"
#include "color/path/path_surface.h"

namespace relook {
namespace {

Kernel build_kernel(const Scene& scene, const MaterialStructure& structure, const PathKey& key) {
  ExpressionBuilder builder(scene, structure);
  NodeKey node;
  node.kind = key.piece == PathPiece::filter ? NodeKind::filter : NodeKind::surface;
  node.inside = key.inside;
  node.vertex_colors = key.vertex_colors;
  node.interface_only = key.interface_only;
  node.children = key.children;
  SurfaceTerms terms(builder, node);
  std::vector<Value> outputs;
  for (const Triple& column : path_columns(terms, key))
    for (const Scalar& channel : {column.x, column.y, column.z}) outputs.push_back(channel.value);
  return make_kernel(builder.code(), outputs);
}

}  // namespace

BoundPathProgram PathPrograms::get(const Scene& scene, const PathKey& key) {
  {
    const std::shared_lock lock(mutex_);
    const auto it = bound_.find(key);
    if (it != bound_.end()) return it->second;
  }
  Shape shape{structure_of(scene.material(key.material)), key};
  shape.second.material = MaterialId::none();
  const std::unique_lock lock(mutex_);
  auto& kernel = kernels_[shape];
  if (!kernel) kernel = std::make_unique<const Kernel>(build_kernel(scene, shape.first, shape.second));
  return bound_.try_emplace(key, BoundPathProgram{kernel.get(), key.material}).first->second;
}

void PathPrograms::forget(MaterialId material) {
  std::erase_if(bound_, [&](const auto& entry) { return entry.first.material == material; });
}

void PathBatch::load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters& parameters,
                     Scratch& scratch) const {
  if (step.op == Op::input && step.payload.input() >= Input::light_direction) {
    const std::uint32_t axis = step.payload.axis();
    float* out = scratch.own(step.out);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const LightTerm& term = *terms[first + lane];
      out[lane] = step.payload.input() == Input::light_direction ? term.way[static_cast<int>(axis)]
                  : step.payload.input() == Input::light_weight  ? term.weights[axis]
                                                                 : term.radiance[static_cast<int>(axis)];
    }
    return;
  }
  static const BlockColors kNoColors;
  NodeBatch{scene, block, kNoColors, are_filters, hits}.load(step, first, lanes, parameters, scratch);
}

}  // namespace relook
