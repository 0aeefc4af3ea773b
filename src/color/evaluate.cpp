#include "color/evaluate.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/portable_math.h"
#include "base/vector_clones.h"
#include "color/gather.h"
#include "color/sheen_albedo.h"
#include "scene/procedural.h"
#include "trace/surface.h"

namespace relook {
namespace {

/// The arithmetic steps: out = op(a, b, c), lane by lane.
RELOOK_VECTOR_CLONES
void run_arithmetic(Op op, const float* __restrict a, const float* __restrict b, const float* __restrict c,
                    float* __restrict out) {
  switch (op) {
    case Op::add:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] + b[i];
      break;
    case Op::subtract:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] - b[i];
      break;
    case Op::multiply:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] * b[i];
      break;
    case Op::divide:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] / b[i];
      break;
    case Op::min:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] < b[i] ? a[i] : b[i];
      break;
    case Op::max:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] > b[i] ? a[i] : b[i];
      break;
    case Op::sqrt:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = std::sqrt(a[i]);
      break;
    case Op::exp2:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = portable_exp2(a[i]);
      break;
    case Op::log2:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = portable_log2(a[i]);
      break;
    case Op::if_positive:
      for (std::size_t i = 0; i < kLanes; ++i) out[i] = a[i] > 0 ? b[i] : c[i];
      break;
    default:
      break;
  }
}

float leaf_value(const ColorProgram::Step& step, const Scene& scene, MaterialId material) {
  const std::uint32_t low = step.payload & 0xFFU, high = step.payload >> 8;
  switch (step.op) {
    case Op::constant:
      return std::bit_cast<float>(step.payload);
    case Op::material_field:
      return field_value(scene.material(material), static_cast<Field>(low), high);
    case Op::light_field:
      return field_value(scene.light(LightId(high)), static_cast<LightField>(low));
    case Op::ambient:
      return scene.ambient[static_cast<int>(low)];
    case Op::environment:
      return scene.environment.color[static_cast<int>(low)] * scene.environment.intensity;
    default:
      return 0;
  }
}

bool is_leaf(Op op) { return op <= Op::environment; }

Rgba environment_value(const Environment& environment, const Direction& d) {
  // The image's middle looks along -z; rotation turns the surroundings about +y.
  const float around = portable_atan2_turns(d.x, -d.z) + environment.rotation * 0.15915494F;
  const Uv uv(around + 0.5F, 0.5F - 2.0F * portable_asin_turns(d.y));
  return sample(*environment.image, uv, 0, Wrap::repeat, Wrap::clamp, false);
}

class Run {
 public:
  Run(const BoundProgram& bound, const RayScene& scene, const TreeBlock& block, bool are_filters, BlockColors& colors,
      std::vector<Column>& registers)
      : program_(*bound.program),
        material_(bound.material),
        scene_(scene),
        block_(block),
        are_filters_(are_filters),
        colors_(colors),
        r_(registers) {}

  void fill_uniform() {
    for (const auto& step : program_.uniform) {
      if (is_leaf(step.op))
        r_[step.out].fill(leaf_value(step, scene_.scene(), material_));
      else
        compute(step);
    }
  }

  void run(std::span<const std::uint32_t> indices) {
    const Batch batch{scene_, block_, are_filters_, indices};
    for (const auto& step : program_.varying) {
      switch (step.op) {
        case Op::input:
          gather(step.payload, batch, colors_, r_[step.out]);
          break;
        case Op::coordinates:
          gather_coordinates(slot_of(step), batch, &r_[step.out]);
          break;
        case Op::tangent_frame:
          gather_tangent_frames(slot_of(step), batch, &r_[step.out]);
          break;
        case Op::texture:
          look_up(step, indices.size());
          break;
        case Op::environment_map:
          look_around(step, indices.size());
          break;
        default:
          compute(step);
      }
    }
    auto& out = are_filters_ ? colors_.filters : colors_.nodes;
    const auto& [red, green, blue, alpha] = program_.result;
    for (std::size_t lane = 0; lane < indices.size(); ++lane)
      out[indices[lane]] = Rgba(r_[red][lane], r_[green][lane], r_[blue][lane], r_[alpha][lane]);
  }

 private:
  void compute(const ColorProgram::Step& step) {
    const auto& [a, b, c, d, e] = step.in;
    if (step.op == Op::sheen_albedo) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) r_[step.out][lane] = sheen_albedo(r_[a][lane], r_[b][lane]);
      return;
    }
    run_arithmetic(step.op, r_[a].data(), r_[b].data(), r_[c].data(), r_[step.out].data());
  }
  void store(std::uint16_t first, std::size_t lane, const Rgba& value) {
    for (int channel = 0; channel < 4; ++channel) r_[static_cast<std::size_t>(first + channel)][lane] = value[channel];
  }
  [[nodiscard]] const TextureSlot& slot_of(const ColorProgram::Step& step) const {
    return scene_.scene().material(material_).slot(static_cast<Slot>(step.payload));
  }
  void look_up(const ColorProgram::Step& step, std::size_t lanes) {
    const TextureSlot& slot = slot_of(step);
    if (slot.kind == TextureKind::procedural) {
      look_up_procedural(step, slot, lanes);
      return;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane)
      store(step.out, lane, texture_value(slot, coordinates(step, lane), r_[step.in[4]][lane]));
  }
  void look_up_procedural(const ColorProgram::Step& step, const TextureSlot& slot, std::size_t lanes) {
    std::array<float, kLanes> x{}, y{}, z{}, weight;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Point at = procedural_position(slot, coordinates(step, lane));
      x[lane] = at.x;
      y[lane] = at.y;
      z[lane] = at.z;
    }
    procedural_weights(slot.procedural, x, y, z, weight);
    for (std::size_t lane = 0; lane < lanes; ++lane) store(step.out, lane, mixed(slot.procedural, weight[lane]));
  }
  [[nodiscard]] TextureCoordinates coordinates(const ColorProgram::Step& step, std::size_t lane) const {
    return {Point(r_[step.in[0]][lane], r_[step.in[1]][lane], r_[step.in[2]][lane]), r_[step.in[3]][lane]};
  }
  void look_around(const ColorProgram::Step& step, std::size_t lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Direction d(r_[step.in[0]][lane], r_[step.in[1]][lane], r_[step.in[2]][lane]);
      store(step.out, lane, environment_value(scene_.scene().environment, d));
    }
  }

  const ColorProgram& program_;
  MaterialId material_;
  const RayScene& scene_;
  const TreeBlock& block_;
  bool are_filters_;
  BlockColors& colors_;
  std::vector<Column>& r_;
};

}  // namespace

void evaluate(const BoundProgram& bound, const RayScene& scene, const TreeBlock& block, bool are_filters,
              std::span<const std::uint32_t> indices, BlockColors& colors, Scratch& scratch) {
  if (scratch.registers.size() < bound.program->registers) scratch.registers.resize(bound.program->registers);
  Run run(bound, scene, block, are_filters, colors, scratch.registers);
  run.fill_uniform();
  for (std::size_t first = 0; first < indices.size(); first += kLanes)
    run.run(indices.subspan(first, std::min(kLanes, indices.size() - first)));
}

}  // namespace relook
