#include "color/compress/compressed_block.h"

#include <algorithm>
#include <cstring>

namespace relook {
namespace {

/// The lanes of a compressed batch, as a residual kernel loads them.
class CompressedLanes {
 public:
  CompressedLanes(const CompressedBatch& batch, const BlockColors& colors) : batch_(batch), colors_(colors) {}

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const {
    if (step.op == Op::column) {
      const CompressedBatch::Stored& stored = batch_.columns[step.payload.number()];
      if (stored.first == CompressedBatch::kShared)
        std::fill_n(scratch.own(step.out), whole_vectors(lanes), stored.shared);
      else
        scratch.at[step.out] = column_at(stored, first);
      return;
    }
    load_color(step, first, lanes, scratch);
  }

 private:
  /// The values of a column from lane `first` on. Asks for those of the next block already: there are more columns than
  /// a processor's prefetcher follows.
  [[nodiscard]] const float* column_at(const CompressedBatch::Stored& stored, std::size_t first) const {
    constexpr std::size_t kVectors = kLanes / kVectorLanes;
    const CompressedBatch::Vector* column = batch_.values.data() + stored.first + first / kVectorLanes;
    for (std::size_t k = kVectors; k < 2 * kVectors; ++k) __builtin_prefetch(column + k);
    return column->lanes.data();
  }
  void load_color(const Kernel::Step& step, std::size_t first, std::size_t lanes, Scratch& scratch) const {
    const int channel = static_cast<int>(step.payload.axis());
    const std::uint32_t which = step.payload.which();
    float* out = scratch.own(step.out);
    if (step.payload.input() == Input::child) {
      const std::uint32_t* slots = batch_.child[which].data() + first;
      for (std::size_t lane = 0; lane < lanes; ++lane) out[lane] = colors_.nodes[slots[lane]][channel];
      return;
    }
    const auto links =
        std::ranges::lower_bound(batch_.tints, which, {}, &std::pair<std::uint32_t, std::vector<LightLink>>::first);
    for (std::size_t lane = 0; lane < lanes; ++lane) out[lane] = tint(links->second[first + lane], channel, colors_);
  }

  const CompressedBatch& batch_;
  const BlockColors& colors_;
};

bool is_one_value(const float* values, std::size_t lanes) {
  for (std::size_t lane = 1; lane < lanes; ++lane)
    if (std::memcmp(&values[lane], &values[0], sizeof(float)) != 0) return false;
  return true;
}

/// Drops columns that hold one value, or the values of an earlier column, and notes where their values are.
void drop_repeated(CompressedBatch& batch) {
  using Vector = CompressedBatch::Vector;
  const std::size_t lanes = batch.lanes(), length = whole_vectors(lanes) / kVectorLanes;
  const auto equal = [&](const Vector* a, const Vector* b) { return std::memcmp(a, b, lanes * sizeof(float)) == 0; };
  std::vector<Vector> kept;
  std::vector<std::uint32_t> firsts;  // of the kept columns
  for (std::size_t k = 0; k < batch.columns.size(); ++k) {
    const Vector* column = &batch.values[k * length];
    if (is_one_value(column->lanes.data(), lanes)) {
      batch.columns[k] = {CompressedBatch::kShared, column->lanes[0]};
      continue;
    }
    const auto same = std::ranges::find_if(firsts, [&](std::uint32_t first) { return equal(&kept[first], column); });
    if (same != firsts.end()) {
      batch.columns[k].first = *same;
      continue;
    }
    batch.columns[k].first = static_cast<std::uint32_t>(kept.size());
    firsts.push_back(batch.columns[k].first);
    kept.insert(kept.end(), column, column + length);
  }
  kept.shrink_to_fit();
  batch.values = std::move(kept);
}

}  // namespace

const SplitProgram& SplitTable::get(const ColorProgram& program, const ChangingLeaves& leaves) {
  const std::lock_guard lock(mutex_);
  auto& known = splits_[{&program, leaves}];
  if (!known) known = std::make_unique<const SplitProgram>(split(program, leaves));
  return *known;
}

std::size_t CompressedBatch::bytes() const {
  std::size_t sum = sizeof(*this) + values.size() * sizeof(Vector) + out.size() * sizeof(std::uint32_t) +
                    columns.size() * sizeof(Stored);
  for (const auto& slots : child) sum += slots.size() * sizeof(std::uint32_t);
  for (const auto& [light, links] : tints) sum += links.size() * sizeof(LightLink);
  return sum;
}

void store_columns(CompressedBatch& batch, const Scene& scene, const NodeBatch& nodes, Scratch& scratch) {
  const std::size_t count = batch.program->constants.outputs.size(), lanes = batch.lanes();
  const std::size_t length = whole_vectors(lanes) / kVectorLanes;
  batch.columns.resize(count);
  if (count == 0) return;
  batch.values.resize(count * length);
  const Parameters parameters{scene, batch.material};
  KernelRun run(batch.program->constants, parameters, nodes, lanes, scratch);
  for (std::size_t first = 0; first < lanes; first += kLanes) {
    const std::size_t some = std::min(kLanes, lanes - first);
    run.run(first, some);
    for (std::size_t k = 0; k < count; ++k)
      std::copy_n(run.output(k), some, batch.values[k * length + first / kVectorLanes].lanes.data());
  }
  drop_repeated(batch);
}

void Baked::add(MaterialId material, const Dependencies& read) {
  const auto known = std::ranges::find(materials_, material, &std::pair<MaterialId, FieldMask>::first);
  if (known != materials_.end())
    known->second |= read.material;
  else
    materials_.emplace_back(material, read.material);
  if (!std::ranges::includes(lights_, read.lights)) {
    std::vector<LightId> both;
    std::ranges::set_union(lights_, read.lights, std::back_inserter(both));
    lights_ = std::move(both);
  }
  ambient_ = ambient_ || read.ambient;
  environment_ = environment_ || read.environment;
}

bool Baked::depends_on(const ParameterSet& changed) const {
  if ((changed.ambient && ambient_) || (changed.environment && environment_)) return true;
  for (const auto& [material, fields] : materials_)
    if ((changed.fields_of(material) & fields) != 0) return true;
  return std::ranges::any_of(lights_, [&](LightId light) { return changed.has(light); });
}

bool Baked::has(MaterialId material) const {
  return std::ranges::find(materials_, material, &std::pair<MaterialId, FieldMask>::first) != materials_.end();
}

std::size_t CompressedBlock::bytes() const {
  std::size_t sum = sizeof(*this) + roots.size() * sizeof(std::uint32_t) +
                    known_filters.size() * sizeof(std::pair<std::uint32_t, Rgba>);
  for (const CompressedBatch& batch : batches) sum += batch.bytes();
  return sum;
}

std::span<const Rgba> CompressedBlock::evaluate(const Scene& scene, ColorMemory& memory) const {
  BlockColors& colors = memory.colors;
  colors.nodes.resize(nodes);
  colors.filters.resize(filters);
  for (const auto& [slot, color] : known_filters) colors.filters[slot] = color;
  for (const CompressedBatch& batch : batches) {
    const Parameters parameters{scene, batch.material};
    const CompressedLanes source(batch, colors);
    KernelRun run(batch.program->residual, parameters, source, batch.lanes(), memory.scratch);
    std::vector<Rgba>& out = batch.are_filters ? colors.filters : colors.nodes;
    for (std::size_t first = 0; first < batch.lanes(); first += kLanes) {
      const std::size_t lanes = std::min(kLanes, batch.lanes() - first);
      run.run(first, lanes);
      const float *red = run.output(0), *green = run.output(1), *blue = run.output(2), *alpha = run.output(3);
      const std::uint32_t* slots = batch.out.data() + first;
      for (std::size_t lane = 0; lane < lanes; ++lane)
        out[slots[lane]] = Rgba(red[lane], green[lane], blue[lane], alpha[lane]);
    }
  }
  return std::span(colors.nodes).first(roots.size());
}

}  // namespace relook
