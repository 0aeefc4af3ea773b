#include "edit/effect/material_changes.h"

#include <algorithm>
#include <cstdio>
#include <type_traits>

namespace relook {
namespace {

std::string text_of_value(float x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%g", static_cast<double>(x));
  return digits;
}
std::string text_of_value(const Color& c) {
  return "(" + text_of_value(c.x) + ", " + text_of_value(c.y) + ", " + text_of_value(c.z) + ")";
}
std::string text_of_value(const Rgba& c) {
  return "(" + text_of_value(c.r) + ", " + text_of_value(c.g) + ", " + text_of_value(c.b) + ", " + text_of_value(c.a) +
         ")";
}
std::string text_of_value(const std::string& text) { return text; }
std::string text_of_value(bool flag) { return flag ? "yes" : "no"; }
/// A list of "what before -> after".
class Sentence {
 public:
  template <class Value>
  void compare(std::string_view what, const Value& before, const Value& after) {
    if (before != after) add(std::string(what) + " " + text_of_value(before) + " -> " + text_of_value(after));
  }
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  [[nodiscard]] std::string text() const { return text_; }

 private:
  std::string text_;
};

std::string describe_slot(const TextureSlot& before, const TextureSlot& after) {
  if (before.kind == TextureKind::none) return "added";
  if (after.kind == TextureKind::none) return "removed";
  if (before.kind != after.kind || before.pyramid != after.pyramid) return "replaced";
  if (before.procedural != after.procedural) return "parameters changed";
  if (before.mapping != after.mapping || before.axis != after.axis || before.texcoord != after.texcoord)
    return "mapped otherwise";
  return "transformed";
}

using Image = std::shared_ptr<const TexturePyramid>;
void describe_image(const std::string& what, const Image& before, const Image& after, Sentence& sentence) {
  if (before == after) return;
  sentence.add(what + (before == nullptr ? " added" : after == nullptr ? " removed" : " replaced"));
}

void describe_background(const std::optional<Background>& before, const std::optional<Background>& after,
                         Sentence& sentence) {
  if (before.has_value() != after.has_value()) return sentence.add(after ? "background added" : "background removed");
  if (!before) return;
  sentence.compare("background colour", before->color, after->color);
  sentence.compare("background intensity", before->intensity, after->intensity);
  sentence.compare("background rotation", before->rotation, after->rotation);
  describe_image("background image", before->image, after->image, sentence);
}

void describe(const MaterialRow& row, const Material& before, const Material& after, Sentence& sentence) {
  std::visit(
      [&](const auto member) {
        if constexpr (std::is_same_v<decltype(member), const Slot>) {
          sentence.add(std::string(row.words) + " " + describe_slot(before.slot(member), after.slot(member)));
        } else if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(before.*member)>>) {
          const auto word = [&](auto value) { return std::string(row.choices[static_cast<std::size_t>(value)]); };
          sentence.compare(row.words, word(before.*member), word(after.*member));
        } else {
          sentence.compare(row.words, before.*member, after.*member);
        }
      },
      row.member);
}

}  // namespace

std::string describe_values(const Color& before, const Color& after) {
  return text_of_value(before) + " -> " + text_of_value(after);
}

std::string describe_material_change(const Material& before, const Material& after, std::span<const MaterialRow> rows) {
  std::vector<const MaterialRow*> changed;
  for (const MaterialRow& row : rows)
    if (differs(row, before, after)) changed.push_back(&row);
  std::ranges::sort(changed, {}, &MaterialRow::bit);
  Sentence sentence;
  for (const MaterialRow* row : changed) describe(*row, before, after, sentence);
  return sentence.text();
}

std::string name_of_sum(const Light& light) { return light.sum.empty() ? "of its own" : "\"" + light.sum + "\""; }

std::string describe_light_change(const Light& before, const Light& after) {
  Sentence s;
  s.compare("light", before.light, after.light);
  s.compare("colour", before.color, after.color);
  s.compare("intensity", before.intensity, after.intensity);
  s.compare("range", before.range, after.range);
  s.compare("inner cone", before.inner_cone, after.inner_cone);
  s.compare("outer cone", before.outer_cone, after.outer_cone);
  s.compare("radius", before.radius, after.radius);
  s.compare("angle", before.angle, after.angle);
  if (const float was = before.up.length(), is = after.up.length(); was != is)
    s.compare("height", 2 * was, 2 * is);
  if (const float was = before.right.length(), is = after.right.length(); was != is)
    s.compare("width", 2 * was, 2 * is);
  s.compare("visible", before.visible, after.visible);
  s.compare("rate", before.rate, after.rate);
  if (before.sum != after.sum) s.add("sum of light " + name_of_sum(before) + " -> " + name_of_sum(after));
  s.compare("rotation", before.rotation, after.rotation);
  if (before.excluded != after.excluded) s.add("lights other objects");
  if (before.emission != after.emission) s.add("texture " + describe_slot(before.emission, after.emission));
  describe_image("image", before.image, after.image, s);
  if (s.text().empty()) s.add("turned about its axis");
  return s.text();
}

std::string describe_environment_change(const Environment& before, const Environment& after) {
  Sentence s;
  s.compare("colour", before.color, after.color);
  s.compare("intensity", before.intensity, after.intensity);
  s.compare("rotation", before.rotation, after.rotation);
  describe_image("image", before.image, after.image, s);
  describe_background(before.background, after.background, s);
  return s.text();
}

}  // namespace relook
