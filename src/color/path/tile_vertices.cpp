#include "color/path/tile_vertices.h"

namespace relook {

std::size_t TileVertices::bytes() const {
  std::size_t sum = (leaving.capacity() + crossing.capacity()) * sizeof(MetRay);
  for (const Batch& batch : batches)
    sum += batch.vertices.capacity() * sizeof(LitVertex) + batch.values.capacity() * sizeof(float) +
           batch.other_lobes.capacity() * sizeof(VertexLobes);
  return sum;
}

void TileVertices::shrink() {
  leaving.shrink_to_fit();
  crossing.shrink_to_fit();
  for (Batch& batch : batches) {
    batch.vertices.shrink_to_fit();
    batch.values.shrink_to_fit();
    batch.other_lobes.shrink_to_fit();
  }
}

}  // namespace relook
