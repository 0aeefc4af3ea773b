#include "color/compress/stored_columns.h"

#include <cstring>

namespace relook {
namespace {

bool is_one_value(const float* values, std::size_t lanes) {
  for (std::size_t lane = 1; lane < lanes; ++lane)
    if (std::memcmp(&values[lane], &values[0], sizeof(float)) != 0) return false;
  return true;
}

}  // namespace

void StoredColumns::pack() {
  const auto equal = [&](const Vector* a, const Vector* b) { return std::memcmp(a, b, lanes_ * sizeof(float)) == 0; };
  std::vector<Vector> kept;
  std::vector<std::uint32_t> firsts;  // of the kept columns
  for (Stored& stored : columns_) {
    const Vector* column = &values_[stored.first];
    if (is_one_value(column->lanes.data(), lanes_)) {
      stored = {kShared, column->lanes[0]};
      continue;
    }
    const auto same = std::ranges::find_if(firsts, [&](std::uint32_t first) { return equal(&kept[first], column); });
    if (same != firsts.end()) {
      stored.first = *same;
      continue;
    }
    stored.first = static_cast<std::uint32_t>(kept.size());
    firsts.push_back(stored.first);
    kept.insert(kept.end(), column, column + length());
  }
  kept.shrink_to_fit();
  values_ = std::move(kept);
}

}  // namespace relook
