#include "edit/wedge/wedge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace relook {
namespace {

constexpr std::size_t kLongestText = 60;    // bytes, of a value in few characters
constexpr std::size_t kLongestValue = 400;  // bytes of JSON, of a value in a report
constexpr std::size_t kMostTexts = 1000;    // of an axis

double between(double from, double to, std::size_t i, std::size_t count, RangeScale scale) {
  if (i == 0) return from;
  if (i + 1 == count) return to;
  const double share = static_cast<double>(i) / static_cast<double>(count - 1);
  return scale == RangeScale::log ? from * std::pow(to / from, share) : from + (to - from) * share;
}

/// The last value of a range is `to` where rounding alone keeps it from that.
double stepped(double from, double to, double step, std::size_t i, RangeScale scale) {
  constexpr double kRounding = 1e-6;  // of a step
  const auto steps = static_cast<double>(i);
  const bool is_log = scale == RangeScale::log;
  const double value = is_log ? from * std::pow(step, steps) : from + step * steps;
  const double left = is_log ? std::log(to / value) / std::log(step) : (to - value) / step;
  return left < kRounding ? to : value;
}

using Quaternion = std::array<double, 4>;

Quaternion quaternion_of(const Json& value) {
  Quaternion q{};
  double length = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    q[k] = value[k].get<double>();
    length += q[k] * q[k];
  }
  length = std::sqrt(length);
  for (double& part : q) part = length > 0 ? part / length : part;
  return q;
}

/// Shoemake, "Animating rotation with quaternion curves" (1985): along the great arc, the shorter one.
Json turned(const Json& from, const Json& to, std::size_t i, std::size_t count) {
  if (i == 0) return from;
  if (i + 1 == count) return to;
  const Quaternion a = quaternion_of(from);
  Quaternion b = quaternion_of(to);
  double cosine = 0;
  for (std::size_t k = 0; k < a.size(); ++k) cosine += a[k] * b[k];
  if (cosine < 0)
    for (double& part : b) part = -part;
  const double angle = std::acos(std::min(std::fabs(cosine), 1.0));
  const double share = static_cast<double>(i) / static_cast<double>(count - 1), sine = std::sin(angle);
  const double of_a = sine > 0 ? std::sin((1 - share) * angle) / sine : 1 - share;
  const double of_b = sine > 0 ? std::sin(share * angle) / sine : share;
  Quaternion q{};
  double length = 0;
  for (std::size_t k = 0; k < q.size(); ++k) {
    q[k] = of_a * a[k] + of_b * b[k];
    length += q[k] * q[k];
  }
  Json value = Json::array();
  for (const double part : q) value.push_back(part / std::sqrt(length));
  return value;
}

/// "/nodes/NAME/rotation"
bool is_rotation(const std::string& path) {
  return path.starts_with("/nodes/") && path.ends_with("/rotation") && std::ranges::count(path, '/') == 3;
}

std::string number_text(const Json& value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value.get<double>());
  return text;
}

std::string cut(std::string text) {
  if (text.size() <= kLongestText) return text;
  std::size_t end = kLongestText;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // within a character of UTF-8
  return text.substr(0, end) + "…";
}

std::string short_text(const Json& value) {
  if (value.is_number()) return number_text(value);
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_string()) return cut(value.get<std::string>());
  const bool is_numbers = value.is_array() && !value.empty() && std::ranges::all_of(value, &Json::is_number);
  if (!is_numbers) {
    for (const char* key : {"uri", "asset", "name"})
      if (value.is_object() && value.contains(key) && value[key].is_string()) return cut(value[key].get<std::string>());
    return cut(value.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  std::string text;
  for (const Json& part : value) text += (text.empty() ? "" : ", ") + number_text(part);
  return cut(text);
}

}  // namespace

Json WedgeAxis::value(std::size_t i) const {
  if (!values.empty()) return values[i];
  if (from.is_array() && from.size() == 4 && is_rotation(path)) return turned(from, to, i, count);
  const auto at = [&](const Json& first, const Json& last) {
    return step != 0 ? stepped(first.get<double>(), last.get<double>(), step, i, scale)
                     : between(first.get<double>(), last.get<double>(), i, count, scale);
  };
  if (!from.is_array()) return at(from, to);
  Json list = Json::array();
  for (std::size_t k = 0; k < from.size(); ++k) list.push_back(at(from[k], to[k]));
  return list;
}

std::string WedgeAxis::text(std::size_t i) const { return labels.empty() ? short_text(value(i)) : labels[i]; }

PatchOperation WedgeAxis::operation(std::size_t i) const {
  PatchOperation operation;
  operation.path = path;
  operation.where = where;
  operation.value_where = where + (values.empty() ? "/range" : "/values/" + std::to_string(i));
  operation.value = value(i);
  operation.may_create = true;
  return operation;
}

std::size_t Wedge::size() const {
  std::size_t frames = axes.empty() ? 0 : 1;
  for (const WedgeAxis& axis : axes) frames *= axis.count;
  return frames;
}

std::size_t Wedge::place(std::size_t frame, std::size_t axis) const {
  for (std::size_t later = axes.size(); --later > axis;) frame /= axes[later].count;
  return frame % axes[axis].count;
}

Edit Wedge::operator[](std::size_t frame) const {
  Edit edit;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) edit.push_back(axes[axis].operation(place(frame, axis)));
  return edit;
}

Json Wedge::values_json(std::size_t frame) const {
  Json list = Json::array();
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const WedgeAxis& of = axes[axis];
    const std::size_t i = place(frame, axis);
    Json entry{{"path", of.path}, {"label", of.label}, {"text", of.text(i)}};
    Json value = of.value(i);
    if (value.dump(-1, ' ', false, Json::error_handler_t::replace).size() <= kLongestValue)
      entry["value"] = std::move(value);
    list.push_back(std::move(entry));
  }
  return list;
}

Json Wedge::axes_json() const {
  Json list = Json::array();
  for (const WedgeAxis& axis : axes) {
    Json texts = Json::array();
    for (std::size_t i = 0; i < axis.count && axis.count <= kMostTexts; ++i) texts.push_back(axis.text(i));
    list.push_back({{"path", axis.path}, {"label", axis.label}, {"texts", std::move(texts)}});
  }
  return list;
}

}  // namespace relook
