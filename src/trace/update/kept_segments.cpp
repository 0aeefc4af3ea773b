#include "trace/update/kept_segments.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/vector_clones.h"
#include "trace/tree/segment_tests.h"

namespace relook {
namespace {

constexpr std::size_t kScanned = 256;  // segments at a time
using Near = std::array<std::uint8_t, kScanned>;

/// Which of some segments may touch a box, by separating axes: those of the box, and those across its own and the
/// segment's. `ends`: of the first. Twice everything, so that whole numbers stay whole.
RELOOK_VECTOR_CLONES
void find_near(const std::array<const std::uint16_t*, 6>& ends, std::size_t count, const GridBox& box, Near& near) {
  const std::uint16_t *const ax = ends[0], *const ay = ends[1], *const az = ends[2];
  const std::uint16_t *const bx = ends[3], *const by = ends[4], *const bz = ends[5];
  const float cx = box.sum[0], cy = box.sum[1], cz = box.sum[2];
  const float ex = box.size[0], ey = box.size[1], ez = box.size[2];
  for (std::size_t i = 0; i < count; ++i) {
    const float x0 = ax[i], y0 = ay[i], z0 = az[i], x1 = bx[i], y1 = by[i], z1 = bz[i];
    const float sx = x0 + x1 - cx, sy = y0 + y1 - cy, sz = z0 + z1 - cz;
    const float dx = x1 - x0, dy = y1 - y0, dz = z1 - z0;
    const float lx = std::fabs(dx), ly = std::fabs(dy), lz = std::fabs(dz);
    const bool is_in = (std::fabs(sx) <= ex + lx) & (std::fabs(sy) <= ey + ly) & (std::fabs(sz) <= ez + lz);
    const bool is_across = (std::fabs(dy * sz - dz * sy) <= ey * lz + ez * ly) &
                           (std::fabs(dz * sx - dx * sz) <= ex * lz + ez * lx) &
                           (std::fabs(dx * sy - dy * sx) <= ex * ly + ey * lx);
    near[i] = is_in & is_across;
  }
}

bool any_of(const Near& near, std::size_t count) { return std::memchr(near.data(), 1, count) != nullptr; }

SegmentKind kind_of(ShadowState state) {
  return state == ShadowState::blocked ? SegmentKind::blocked : SegmentKind::open;
}

}  // namespace

void TileSegments::add(SegmentKind kind, const Ray& ray) {
  List& list = lists_[static_cast<std::size_t>(kind)];
  const GridEnds ends = grid_.ends_of(ray);
  for (std::size_t k = 0; k < ends.size(); ++k) list.ends[k].push_back(ends[k]);
  for (int axis = 0; axis < 3; ++axis) list.largest = std::max(list.largest, std::fabs(ray.origin[axis]));
}

void TileSegments::append(const RayScene& scene, const TreeBlock& block, std::uint32_t root) {
  const std::uint32_t sample = block.nodes[root].sample;
  const std::size_t lights = scene.light_order().size();
  for (std::size_t i = root; i < block.nodes.size() && block.nodes[i].sample == sample; ++i) {
    const RayNode& node = block.nodes[i];
    if (node.object.is_none()) {
      add(SegmentKind::ray, stored_segment(node.ray));
      continue;
    }
    add(SegmentKind::ray, stored_segment(node, distance_slack(node, scene.object(node.object))));
    for (std::size_t link = node.first_light; link < node.first_light + lights; ++link)
      if (block.lights[link].state != ShadowState::facing_away) {
        const SegmentLine& line = block.lines[link];
        add(kind_of(block.lights[link].state), {line.origin, line.direction, line.t_max});
      }
  }
  for (List& list : lists_) list.first.push_back(hit_place(list.ends[0].size()));
}

void TileSegments::append(const TileSegments& other, std::size_t from, std::size_t to) {
  for (std::size_t kind = 0; kind < kSegmentKinds; ++kind) {
    List& list = lists_[kind];
    const List& more = other.lists_[kind];
    const std::uint32_t begin = more.first[from], end = more.first[to];
    const std::size_t here = list.ends[0].size();
    for (std::size_t k = 0; k < list.ends.size(); ++k)
      list.ends[k].insert(list.ends[k].end(), more.ends[k].begin() + begin, more.ends[k].begin() + end);
    for (std::size_t sample = from; sample < to; ++sample)
      list.first.push_back(hit_place(here + more.first[sample + 1] - begin));
    list.largest = std::max(list.largest, more.largest);
  }
}

void TileSegments::shrink_to_fit() {
  for (List& list : lists_)
    for (auto& ends : list.ends) ends.shrink_to_fit();
}

void TileSegments::reserve(const TileSegments& some, const TileSegments& others) {
  for (std::size_t kind = 0; kind < kSegmentKinds; ++kind) {
    const List &a = some.lists_[kind], &b = others.lists_[kind];
    lists_[kind].first.reserve(a.first.size());
    for (auto& ends : lists_[kind].ends) ends.reserve(a.ends[0].size() + b.ends[0].size());
  }
}

std::size_t TileSegments::bytes() const {
  std::size_t bytes = 0;
  for (const List& list : lists_) {
    bytes += list.first.capacity() * sizeof(std::uint32_t);
    for (const auto& ends : list.ends) bytes += ends.capacity() * sizeof(std::uint16_t);
  }
  return bytes;
}

std::vector<GridBox> TileSegments::grid_boxes(const List& list, const SelectionBoxes& boxes, float condition) const {
  const float margin = list.largest * (0x1p-16F * condition);  // as range_in() has it
  std::vector<GridBox> in_grid;
  const auto all = grid_.around(boxes.all, margin);
  if (!all) return in_grid;
  in_grid.push_back(*all);
  for (const Box& part : boxes.parts)
    if (const auto box = grid_.around(part, margin)) in_grid.push_back(*box);
  // Parts that are too small for the grid leave all as it is.
  if (in_grid.size() != 1 + boxes.parts.size()) in_grid.resize(1);
  return in_grid;
}

bool TileSegments::can_tell(const SegmentSelection& selection) const {
  for (std::size_t kind = 0; kind < kSegmentKinds; ++kind)
    if (!selection.of[kind].all.isEmpty() && grid_boxes(lists_[kind], selection.of[kind], selection.condition).empty())
      return false;
  return true;
}

void TileSegments::find_touched(const SegmentSelection& selection, std::span<std::uint8_t> touched) const {
  for (std::size_t kind = 0; kind < kSegmentKinds; ++kind)
    if (!selection.of[kind].all.isEmpty())
      find_touched(lists_[kind], grid_boxes(lists_[kind], selection.of[kind], selection.condition), touched);
}

void TileSegments::find_touched(const List& list, std::span<const GridBox> boxes, std::span<std::uint8_t> touched) {
  const std::span<const GridBox> parts = boxes.subspan(1);
  Near near, of_part;
  std::size_t sample = 0;
  const std::size_t segments = list.ends[0].size();
  for (std::size_t first = 0; first < segments; first += kScanned) {
    const std::size_t count = std::min(kScanned, segments - first);
    std::array<const std::uint16_t*, 6> ends;
    for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = list.ends[k].data() + first;
    find_near(ends, count, boxes.front(), near);
    if (!any_of(near, count)) continue;
    if (!parts.empty()) {
      near.fill(0);
      for (const GridBox& part : parts) {
        find_near(ends, count, part, of_part);
        for (std::size_t i = 0; i < count; ++i) near[i] |= of_part[i];
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (near[i] == 0) continue;
      while (list.first[sample + 1] <= first + i) ++sample;
      touched[sample] = 1;
    }
  }
}

}  // namespace relook
