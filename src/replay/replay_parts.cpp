#include "replay/replay_parts.h"

#include <utility>

namespace relook {
namespace {

std::unique_ptr<Residency> with_tracking(std::unique_ptr<Residency> pieces, bool may_miss_pieces) {
  if (!pieces) pieces = std::make_unique<Residency>(ResidencyOptions());
  if (may_miss_pieces) pieces->track();
  return pieces;
}

std::vector<ObjectId> atoms_at(const SceneState& state, std::uint32_t depth) {
  return depth > 0 ? atoms_of(state, depth) : std::vector<ObjectId>();
}

}  // namespace

ReplayParts::ReplayParts(SceneState start, Image image, const RegionOptions& options, std::unique_ptr<Residency> pieces,
                         std::shared_ptr<StoredTunnels> tunnels)
    : state(std::move(start)),
      rays(state.scene()),
      owned_residency(with_tracking(std::move(pieces), options.ray_trees < 1 || tunnels)),
      stored(std::move(image), state.scene().light_order, atoms_at(state, options.atoms), options, residency),
      objects(rays, monitor()),
      color_trees(stored.image().trees.size(),
                  static_cast<std::uint64_t>(static_cast<double>(stored.samples()) * options.color_trees)) {
  residency.set_others([this] { return color_trees.bytes(); },
                       [this](std::vector<Victim>& victims) {
                         color_trees.list_victims(residency.policy(), residency.change(), victims);
                       });
  stored.forget_hits(options.ray_trees);
  if (tunnels && options.has_tunnels_of(tunnels->shape())) stored.offer_tunnels(std::move(tunnels));
}

MemoryMonitor ReplayParts::monitor() {
  if (!residency.is_limited()) return {};
  return [this](std::int64_t bytes) { residency.claim(bytes); };
}

std::vector<ObjectId> ReplayParts::atoms() const { return atoms_at(state, stored.regions().options().atoms); }

const Tracer::TopLevel& ReplayParts::current_level(std::span<const ObjectId> absent) {
  if (!level) level = std::make_unique<SceneLevel>(image().view.shadow_bits > 0, monitor());
  return level->current(rays, absent);
}

}  // namespace relook
