#include "scene/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace relook {
namespace {

using Numbers = std::vector<double>;

/// Part `part` of keyframe `key`: a cubic spline's in-tangent, value, out-tangent; else the value alone, 0.
Numbers keyed(const AnimationChannel& channel, std::size_t key, std::size_t part, std::size_t parts) {
  const auto first = channel.values.begin() + static_cast<std::ptrdiff_t>((key * parts + part) * channel.width);
  return {first, first + static_cast<std::ptrdiff_t>(channel.width)};
}

Numbers weighted_sum(double a, const Numbers& x, double b, const Numbers& y) {
  Numbers sum(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) sum[i] = a * x[i] + b * y[i];
  return sum;
}

Numbers normalized(Numbers q) {
  const double length = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
  if (length > 0)
    for (double& component : q) component /= length;
  return q;
}

/// Appendix C.4, the shorter way around.
Numbers slerp(const Numbers& from, const Numbers& to, double t) {
  constexpr double kNearlyEqual = 1e-6;  // radians
  const double dot = std::inner_product(from.begin(), from.end(), to.begin(), 0.0);
  const double angle = std::acos(std::min(std::abs(dot), 1.0)), sign = dot < 0 ? -1 : 1;
  if (angle < kNearlyEqual) return normalized(weighted_sum(1 - t, from, sign * t, to));
  const double sine = std::sin(angle);
  return normalized(weighted_sum(std::sin(angle * (1 - t)) / sine, from, sign * std::sin(angle * t) / sine, to));
}

/// Appendix C.5.
Numbers cubic(const AnimationChannel& channel, std::size_t key, double t, double seconds) {
  const double t2 = t * t, t3 = t2 * t;
  const Numbers starts = weighted_sum(2 * t3 - 3 * t2 + 1, keyed(channel, key, 1, 3), seconds * (t3 - 2 * t2 + t),
                                      keyed(channel, key, 2, 3));
  const Numbers ends =
      weighted_sum(-2 * t3 + 3 * t2, keyed(channel, key + 1, 1, 3), seconds * (t3 - t2), keyed(channel, key + 1, 0, 3));
  return weighted_sum(1, starts, 1, ends);
}

Numbers between_keys(const AnimationChannel& channel, double time) {
  const bool is_cubic = channel.interpolation == Interpolation::cubic_spline;
  const auto key_value = [&](std::size_t key) { return keyed(channel, key, is_cubic ? 1 : 0, is_cubic ? 3 : 1); };
  const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), time,
                                      [](double at, float key) { return at < static_cast<double>(key); });
  if (after == channel.times.begin()) return key_value(0);
  const auto key = static_cast<std::size_t>(after - channel.times.begin()) - 1;
  if (after == channel.times.end() || channel.interpolation == Interpolation::step) return key_value(key);
  const auto start = static_cast<double>(channel.times[key]);
  const double seconds = static_cast<double>(*after) - start, t = (time - start) / seconds;
  if (is_cubic) return cubic(channel, key, t, seconds);
  if (channel.is_rotation) return slerp(normalized(key_value(key)), normalized(key_value(key + 1)), t);
  return weighted_sum(1 - t, key_value(key), t, key_value(key + 1));
}

}  // namespace

std::vector<double> value_at(const AnimationChannel& channel, double time) {
  Numbers value = between_keys(channel, time);
  return channel.is_rotation ? normalized(std::move(value)) : value;
}

}  // namespace relook
