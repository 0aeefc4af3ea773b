#include "scene/gltf/gltf_primitive.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/gltf/import_rules.h"

namespace relook {
namespace {

bool fits(const GltfAccessor& accessor, const ColumnFormat& format) {
  const bool is_float = accessor.component == Component::f32;
  const bool is_signed = accessor.component == Component::i8 || accessor.component == Component::i16;
  return accessor.width >= format.least_width && accessor.width <= format.most_width &&
         accessor.component != Component::u32 &&
         (is_float || (format.integers && (accessor.normalized || !format.only_normalized) &&
                       (is_signed || !format.only_signed)));
}

}  // namespace

void PrimitiveSource::fail(const std::string& place, std::string_view what) const {
  throw InputError(file, pointer + place, what);
}

void PrimitiveSource::warn(const std::string& place, std::string_view what) const {
  warnings.push_back(pointer + place + ": " + std::string(what));
}

void PrimitiveSource::forgive(const std::string& place, std::string_view what) const {
  tolerate(file, pointer + place, what, warnings);
}

const GltfAccessor* PrimitiveSource::accessor(std::string_view semantic) const {
  const auto found = primitive.attributes.find(semantic);
  return found == primitive.attributes.end() ? nullptr : &model.accessors[found->second];
}

std::string attribute_place(std::string_view semantic) { return "/attributes/" + escape_token(semantic); }

std::vector<float> column_of(const PrimitiveSource& source, const GltfAccessor& accessor, const std::string& place,
                             const ColumnFormat& format, float largest, bool is_read) {
  if (!fits(accessor, format)) {
    constexpr std::string_view kFault = "the accessor's type is not one that this attribute may have";
    if (is_read) source.fail(place, kFault);
    source.forgive(place, std::string(kFault) + ": the column is ignored");
    return {};
  }
  if (const auto fault = data_fault(source.model, accessor); !fault.empty()) {
    if (is_read || fault != kNoData) source.fail(place, fault);
    source.forgive(place, std::string(fault) + ": the column is ignored");
    return {};
  }
  std::vector<float> values = read_floats(source.model, accessor, source.vertices);
  const auto bad = std::ranges::find_if(values, [&](float value) { return !(std::abs(value) <= largest); });
  if (bad == values.end()) return values;
  const std::string fault =
      "element " +
      std::to_string(source.vertices[static_cast<std::size_t>(bad - values.begin()) / accessor.width]) +
      (std::isfinite(*bad) ? " is too large" : " is not finite");
  if (is_read) source.fail(place, fault);
  source.forgive(place, fault + ": the column is ignored");
  return {};
}

std::vector<float> attribute(const PrimitiveSource& source, std::string_view semantic, const ColumnFormat& format,
                             float largest) {
  const GltfAccessor* accessor = source.accessor(semantic);
  if (accessor == nullptr) return {};
  return column_of(source, *accessor, attribute_place(semantic), format, largest, source.reads(semantic));
}

}  // namespace relook
