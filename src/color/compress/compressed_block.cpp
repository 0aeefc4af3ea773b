#include "color/compress/compressed_block.h"

#include <algorithm>

namespace relook {
namespace {

/// The lanes of a compressed batch, as a residual kernel loads them.
class CompressedLanes {
 public:
  CompressedLanes(const CompressedBatch& batch, const BlockColors& colors, const SumColumns& sums)
      : batch_(batch), colors_(colors), sums_(sums) {}

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const {
    if (step.op == Op::column)
      batch_.columns.load(step.payload.number(), step.out, first, lanes, scratch);
    else if (step.payload.input() == Input::sum)
      scratch.at[step.out] = sums_.at(step.payload) + first;
    else
      load_color(step, first, lanes, scratch);
  }

 private:
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
  const SumColumns& sums_;
};

/// Those that a lamp reaches.
struct LitSource {
  const CompressedBatch& batch;
  const LitLanes& lit;
  const BlockColors& colors;

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const {
    const std::size_t of_nodes = batch.columns.size(), column = step.payload.number();
    if (step.op == Op::column && column >= of_nodes)
      return lit.columns.load(column - of_nodes, step.out, first, lanes, scratch);
    float* out = scratch.own(step.out);
    if (step.op == Op::column) {
      const float* values = batch.columns.values(column);
      if (values == nullptr) {
        std::fill_n(out, whole_vectors(lanes), batch.columns.shared(column));
        return;
      }
      for (std::size_t k = 0; k < lanes; ++k) out[k] = values[lit.lanes[first + k]];
      return;
    }
    const int channel = static_cast<int>(step.payload.axis());
    for (std::size_t k = 0; k < lanes; ++k) out[k] = tint(lit.links[first + k], channel, colors);
  }
};

/// Calls take(first, lanes, run) for the lanes of a source, a few at a time.
template <class Source, class Take>
void run_lanes(const Kernel& kernel, const Parameters& parameters, const Source& source, std::size_t count,
               Scratch& scratch, const Take& take) {
  KernelRun run(kernel, parameters, source, count, scratch);
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t lanes = std::min(kLanes, count - first);
    run.run(first, lanes);
    take(first, lanes, run);
  }
}

/// The sums of a batch, as far as they change.
void evaluate_sums(const CompressedBatch& batch, const Scene& scene, SumColumns& sums, ColorMemory& memory) {
  for (std::size_t sum = 0; sum < batch.sums.size(); ++sum) {
    const SplitSum& split = batch.program->sums[sum];
    if (!split.changes) continue;
    const CompressedSum& kept = batch.sums[sum];
    if (kept.start.size() != 0) {
      for (std::size_t channel = 0; channel < 3; ++channel)
        if (const float* values = kept.start.values(channel); values != nullptr)
          std::copy_n(values, batch.lanes(), sums.at(sum, channel));
        else
          std::fill_n(sums.at(sum, channel), batch.lanes(), kept.start.shared(channel));
    } else {
      run_lanes(split.stage, {scene, batch.material}, CompressedLanes(batch, memory.colors, sums), batch.lanes(),
                memory.scratch, [&](std::size_t first, std::size_t lanes, const auto& run) {
                  for (std::size_t channel = 0; channel < 3; ++channel)
                    std::copy_n(run.output(channel), lanes, sums.at(sum, channel) + first);
                });
    }
    for (const LitLanes& lit : kept.lit)
      run_lanes(lit.term->residual, {scene, batch.material, lit.light}, LitSource{batch, lit, memory.colors},
                lit.lanes.size(), memory.scratch, [&](std::size_t first, std::size_t lanes, const auto& run) {
                  sums.add(sum, std::span(lit.lanes).subspan(first, lanes), run);
                });
  }
}

}  // namespace

const SplitProgram& SplitTable::get(const ColorProgram& program, const ChangingLeaves& leaves) {
  const std::lock_guard lock(mutex_);
  auto& known = splits_[{&program, leaves}];
  if (!known) known = std::make_unique<const SplitProgram>(split(program, leaves));
  return *known;
}

std::size_t CompressedBatch::bytes() const {
  std::size_t sum = sizeof(*this) + columns.bytes() + out.size() * sizeof(std::uint32_t);
  for (const auto& slots : child) sum += slots.size() * sizeof(std::uint32_t);
  for (const auto& [light, links] : tints) sum += links.size() * sizeof(LightLink);
  for (const CompressedSum& lamps : sums) sum += lamps.bytes();
  return sum;
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
    SumColumns sums(memory.sums.sums, batch.sums.size(), batch.lanes());
    evaluate_sums(batch, scene, sums, memory);
    std::vector<Rgba>& out = batch.are_filters ? colors.filters : colors.nodes;
    run_lanes(batch.program->residual, {scene, batch.material}, CompressedLanes(batch, colors, sums), batch.lanes(),
              memory.scratch, [&](std::size_t first, std::size_t lanes, const auto& run) {
                const float *red = run.output(0), *green = run.output(1), *blue = run.output(2), *alpha = run.output(3);
                const std::uint32_t* slots = batch.out.data() + first;
                for (std::size_t lane = 0; lane < lanes; ++lane)
                  out[slots[lane]] = Rgba(red[lane], green[lane], blue[lane], alpha[lane]);
              });
  }
  return std::span(colors.nodes).first(roots.size());
}

}  // namespace relook
