// Animations from a glTF file: targets as pointers into the document, samplers as numbers. They are checked here, not
// with the rest of a scene: a scene whose animations are wrong can still be rendered.
#include <array>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/check/gltf_check.h"
#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/gltf_source.h"
#include "scene/gltf/packed/gltf_unpack.h"

namespace relook {
namespace {

/// The property that a channel animates; "" without a target.
std::string pointer_of(const JsonView& root, const JsonView& target) {
  static constexpr std::array<std::string_view, 5> kPaths{"translation", "rotation", "scale", "weights", "pointer"};
  const std::size_t path = target.at("path").one_of(kPaths);
  if (kPaths[path] == "pointer") {
    const auto extended = extension(target, "KHR_animation_pointer");
    if (!extended) target.fail("\"KHR_animation_pointer\" is missing");
    std::string pointer = extended->at("pointer").text();
    (void)split_pointer(pointer, target.file(), extended->at("pointer").pointer());
    return pointer;
  }
  const auto node = optional_reference(target, "node", array_size(root, "nodes"), "node");
  return node ? "/nodes/" + std::to_string(*node) + "/" + std::string(kPaths[path]) : "";
}

bool is_node_rotation(const JsonView& target, const std::string& pointer) {
  const std::vector<std::string> tokens = split_pointer(pointer, target.file(), target.pointer());
  return tokens.size() == 3 && tokens[0] == "nodes" && tokens[2] == "rotation";
}

const GltfAccessor& accessor_of(const GltfModel& model, const JsonView& index) {
  const GltfAccessor& accessor = model.accessors[reference(index, model.accessors.size(), "accessor")];
  if (const auto fault = data_fault(model, accessor); !fault.empty()) index.fail(fault);
  if (accessor.width == 0 || accessor.width == 16) index.fail("matrices are not animated");
  return accessor;
}

/// Many channels may name one accessor.
std::vector<float> counted_floats(const GltfModel& model, const GltfAccessor& accessor, const JsonView& place,
                                  ImportShare& share) {
  const std::uint64_t numbers = bounded_product(accessor.count, accessor.width);
  share.add(ImportShare(bounded_product(numbers, sizeof(float)), place.file(), place.pointer() + ": the animation"));
  return read_floats(model, accessor);
}

std::vector<float> read_times(const GltfModel& model, const JsonView& input, ImportShare& share) {
  const GltfAccessor& accessor = accessor_of(model, input);
  if (accessor.width != 1 || accessor.component != Component::f32) input.fail("times must be scalar floats");
  std::vector<float> times = counted_floats(model, accessor, input, share);
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || times[i] < 0 || (i > 0 && times[i] <= times[i - 1]))
      input.fail("time " + std::to_string(i) + " is negative, not finite, or not later than the one before");
  return times;
}

void read_sampler(const GltfModel& model, const JsonView& sampler, AnimationChannel& channel, ImportShare& share) {
  static constexpr std::array<std::string_view, 3> kInterpolations{"LINEAR", "STEP", "CUBICSPLINE"};
  if (const auto interpolation = member(sampler, "interpolation"))
    channel.interpolation = static_cast<Interpolation>(interpolation->one_of(kInterpolations));
  channel.times = read_times(model, sampler.at("input"), share);
  const JsonView output = sampler.at("output");
  const GltfAccessor& accessor = accessor_of(model, output);
  const std::size_t parts = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const bool is_whole = accessor.count % (channel.times.size() * parts) == 0;
  if (!is_whole)
    output.fail(std::to_string(accessor.count) + " values do not fit " + std::to_string(channel.times.size()) +
                " times");
  // Several scalars a keyframe: morph weights, an array of numbers.
  channel.width = accessor.width * (accessor.count / (channel.times.size() * parts));
  if (channel.is_rotation && channel.width != 4) output.fail("a rotation has four numbers");
  channel.values = counted_floats(model, accessor, output, share);
  for (std::size_t i = 0; i < channel.values.size(); ++i)
    if (!std::isfinite(channel.values[i])) output.fail("number " + std::to_string(i) + " is not finite");
}

Animation read_animation(const JsonView& root, const GltfModel& model, const JsonView& view, std::size_t number,
                         ImportShare& share) {
  Animation animation;
  if (view.has("name")) animation.name = printable(view.at("name").text());
  if (animation.name.empty()) animation.name = "animation_" + std::to_string(number);
  for_each_object(view, "channels", [&](const JsonView& place, std::size_t) {
    AnimationChannel channel;
    channel.where = place.pointer();
    const JsonView target = place.at("target");
    channel.pointer = pointer_of(root, target);
    if (channel.pointer.empty()) {
      animation.warnings.push_back(channel.where + ": the channel has no target: it is left out");
      return;
    }
    channel.is_rotation = is_node_rotation(target, channel.pointer);
    const std::size_t sampler = reference(place.at("sampler"), array_size(view, "samplers"), "sampler");
    read_sampler(model, view.at("samplers").at(sampler), channel, share);
    animation.channels.push_back(std::move(channel));
  });
  return animation;
}

}  // namespace

std::vector<Animation> import_animations(const std::filesystem::path& path) {
  GltfSource source = read_gltf_source(path);
  std::vector<std::string> unused;  // of the scene; whoever imports it says them
  check_document(source.json, source.file, unused);
  ImportShare share;
  auto buffers = load_buffers(source, share);
  GltfModel model = parse_model(source.json, std::move(buffers), source.file);
  const JsonView root(source.json, source.file);
  unpack_meshopt(root, model, accessors_of_animations(root, model), unused, share);
  std::vector<Animation> animations;
  for_each_object(root, "animations", [&](const JsonView& view, std::size_t i) {
    animations.push_back(read_animation(root, model, view, i, share));
  });
  return animations;
}

}  // namespace relook
