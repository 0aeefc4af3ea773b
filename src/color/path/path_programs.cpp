#include "color/path/path_programs.h"

#include <mutex>

#include "color/expression/columns.h"
#include "color/expression/gather.h"
#include "color/path/path_surface.h"

namespace relook {
namespace {

/// The channels of a piece's columns, as values of the builder's code.
std::vector<Value> add_piece(ExpressionBuilder& builder, const PathKey& key) {
  NodeKey node;
  node.kind = key.piece == PathPiece::filter ? NodeKind::filter : NodeKind::surface;
  node.inside = key.inside;
  node.vertex_colors = key.vertex_colors;
  node.interface_only = key.interface_only;
  node.children = key.children;
  SurfaceTerms terms(builder, node);
  std::vector<Value> channels;
  for (const Triple& column : path_columns(terms, key))
    for (const Scalar& channel : {column.x, column.y, column.z}) channels.push_back(channel.value);
  return channels;
}

/// The piece of lights that reach a surface.
PathKey light_key(PathKey key) {
  key.piece = PathPiece::light;
  key.gathers = key.lit = false;
  key.children = {};
  return key;
}

/// By value: does it depend on the sample of a light?
std::vector<bool> find_sample_values(const Code& code) {
  std::vector<bool> reads(code.size());
  for (Value v = 0; v < code.size(); ++v)
    reads[v] = (code[v].op == Op::input && is_of_light_sample(code[v].payload.input())) ||
               any_operand(code[v], [&](Value operand) { return reads[operand]; });
  return reads;
}

/// The light piece comes first in the code of every program that it is in, so that its columns are the same in all.
PathProgram build_program(const Scene& scene, const MaterialStructure& structure, const PathKey& key) {
  ExpressionBuilder builder(scene, structure);
  std::vector<Value> light, columns;
  if (key.lit || key.piece == PathPiece::light) {
    light = add_piece(builder, light_key(key));
    columns = find_columns(builder.code(), find_uniform(builder.code()), find_sample_values(builder.code()), light);
  }
  if (key.piece == PathPiece::light)
    return {builder.code(), light, make_kernel(with_columns(builder.code(), columns), light)};
  std::vector<Value> outputs = add_piece(builder, key);
  outputs.insert(outputs.end(), columns.begin(), columns.end());
  return {builder.code(), outputs, make_kernel(builder.code(), outputs)};
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
  auto& program = programs_[shape];
  if (!program) program = std::make_shared<const PathProgram>(build_program(scene, shape.first, shape.second));
  return bound_.try_emplace(key, BoundPathProgram{program, key.material}).first->second;
}

std::shared_ptr<const PathSplit> split(const PathProgram& program, FieldMask fields) {
  const Code& code = program.code;
  std::vector<bool> changing(code.size());
  for (Value v = 0; v < code.size(); ++v)
    changing[v] =
        reads_fields(code[v], fields) || any_operand(code[v], [&](Value operand) { return changing[operand]; });
  const std::vector<Value> columns = find_columns(code, find_uniform(code), changing, program.outputs);
  return std::make_shared<const PathSplit>(
      PathSplit{make_kernel(code, columns), make_kernel(with_columns(code, columns), program.outputs)});
}

void PathPrograms::forget(MaterialId material) {
  std::erase_if(bound_, [&](const auto& entry) { return entry.first.material == material; });
}

void PathBatch::load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters& parameters,
                     Scratch& scratch) const {
  if (step.op == Op::column) {
    const std::uint32_t number = step.payload.number();
    float* out = scratch.own(step.out);
    for (std::size_t lane = 0; lane < lanes; ++lane) out[lane] = terms[first + lane]->columns[number];
    return;
  }
  if (step.op == Op::input && is_of_light_sample(step.payload.input())) {
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
