#include "region/tunnel.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace relook {
namespace {

/// The section of a history, put in if it is not there. Searched from the end: trees are walked in preorder, so that
/// the wanted one is near it.
TunnelSection& section_of(Sections& tunnel, History history) {
  std::size_t at = tunnel.size();
  while (at > 0 && tunnel[at - 1].history > history) --at;
  if (at > 0 && tunnel[at - 1].history == history) return tunnel[at - 1];
  TunnelSection section;
  section.history = history;
  return *tunnel.insert(tunnel.begin() + static_cast<std::ptrdiff_t>(at), section);
}

void extend(Box& box, const Point& point, float margin) {
  const Point around(margin, margin, margin);
  box.extendBy(point - around);
  box.extendBy(point + around);
}

Box grown(const Box& box, float margin) {
  const Point around(margin, margin, margin);
  return Box(box.min - around, box.max + around);
}

/// The metres that a ray from `from` has to be followed until it is past all of `target`.
float reach(const Box& from, const Box& target) {
  Box all = from;
  all.extendBy(target);
  return all.size().length() * 1.01F;
}

/// Where the rays of a section start.
Box origins_of(std::span<const TunnelSection> tunnel, const TunnelSection& section) {
  const TunnelSection* const parent = find_section(tunnel, section.history.parent());
  require(parent != nullptr, "a section's parent is in the tunnel");
  Box origins = parent->points;
  if (section.history.is_folded()) origins.extendBy(section.points);
  return origins;
}

/// What rounding can do to a ray between these boxes, in metres, as the objects of the change see it.
float margin(const Box& from, const Box& to, const ChangeBoxes& change) {
  constexpr float kRounding = 0x1p-16F;
  float largest = 0;
  for (const Box* box : {&from, &to})
    for (int axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::max(std::fabs(box->min[axis]), std::fabs(box->max[axis])));
  return largest * kRounding * change.condition;
}

/// Is the target in the way of segments between the boxes?
bool is_between(const Box& from, const Box& to, float slack, const BoxSet& target, const TunnelTest& test) {
  const float around = margin(from, to, test.change);
  return touches({grown(from, around), grown(to, around + slack)}, target);
}
/// Is it in the way of rays from a box in some unit directions?
bool is_beyond(const Box& from, const Box& directions, const BoxSet& target, const TunnelTest& test) {
  const Shaft shaft = extruded(from, directions, reach(from, target.all));
  return is_between(shaft.from, shaft.to, 0, target, test);
}

bool is_ray_touched(std::span<const TunnelSection> tunnel, const TunnelSection& section, const TunnelTest& test) {
  const BoxSet& target = test.change.moved;
  if (section.history.is_eye() || target.empty()) return false;
  const Box origins = origins_of(tunnel, section);
  if (!section.points.isEmpty() && is_between(origins, section.points, section.slack, target, test)) return true;
  return !section.leaving.isEmpty() && is_beyond(origins, section.leaving, target, test);
}

bool is_light_touched(const TunnelSection& section, const LightEnd& light, const BoxSet& target,
                      const TunnelTest& test) {
  if (target.empty()) return false;
  return light.directional ? is_beyond(section.points, light.end, target, test)
                           : is_between(section.points, light.end, 0, target, test);
}

/// Marks the histories above each touched one: something below them is touched.
void mark_ancestors(Touches& touches) {
  const std::size_t touched = touches.size();
  for (std::size_t i = 0; i < touched; ++i) {
    for (History history = touches[i].history; !history.is_eye();) {
      history = history.parent();
      const auto it = std::ranges::find(touches, history, &Touch::history);
      if (it != touches.end()) {
        it->below = true;
        continue;
      }
      Touch ancestor;
      ancestor.history = history;
      ancestor.below = true;
      touches.push_back(ancestor);
    }
    if (touches[i].history.is_folded()) touches[i].below = true;
  }
  std::ranges::sort(touches, {}, &Touch::history);
}

}  // namespace

void enclose(Sections& tunnel, const RayScene& scene, const TreeBlock& block, std::uint32_t root,
             std::vector<History>& scratch) {
  const std::size_t lights = scene.light_order().size();
  const std::uint32_t sample = block.nodes[root].sample;
  scratch.clear();
  for (std::uint32_t i = root; i < block.nodes.size() && block.nodes[i].sample == sample; ++i) {
    const RayNode& node = block.nodes[i];
    const bool is_primary = i == root;
    scratch.push_back(is_primary ? History::primary() : scratch[node.parent - root].child(node.ray.branch));
    if (is_primary) section_of(tunnel, History::eye()).points.extendBy(node.ray.origin);
    TunnelSection& section = section_of(tunnel, scratch.back());
    if (node.object.is_none()) {
      section.leaving.extendBy(node.ray.direction);
      continue;
    }
    const RayObject& object = scene.object(node.object);
    extend(section.points, node.point.position, node.point.offset);
    extend(section.points, node.point.position + node.point.lift, node.point.offset);
    section.slack = std::max(section.slack, distance_slack(node, object));
    for (std::size_t light = 0; light < lights; ++light) {
      const ShadowState state = block.lights[node.first_light + light].state;
      if (state == ShadowState::blocked) section.blocked.add(light);
      if (state == ShadowState::open || state == ShadowState::filtered) section.open.add(light);
    }
  }
}

const TunnelSection* find_section(std::span<const TunnelSection> tunnel, History history) {
  const auto it = std::ranges::lower_bound(tunnel, history, {}, &TunnelSection::history);
  return it != tunnel.end() && it->history == history ? &*it : nullptr;
}

namespace {

/// Makes room for the histories of another tunnel, in one pass.
void add_histories(Sections& tunnel, std::span<const TunnelSection> other) {
  const bool has_all = std::ranges::includes(tunnel, other, {}, &TunnelSection::history, &TunnelSection::history);
  if (has_all) return;
  Sections both;
  both.reserve(std::max(tunnel.size(), other.size()));
  auto own = tunnel.begin();
  for (const TunnelSection& section : other) {
    for (; own != tunnel.end() && own->history < section.history; ++own) both.push_back(*own);
    if (own != tunnel.end() && own->history == section.history) {
      both.push_back(*own++);
    } else {
      both.emplace_back();
      both.back().history = section.history;
    }
  }
  both.insert(both.end(), own, tunnel.end());
  tunnel = std::move(both);
}

}  // namespace

void enclose(Sections& tunnel, std::span<const TunnelSection> other) {
  add_histories(tunnel, other);
  auto at = tunnel.begin();
  for (const TunnelSection& section : other) {
    while (at->history != section.history) ++at;
    TunnelSection& own = *at;
    own.slack = std::max(own.slack, section.slack);
    own.open |= section.open;
    own.blocked |= section.blocked;
    own.points.extendBy(section.points);
    own.leaving.extendBy(section.leaving);
  }
}

namespace {

LightEnd end_of(const RayLight& light) {
  const bool directional = !traits_of(light.kind).has_place;
  return {directional, Box(directional ? -light.direction : light.position)};
}

}  // namespace

std::vector<LightEnd> light_ends(const RayScene& scene) {
  std::vector<LightEnd> ends;
  for (std::size_t place = 0; place < scene.light_order().size(); ++place) ends.push_back(end_of(scene.light(place)));
  return ends;
}

std::vector<LightEnd> light_ends(const Scene& scene) {
  std::vector<LightEnd> ends;
  for (const LightId id : scene.light_order) ends.push_back(end_of(scene.light(id)));
  return ends;
}

double surface_area(std::span<const TunnelSection> tunnel, const std::vector<LightEnd>& lights) {
  Box all;
  for (const TunnelSection& section : tunnel) all.extendBy(section.points);
  const float extent = all.isEmpty() ? 0 : all.size().length();
  double area = 0;
  for (const TunnelSection& section : tunnel) {
    if (section.history.is_eye()) continue;
    const Box origins = origins_of(tunnel, section);
    if (!section.points.isEmpty()) area += surface_area({origins, section.points});
    if (!section.leaving.isEmpty()) area += surface_area(extruded(origins, section.leaving, extent));
    for (std::size_t light = 0; !section.points.isEmpty() && light < lights.size(); ++light) {
      if (!(section.open | section.blocked).has(light)) continue;
      const LightEnd& end = lights[light];
      area +=
          surface_area(end.directional ? extruded(section.points, end.end, extent) : Shaft{section.points, end.end});
    }
  }
  return area;
}

BoxSet box_set(std::vector<Box>& boxes, std::size_t most) {
  BoxSet set;
  for (const Box& box : boxes) set.all.extendBy(box);
  if (boxes.size() < 2) return set;
  // Halves the part with the longest side at its middle object, until there are enough parts.
  struct Part {
    std::size_t first, last;
    Box box;
  };
  std::vector<Part> parts{{0, boxes.size(), set.all}};
  const auto length = [](const Part& part) {
    const Point size = part.box.size();
    return part.last - part.first < 2 ? -1.0F : std::max(std::max(size.x, size.y), size.z);
  };
  while (parts.size() < most) {
    const auto longest = std::ranges::max_element(parts, {}, length);
    if (length(*longest) < 0) break;
    const Part part = *longest;
    const unsigned axis = part.box.majorAxis();
    const std::size_t middle = (part.first + part.last) / 2;
    const auto at = [&](std::size_t i) { return boxes.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(part.first), at(middle), at(part.last), [axis](const Box& a, const Box& b) {
      return a.min[static_cast<int>(axis)] + a.max[static_cast<int>(axis)] <
             b.min[static_cast<int>(axis)] + b.max[static_cast<int>(axis)];
    });
    const auto around = [&](std::size_t first, std::size_t last) {
      Part half{first, last, {}};
      for (std::size_t i = first; i < last; ++i) half.box.extendBy(boxes[i]);
      return half;
    };
    *longest = around(part.first, middle);
    parts.push_back(around(middle, part.last));
  }
  for (const Part& part : parts) set.parts.push_back(part.box);
  return set;
}

bool touches(const Shaft& shaft, const BoxSet& boxes) {
  if (boxes.empty() || !touches(shaft, boxes.all)) return false;
  return boxes.parts.empty() || std::ranges::any_of(boxes.parts, [&](const Box& part) { return touches(shaft, part); });
}

bool find_touches(std::span<const TunnelSection> tunnel, const TunnelTest& test, Touches* touches) {
  if (touches != nullptr) touches->clear();
  bool any = false;
  for (const TunnelSection& section : tunnel) {
    Touch touch;
    touch.history = section.history;
    touch.ray = is_ray_touched(tunnel, section, test);
    for (std::size_t light = 0; !(section.open | section.blocked).empty() && light < test.lights.size(); ++light) {
      const bool is_open = section.open.has(light), is_blocked = section.blocked.has(light);
      const bool after = (is_open || (is_blocked && test.change.count_blockers)) &&
                         is_light_touched(section, test.lights[light], test.change.shadows_after, test);
      const bool before = is_blocked && is_light_touched(section, test.lights[light], test.change.shadows_before, test);
      if (is_open && after) touch.open.add(light);
      if (before || (is_blocked && after)) touch.blocked.add(light);
    }
    if (!touch.ray && (touch.open | touch.blocked).empty()) continue;
    if (touches == nullptr) return true;
    any = true;
    touches->push_back(touch);
  }
  if (any) mark_ancestors(*touches);
  return any;
}

}  // namespace relook
