// The animations of a glTF file (glTF 2.0 section 3.11, KHR_animation_pointer), read for journals alone: frames show a
// scene as it stands in the file. Sampling follows glTF 2.0 appendix C.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace relook {

enum class Interpolation : std::uint8_t { linear, step, cubic_spline };

/// Keyframes of one property.
struct AnimationChannel {
  std::string pointer;  // the property in the glTF document: "/nodes/2/rotation", "/materials/0/alphaCutoff"
  std::string where;    // "/animations/0/channels/1", for messages
  Interpolation interpolation = Interpolation::linear;
  bool is_rotation = false;   // a node's quaternion, xyzw
  std::size_t width = 1;      // numbers of a value
  std::vector<float> times;   // seconds, strictly increasing; at least one
  std::vector<float> values;  // [times][width]; cubic spline: [times][in-tangent, value, out-tangent][width]
};

struct Animation {
  std::string name;  // "animation_2" without one; names may repeat
  std::vector<AnimationChannel> channels;
  std::vector<std::string> warnings;  // channels left out: without a target
};

/// Throws InputError{file, pointer or "byte N", ...}.
[[nodiscard]] std::vector<Animation> import_animations(const std::filesystem::path& path);

/// The `width` numbers at a time in seconds; before the first and after the last keyframe theirs. Rotations are unit
/// quaternions.
[[nodiscard]] std::vector<double> value_at(const AnimationChannel& channel, double time);

}  // namespace relook
