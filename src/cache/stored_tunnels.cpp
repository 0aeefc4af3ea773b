#include "cache/stored_tunnels.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "cache/cache_parts.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "cache/tunnel_parts.h"

namespace relook {

PathBounds bounds_of(const PathTable& paths) {
  PathBounds bounds{paths.size(), 0};
  const std::span<const std::uint64_t> offsets = paths.all_offsets();
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i)
    bounds.most_words = std::max<std::size_t>(bounds.most_words, offsets[i + 1] - offsets[i]);
  return bounds;
}

StoredTunnels::StoredTunnels(std::filesystem::path path, std::shared_ptr<const Manifest> manifest,
                             const PathBounds& paths)
    : path_(std::move(path)),
      manifest_(std::move(manifest)),
      paths_(paths),
      groups_(cache_group_count(manifest_->camera, manifest_->view.samples)) {}
StoredTunnels::~StoredTunnels() = default;

std::shared_ptr<StoredTunnels> StoredTunnels::of_cache(const std::filesystem::path& path,
                                                       std::shared_ptr<const Manifest> manifest,
                                                       const PathTable& paths) {
  if (!has_tunnels(manifest->storage, manifest->camera)) return nullptr;
  return std::make_shared<StoredTunnels>(path, std::move(manifest), bounds_of(paths));
}

const StorageOptions& StoredTunnels::shape() const { return manifest_->storage; }

void StoredTunnels::note_fault(Group& group, const CacheAnswer& answer) {
  if (answer.fault == CacheFault::unreadable) throw IoError((path_ / answer.file).string(), answer.detail);
  const std::lock_guard lock(mutex_);
  if (std::exchange(group.is_faulty, true)) return;
  faults_.push_back(answer);
}

void StoredTunnels::open(std::size_t number, Group& group) {
  const PartFile part{Part::tunnels, number};
  group.file = stem(part);
  try {
    const CacheFile& file = find_file(*manifest_, part);
    group.file = file.name;
    auto reader =
        std::make_unique<TunnelReader>(ByteSource(path_ / file.name, file.bytes), manifest_->identity,
                                       manifest_->storage, manifest_->camera, manifest_->view.samples, number, paths_);
    check_sound(reader->bound_to() == hashes_bound_to(*manifest_, number), kOfOtherTrees);
    group.reader = std::move(reader);
  } catch (const CacheDamage& damage) {
    note_fault(group, {damage.fault, group.file, damage.what()});
  }
}

StoredTunnels::Group& StoredTunnels::group_of(std::size_t tile) {
  const std::size_t number = cache_group_of(manifest_->view.samples, tile);
  Group& group = groups_[number];
  std::call_once(group.is_opened, [&] { open(number, group); });
  return group;
}

std::optional<Sections> StoredTunnels::around(std::size_t tile) {
  const Group& group = group_of(tile);
  if (!group.reader) return std::nullopt;
  return group.reader->around(tile);
}

std::optional<std::uint64_t> StoredTunnels::bytes(std::size_t tile) {
  const Group& group = group_of(tile);
  if (!group.reader || !group.reader->has(tile)) return std::nullopt;
  try {
    return group.reader->raw_bytes(tile);
  } catch (const CacheDamage&) {
    return 0;  // said when it is read
  }
}

std::optional<TileTunnels> StoredTunnels::read(std::size_t tile) {
  Group& group = group_of(tile);
  if (!group.reader || !group.reader->has(tile)) return std::nullopt;
  try {
    return group.reader->tunnels(tile);
  } catch (const CacheDamage& damage) {
    note_fault(group, {damage.fault, group.file, damage.what()});
    return std::nullopt;
  }
}

std::vector<CacheAnswer> StoredTunnels::take_faults() {
  const std::lock_guard lock(mutex_);
  return std::exchange(faults_, {});
}

}  // namespace relook
