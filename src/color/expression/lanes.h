// Runs kernels over lanes, one a sample: every step is a loop over lanes that the compiler vectorises. Lanes do not
// interact, so the bits do not depend on how samples are batched.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <vector>

#include "color/expression/expression_code.h"
#include "scene/scene.h"

namespace relook {

/// Lanes that a kernel runs over at a time, and a multiple that arithmetic is rounded up to.
inline constexpr std::size_t kLanes = 128, kVectorLanes = 16;
struct alignas(64) Column {
  std::array<float, kLanes> lanes;
};
[[nodiscard]] constexpr std::size_t whole_vectors(std::size_t lanes) {
  return (lanes + kVectorLanes - 1) / kVectorLanes * kVectorLanes;
}

/// Working memory of kernels, reused between calls.
struct Scratch {
  std::vector<Column> columns;
  std::vector<const float*> at;  // by register: its column, or one that is stored elsewhere

  void reserve(std::size_t registers) {
    if (columns.size() >= registers) return;
    at.resize(registers);  // first: where memory is short, no column is without a place
    columns.resize(registers);
  }
  /// The columns of `count` registers in a row, to be written.
  [[nodiscard]] Column* own(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t k = 0; k < count; ++k) at[first + k] = columns[first + k].lanes.data();
    return &columns[first];
  }
  /// The column of a register, to be written.
  [[nodiscard]] float* own(std::uint32_t reg) {
    float* column = columns[reg].lanes.data();
    at[reg] = column;
    return column;
  }
  /// Lets four registers in a row have the columns that loads with the same key share while a kernel runs over the same
  /// lanes. These are to be written, unless null: another load has done so.
  [[nodiscard]] Column* share(std::uint32_t first, std::uint32_t key) {
    std::size_t place = 0;
    while (place < shared_count && shared[place].key != key) ++place;
    const bool is_new = place == shared_count;
    if (is_new && shared_count++ == shared.size()) shared.emplace_back();
    Shared& found = shared[place];
    found.key = key;
    for (std::uint32_t k = 0; k < 4; ++k) at[first + k] = found.columns[k].lanes.data();
    return is_new ? found.columns.data() : nullptr;
  }
  void forget_shared() { shared_count = 0; }

  struct Shared {
    std::uint32_t key = 0;
    std::array<Column, 4> columns;
  };
  std::deque<Shared> shared;  // the first `shared_count` hold something; they stay where they are
  std::size_t shared_count = 0;
};

/// What the parameters of a kernel point to.
struct Parameters {
  const Scene& scene;
  MaterialId material;  // none for the environment
  LightId light{};      // the lamp at hand, of what one lamp adds
  [[nodiscard]] const TextureSlot& slot(const Kernel::Step& step) const {
    return scene.material(material).slot(step.payload.slot());
  }
};
[[nodiscard]] float parameter_value(const Kernel::Step& step, const Parameters& parameters);

/// Runs arithmetic steps up to the first that is none; returns where that is.
const Kernel::Step* run_arithmetic(const Kernel::Step* step, const Kernel::Step* end, Scratch& scratch,
                                   std::size_t lanes);
/// Runs a function that is not arithmetic: a lookup from operands, a procedural weight, or the sheen table.
void run_function(const Kernel::Step& step, const Parameters& parameters, Scratch& scratch, std::size_t lanes);

/// One kernel over one batch. Source: load(step, first, lanes, parameters, scratch) fills the registers of a step that
/// is an input, a stored column, coordinates or a tangent frame, for lanes [first, first + lanes) of the batch.
template <class Source>
class KernelRun {
 public:
  /// `batch`: its number of lanes.
  KernelRun(const Kernel& kernel, const Parameters& parameters, const Source& source, std::size_t batch,
            Scratch& scratch)
      : kernel_(kernel), parameters_(parameters), source_(source), scratch_(scratch) {
    scratch_.reserve(kernel.registers);
    const std::size_t lanes = std::min(whole_vectors(batch), kLanes);
    for (auto step = kernel_.uniform.data(), end = step + kernel_.uniform.size(); step != end;) {
      if (is_parameter(step->op)) {
        std::fill_n(scratch_.own(step->out), lanes, parameter_value(*step, parameters_));
        ++step;
      } else {
        step = compute(step, end, lanes);
      }
    }
  }

  /// Lanes [first, first + lanes) of the batch, at most kLanes.
  void run(std::size_t first, std::size_t lanes) {
    scratch_.forget_shared();
    for (auto step = kernel_.varying.data(), end = step + kernel_.varying.size(); step != end;) {
      const bool is_loaded = step->op == Op::input || step->op == Op::column || step->op == Op::coordinates ||
                             step->op == Op::tangent_frame;
      if (is_loaded)
        source_.load(*step++, first, lanes, parameters_, scratch_);
      else
        step = compute(step, end, lanes);
    }
  }
  [[nodiscard]] std::size_t outputs() const { return kernel_.outputs.size(); }
  /// The lanes of an output, after run().
  [[nodiscard]] const float* output(std::size_t k) const { return scratch_.at[kernel_.outputs[k]]; }

 private:
  const Kernel::Step* compute(const Kernel::Step* step, const Kernel::Step* end, std::size_t lanes) {
    if (is_arithmetic(step->op)) return run_arithmetic(step, end, scratch_, lanes);
    run_function(*step, parameters_, scratch_, lanes);
    return step + 1;
  }

  const Kernel& kernel_;
  const Parameters& parameters_;
  const Source& source_;
  Scratch& scratch_;
};

}  // namespace relook
