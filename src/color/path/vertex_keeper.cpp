#include "color/path/vertex_keeper.h"

#include <algorithm>

#include "trace/shadow/shadow_segment.h"

namespace relook {
namespace {

class VertexKeeper {
 public:
  VertexKeeper(const ColorScene& scene, const ShadedVertices& shaded, PathRunner& runner, TileVertices& kept)
      : scene_(scene), shaded_(shaded), runner_(runner), kept_(kept) {}

  void run() {
    for (std::uint32_t i = 0; i < shaded_.block.nodes.size(); ++i) {
      const RayNode& node = shaded_.block.nodes[i];
      if (is_vertex(scene_, node)) keep_vertex(node, i);
      if (shaded_.weights[i] != Color(0, 0, 0)) keep_ray(node, i);
      if (!node.object.is_none()) ++kept_.hits;
    }
  }

 private:
  void keep_vertex(const RayNode& node, std::uint32_t i) {
    TileVertices::Batch& batch = batch_of(node);
    batch.columns = shaded_.column_count[i];
    const auto columns = shaded_.columns.subspan(shaded_.first_column[i], batch.columns);
    batch.values.insert(batch.values.end(), columns.begin(), columns.end());
    LitVertex& vertex = batch.vertices.emplace_back(shaded_.block, node);
    vertex.weight = shaded_.weights[i];
    vertex.scale = surface_scale(node);
    vertex.pixel = pixel_of(node);
    vertex.hit = kept_.hits;
    if (!vertex.has_lobes()) return;
    const VertexLobes& lobes = shaded_.block.lobes[node.lobes];
    if (vertex.lobes.holds(lobes)) return;
    vertex.other_lobes = static_cast<std::uint32_t>(batch.other_lobes.size());
    batch.other_lobes.push_back(lobes);
  }
  TileVertices::Batch& batch_of(const RayNode& node) {
    const BoundPathProgram& program =
        runner_.program(runner_.number_of(runner_.key_of(PathPiece::light, node.object, node.point.inside)));
    const auto found = std::ranges::find_if(kept_.batches, [&](const TileVertices::Batch& batch) {
      return batch.program.program == program.program && batch.program.material == program.material;
    });
    if (found != kept_.batches.end()) return *found;
    kept_.batches.emplace_back().program = program;
    return kept_.batches.back();
  }

  /// Shapes of lights do not show to the eye where a step is done from vertices.
  void keep_ray(const RayNode& node, std::uint32_t i) {
    const bool leaves = node.object.is_none();
    if (!leaves && (node.ray.path.is_eye || node.ray.path.is_shut)) return;
    MetRay& ray = (leaves ? kept_.leaving : kept_.crossing).emplace_back(node);
    ray.weight = shaded_.weights[i];
    ray.pixel = pixel_of(node);
  }
  [[nodiscard]] std::uint16_t pixel_of(const RayNode& node) const {
    return static_cast<std::uint16_t>(node.sample / shaded_.samples_of_pixel);
  }

  const ColorScene& scene_;
  const ShadedVertices& shaded_;
  PathRunner& runner_;
  TileVertices& kept_;
};

}  // namespace

bool is_vertex(const ColorScene& scene, const RayNode& node) {
  return !node.object.is_none() && is_lit(scene.object(node.object), node);
}

void keep_vertices(const ColorScene& scene, const ShadedVertices& shaded, PathRunner& runner, TileVertices& kept) {
  VertexKeeper(scene, shaded, runner, kept).run();
}

}  // namespace relook
