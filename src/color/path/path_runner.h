// Programs of the path integrator run over hits, filters and light terms: those that share one together. One a scene and
// thread; inside src/color/path.
#pragma once
#include <algorithm>
#include <unordered_map>
#include <vector>

#include "color/node_programs.h"
#include "color/path/path_programs.h"

namespace relook {

[[nodiscard]] inline Color from_lanes(const float* red, const float* green, const float* blue, std::size_t lane) {
  return {red[lane], green[lane], blue[lane]};
}
/// Channels of a column of three.
template <class Source>
[[nodiscard]] Color from_lanes(const KernelRun<Source>& run, std::size_t column, std::size_t lane) {
  return from_lanes(run.output(3 * column), run.output(3 * column + 1), run.output(3 * column + 2), lane);
}

class PathRunner {
 public:
  PathRunner(const ColorScene& scene, PathPrograms& programs) : scene_(scene), programs_(programs) {}

  [[nodiscard]] PathKey key_of(PathPiece piece, ObjectId id, bool inside) const {
    const RayObject& object = scene_.object(id);
    PathKey key;
    key.piece = piece;
    key.material = scene_.scene().object(id).material;
    key.inside = inside;
    key.vertex_colors = !object.mesh->colors.empty();
    key.interface_only = object.optics.volume && inside;
    key.blurs = object.blurs;
    return key;
  }
  [[nodiscard]] std::uint32_t number_of(const PathKey& key) {
    const auto [it, is_new] = numbers_.try_emplace(signature_of(key), static_cast<std::uint32_t>(bound_.size()));
    if (is_new) {
      bound_.push_back(programs_.get(scene_.scene(), key));
      keys_.push_back(key);
    }
    return it->second;
  }
  [[nodiscard]] const BoundPathProgram& program(std::uint32_t number) const { return bound_[number]; }
  [[nodiscard]] const PathKey& key(std::uint32_t number) const { return keys_[number]; }

  /// Begins a list of items: of hits or filters of a block.
  void begin() {
    items_.clear();
    program_of_.clear();
  }
  void add(std::uint32_t item, std::uint32_t program) {
    items_.push_back(item);
    program_of_.push_back(program);
  }
  [[nodiscard]] std::uint32_t item(std::uint32_t place) const { return items_[place]; }

  /// Calls done(number, batch, places in the list) for the items of each program. `terms`: of the items; empty: none.
  template <class Done>
  void for_each_batch(const TreeBlock& block, bool are_filters, std::span<const LightTerm> terms, const Done& done) {
    batches_.for_each(program_of_, bound_.size(), [&](std::size_t number, std::span<const std::uint32_t> places) {
      batch_hits_.clear();
      batch_terms_.clear();
      for (const std::uint32_t place : places) {
        batch_hits_.push_back(items_[place]);
        if (!terms.empty()) batch_terms_.push_back(&terms[place]);
      }
      done(static_cast<std::uint32_t>(number), PathBatch{scene_, block, are_filters, batch_hits_, batch_terms_}, places);
    });
  }
  /// Runs the programs and calls done(run, key, places of the run).
  template <class Done>
  void run(const TreeBlock& block, bool are_filters, std::span<const LightTerm> terms, const Done& done) {
    for_each_batch(block, are_filters, terms,
                   [&](std::uint32_t number, const PathBatch& batch, std::span<const std::uint32_t> places) {
                     const Parameters values = parameters(number);
                     KernelRun<PathBatch> kernel(bound_[number].program->kernel, values, batch, places.size(),
                                                 scratch_);
                     for (std::size_t first = 0; first < places.size(); first += kLanes) {
                       const std::size_t lanes = std::min(kLanes, places.size() - first);
                       kernel.run(first, lanes);
                       done(kernel, keys_[number], places.subspan(first, lanes));
                     }
                   });
  }
  /// The program cut for an edit of fields of its material.
  [[nodiscard]] const std::shared_ptr<const PathSplit>& split_of(std::uint32_t number, FieldMask fields) {
    auto& found = splits_[{number, fields}];
    if (!found) found = split(*bound_[number].program, fields);
    return found;
  }
  [[nodiscard]] Parameters parameters(std::uint32_t number) const { return {scene_.scene(), bound_[number].material}; }
  [[nodiscard]] Scratch& scratch() { return scratch_; }

 private:
  /// A short form of PathKey that is cheap to make and compare.
  [[nodiscard]] static std::uint64_t signature_of(const PathKey& key) {
    return std::uint64_t{key.material.index()} << 32 | std::uint64_t{key.children.bits()} << 8 |
           (key.inside ? 1U : 0U) | (key.vertex_colors ? 2U : 0U) | (key.interface_only ? 4U : 0U) |
           (key.gathers ? 8U : 0U) | static_cast<unsigned>(key.piece) << 4 | (key.blurs ? 128U : 0U) |
           (key.lit ? 64U : 0U);
  }

  const ColorScene& scene_;
  PathPrograms& programs_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;  // by signature: of a program
  std::vector<BoundPathProgram> bound_;
  std::vector<PathKey> keys_;
  std::map<std::pair<std::uint32_t, FieldMask>, std::shared_ptr<const PathSplit>> splits_;
  Batches batches_;
  std::vector<std::uint32_t> items_, program_of_, batch_hits_;
  std::vector<const LightTerm*> batch_terms_;
  Scratch scratch_;
};

}  // namespace relook
