#include "image/path_index.h"

namespace relook {
namespace {

std::uint32_t count_segments(std::span<const std::uint32_t> path, const PathLayout& layout) {
  std::uint32_t segments = 0;
  for (PathCursor cursor(path, layout); !cursor.at_end();) segments += cursor.next().segments();
  return segments;
}

}  // namespace

void PathIndex::extend(const PathTable& paths, const PathLayout& layout) {
  for (auto p = static_cast<std::uint32_t>(segments_.size()); p < paths.size(); ++p) {
    const PathId path(p);
    segments_.push_back(count_segments(paths.words(path), layout));
    for_each_object(paths.words(path), layout, [&](ObjectId object) {
      if (object.index() >= of_object_.size()) of_object_.resize(object.index() + std::size_t{1});
      std::vector<PathId>& known = of_object_[object.index()];
      if (known.empty() || known.back() != path) known.push_back(path);
    });
  }
}

void PathIndex::clear() {
  of_object_.clear();
  segments_.clear();
}

std::span<const PathId> PathIndex::paths_of(ObjectId object) const {
  if (object.index() >= of_object_.size()) return {};
  return of_object_[object.index()];
}

std::size_t PathIndex::bytes() const {
  std::size_t sum = segments_.capacity() * sizeof(std::uint32_t) + of_object_.capacity() * sizeof(of_object_[0]);
  for (const auto& paths : of_object_) sum += paths.capacity() * sizeof(PathId);
  return sum;
}

}  // namespace relook
