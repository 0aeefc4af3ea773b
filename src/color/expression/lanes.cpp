#include "color/expression/lanes.h"

#include <bit>
#include <cmath>

#include "base/portable_math.h"
#include "base/vector_clones.h"
#include "color/expression/field.h"
#include "color/expression/gather.h"
#include "physics/sheen.h"
#include "scene/texture/procedural.h"
#include "trace/surface.h"

namespace relook {
namespace {

Rgba environment_value(const Environment& environment, const Direction& d) {
  // The image's middle looks along -z; rotation turns the surroundings about +y.
  const float around = portable_atan2_turns(d.x, -d.z) + environment.rotation * 0.15915494F;
  const Uv uv(around + 0.5F, 0.5F - 2.0F * portable_asin_turns(d.y));
  return sample(*environment.image, uv, 0, {Wrap::repeat, Wrap::clamp});
}

TextureCoordinates coordinates(const Kernel::Step& step, const Scratch& scratch, std::size_t lane) {
  const auto of = [&](std::size_t k) { return scratch.at[step.in[k]][lane]; };
  return {Point(of(0), of(1), of(2)), of(3)};
}

/// `result`: the four columns of a lookup.
void set_lane(Column* result, std::size_t lane, const Rgba& value) {
  for (int channel = 0; channel < 4; ++channel) result[channel].lanes[lane] = value[channel];
}

bool read_alike(const TextureSlot& a, const TextureSlot& b) {
  return a.kind == TextureKind::image && b.kind == TextureKind::image && a.pyramid == b.pyramid &&
         a.sampler == b.sampler && mapping_key(a) == mapping_key(b) && a.offset == b.offset && a.scale == b.scale &&
         a.rotation == b.rotation;
}

/// Slots with the same have the same texels at every hit: the first of the material that is read like this one. Not that
/// of any mapping.
std::uint32_t texel_key(const Material& material, Slot slot) {
  std::size_t first = 0;
  while (first < static_cast<std::size_t>(slot) &&
         !read_alike(material.slot(static_cast<Slot>(first)), material.slot(slot)))
    ++first;
  return 0x80000000U | static_cast<std::uint32_t>(first);
}

/// Some lanes are placed, and their texels asked for, before the first is read.
void look_up_image(const Kernel::Step& step, const TextureSlot& slot, const Scratch& scratch, std::size_t lanes,
                   Column* result) {
  constexpr std::size_t kAhead = 16;
  std::array<TexelTaps, kAhead> taps;
  for (std::size_t first = 0; first < lanes; first += kAhead) {
    const std::size_t count = std::min(kAhead, lanes - first);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t lane = first + k;
      find_taps(slot, coordinates(step, scratch, lane), scratch.at[step.in[4]][lane], taps[k]);
      prefetch(*slot.pyramid, taps[k]);
    }
    for (std::size_t k = 0; k < count; ++k) set_lane(result, first + k, value_of(*slot.pyramid, taps[k]));
  }
}

/// Every lookup of a kernel has the same footprint, that of the hit.
void look_up_texture(const Kernel::Step& step, const Material& material, Scratch& scratch, std::size_t lanes) {
  const TextureSlot& slot = material.slot(step.payload.slot());
  Column* result = scratch.share(step.out, texel_key(material, step.payload.slot()));
  if (result == nullptr) return;
  if (slot.kind == TextureKind::image) return look_up_image(step, slot, scratch, lanes, result);
  for (std::size_t lane = 0; lane < lanes; ++lane)
    set_lane(result, lane, texture_value(slot, coordinates(step, scratch, lane), scratch.at[step.in[4]][lane]));
}

void weigh_procedural(const Kernel::Step& step, const TextureSlot& slot, Scratch& scratch, std::size_t lanes) {
  std::array<float, kLanes> x, y, z;
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const Point at = procedural_position(slot, coordinates(step, scratch, lane));
    x[lane] = at.x;
    y[lane] = at.y;
    z[lane] = at.z;
  }
  procedural_weights(slot.procedural, {x.data(), lanes}, {y.data(), lanes}, {z.data(), lanes},
                     {scratch.own(step.out), lanes});
}

void look_around(const Kernel::Step& step, const Environment& environment, Scratch& scratch, std::size_t lanes) {
  Column* result = scratch.own(step.out, 4);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto of = [&](std::size_t k) { return scratch.at[step.in[k]][lane]; };
    set_lane(result, lane, environment_value(environment, Direction(of(0), of(1), of(2))));
  }
}

/// `columns`: of the registers; no step writes one that it reads.
RELOOK_VECTOR_CLONES
const Kernel::Step* run_steps(const Kernel::Step* step, const Kernel::Step* end, Column* columns, const float** at,
                              std::size_t lanes) {
  const std::size_t n = lanes / kVectorLanes * kVectorLanes;
  for (; step != end; ++step) {
    if (!is_arithmetic(step->op)) return step;
    const float* __restrict a = at[step->in[0]];
    const float* __restrict b = at[step->in[1]];
    const float* __restrict c = at[step->in[2]];
    float* __restrict out = columns[step->out].lanes.data();
    at[step->out] = out;
    switch (step->op) {
      case Op::add:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] + b[i];
        break;
      case Op::subtract:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] - b[i];
        break;
      case Op::multiply:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] * b[i];
        break;
      case Op::divide:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] / b[i];
        break;
      case Op::min:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] < b[i] ? a[i] : b[i];
        break;
      case Op::max:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] > b[i] ? a[i] : b[i];
        break;
      case Op::sqrt:
        for (std::size_t i = 0; i < n; ++i) out[i] = std::sqrt(a[i]);
        break;
      case Op::exp2:
        for (std::size_t i = 0; i < n; ++i) out[i] = portable_exp2(a[i]);
        break;
      case Op::log2:
        for (std::size_t i = 0; i < n; ++i) out[i] = portable_log2(a[i]);
        break;
      case Op::cos_turns:
        for (std::size_t i = 0; i < n; ++i) out[i] = portable_cos_turns(a[i]);
        break;
      case Op::if_positive:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] > 0 ? b[i] : c[i];
        break;
      case Op::multiply_add:
        for (std::size_t i = 0; i < n; ++i) out[i] = a[i] * b[i] + c[i];
        break;
      default:
        break;
    }
  }
  return step;
}

}  // namespace

float parameter_value(const Kernel::Step& step, const Parameters& parameters) {
  const Scene& scene = parameters.scene;
  const Payload payload = step.payload;
  switch (step.op) {
    case Op::constant:
      return payload.constant();
    case Op::material_field:
      return field_value(scene.material(parameters.material), payload.field(), payload.component());
    case Op::slot_color:
      return slot_color(parameters.slot(step), payload.component());
    case Op::light_field:
      return field_value(scene.light(payload.light() == kLightAtHand ? parameters.light : payload.light()),
                         payload.light_field());
    case Op::ambient:
      return scene.ambient[static_cast<int>(payload.number())];
    case Op::environment:
      return scene.environment.color[static_cast<int>(payload.number())] * scene.environment.intensity;
    default:
      return 0;
  }
}

const Kernel::Step* run_arithmetic(const Kernel::Step* step, const Kernel::Step* end, Scratch& scratch,
                                   std::size_t lanes) {
  return run_steps(step, end, scratch.columns.data(), scratch.at.data(), whole_vectors(lanes));
}

void run_function(const Kernel::Step& step, const Parameters& parameters, Scratch& scratch, std::size_t lanes) {
  switch (step.op) {
    case Op::sheen_albedo: {
      const float *cosine = scratch.at[step.in[0]], *roughness = scratch.at[step.in[1]];
      float* out = scratch.own(step.out);
      for (std::size_t lane = 0; lane < lanes; ++lane) out[lane] = sheen_albedo(cosine[lane], roughness[lane]);
      return;
    }
    case Op::procedural_weight:
      return weigh_procedural(step, parameters.slot(step), scratch, lanes);
    case Op::texture:
      return look_up_texture(step, parameters.scene.material(parameters.material), scratch, lanes);
    case Op::environment_map:
      return look_around(step, parameters.scene.environment, scratch, lanes);
    default:
      return;
  }
}

}  // namespace relook
