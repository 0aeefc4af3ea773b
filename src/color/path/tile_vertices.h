// The vertices of a tile as a light that moves, is resized, swapped or added needs them: hits that gather light, each
// with the columns that the programs of lights read, and rays that may meet lights. Made by PathShader while it adds
// terms of lights with the weights of kept rays; read by VertexShader for the next such step (replay/path). They hold
// until a sample's tree, or the colours of a surface in it, change.
#pragma once
#include <memory>
#include <vector>

#include "color/path/path_programs.h"
#include "trace/update/kept_vertices.h"

namespace relook {

struct TileVertices {
  /// Vertices that share a program.
  struct Batch {
    BoundPathProgram program;  // of lights
    std::size_t columns = 0;   // of each vertex
    std::vector<LitVertex> vertices;
    std::vector<float> values;             // [vertices * columns]
    std::vector<VertexLobes> other_lobes;  // where LitVertex does not hold them
  };
  std::vector<Batch> batches;
  std::vector<MetRay> leaving;   // rays that leave the scene
  std::vector<MetRay> crossing;  // others that may cross shapes of lights, but none of the eye's
  std::uint32_t hits = 0;        // of all paths

  [[nodiscard]] bool empty() const { return batches.empty() && leaving.empty() && crossing.empty() && hits == 0; }
  [[nodiscard]] std::size_t bytes() const;
  void shrink();
};

}  // namespace relook
