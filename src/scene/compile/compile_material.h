// Materials with their texture slots, displacement maps, lights and the environment, compiled from their look-document
// values. Requires values that passed check_against_schema; what types and ranges cannot tell is checked here.
#pragma once
#include <span>
#include <string_view>

#include "scene/look/look.h"
#include "scene/material_fields.h"
#include "scene/scene.h"
#include "scene/texture/decode_pyramid.h"

namespace relook {

/// What compiling needs besides the value itself.
struct CompileContext {
  const LookDocument& document;
  PyramidStore& pyramids;
  std::string_view file;
};

/// `pointer`: place of `value`, for messages. All throw LookError, or InputError when an image does not decode.
[[nodiscard]] Material compile_material(const CompileContext& context, const std::string& name, const Json& value,
                                        const std::string& pointer);
/// The part of compile_material() that is no texture: sets the fields that `value` has, others stay as they are.
void set_fields(const Json& value, Material& material, std::span<const MaterialRow> rows = material_rows());
[[nodiscard]] Displacement compile_displacement(const CompileContext& context, const Json& value,
                                                const std::string& pointer);
/// Everything of a light but its node, and what it takes from there; of an area the half axes that it has on a node
/// that stands at the origin.
[[nodiscard]] Light compile_light(std::string_view file, const std::string& name, const Json& value,
                                  const std::string& pointer, Integrator integrator = Integrator::whitted);
[[nodiscard]] Environment compile_environment(const CompileContext& context, const Json& value, Integrator integrator);

/// The name of the light that a node carries, by whichever extension; null if it has none.
[[nodiscard]] const Json* light_name_of(const Json& node);

/// Decodes the images of all materials side by side, so that compiling them finds their pyramids.
void decode_images(const LookDocument& document, PyramidStore& pyramids);

/// Checks a texture, sampler or image that no slot may use yet.
void check_texture_entity(const LookDocument& document, std::string_view file, Section section, const Json& value,
                          const std::string& pointer);

/// The member along a path of keys, or nullptr.
[[nodiscard]] const Json* member_at(const Json& value, std::initializer_list<std::string_view> keys);

[[nodiscard]] Color color_of(const Json& rgb);
/// Rounded to float; never -0, so that equal values have equal bits.
[[nodiscard]] float float_of(const Json& number);

}  // namespace relook
