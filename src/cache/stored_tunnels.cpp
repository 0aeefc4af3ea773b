#include "cache/stored_tunnels.h"

#include <utility>

#include "cache/cache_parts.h"
#include "cache/image_parts.h"
#include "cache/manifest.h"
#include "cache/tunnel_parts.h"

namespace relook {

StoredTunnels::StoredTunnels(std::filesystem::path path, Manifest manifest, std::size_t path_count)
    : path_(std::move(path)),
      manifest_(std::make_unique<Manifest>(std::move(manifest))),
      path_count_(path_count),
      groups_(cache_group_count(manifest_->camera, manifest_->samples)) {}
StoredTunnels::~StoredTunnels() = default;

std::shared_ptr<StoredTunnels> StoredTunnels::of_cache(const std::filesystem::path& path, std::size_t path_count) {
  try {
    Manifest manifest = load_manifest(path);
    if (!has_tunnels(manifest.storage, manifest.camera)) return nullptr;
    return std::make_shared<StoredTunnels>(path, std::move(manifest), path_count);
  } catch (const CacheDamage&) {
    return nullptr;  // it was read a moment ago
  }
}

const StorageOptions& StoredTunnels::shape() const { return manifest_->storage; }

void StoredTunnels::note_fault(Group& group, const CacheAnswer& answer) {
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
                                       manifest_->storage, manifest_->camera, manifest_->samples, number);
    check_sound(reader->bound_to() == hashes_bound_to(*manifest_, number), kOfOtherTrees);
    group.reader = std::move(reader);
  } catch (const CacheDamage& damage) {
    note_fault(group, {damage.fault, group.file, damage.what()});
  }
}

StoredTunnels::Group& StoredTunnels::group_of(std::size_t tile) {
  const std::size_t number = cache_group_of(manifest_->samples, tile);
  Group& group = groups_[number];
  std::call_once(group.is_opened, [&] { open(number, group); });
  return group;
}

std::optional<Sections> StoredTunnels::around(std::size_t tile) {
  const Group& group = group_of(tile);
  if (!group.reader) return std::nullopt;
  return group.reader->around(tile);
}

std::uint64_t StoredTunnels::bytes(std::size_t tile) {
  const Group& group = group_of(tile);
  try {
    return group.reader && group.reader->has(tile) ? group.reader->raw_bytes(tile) : 0;
  } catch (const CacheDamage&) {
    return 1;  // said when it is read
  }
}

std::optional<TileTunnels> StoredTunnels::read(std::size_t tile) {
  Group& group = group_of(tile);
  if (!group.reader || !group.reader->has(tile)) return std::nullopt;
  try {
    return group.reader->tunnels(tile, path_count_);
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
