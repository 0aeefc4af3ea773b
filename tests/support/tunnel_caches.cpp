#include "tunnel_caches.h"

#include <gtest/gtest.h>

#include "image/path_classes.h"

namespace relook {

CacheContent content_with_tunnels(const SceneState& state, const ViewOptions& view, const RegionOptions& regions) {
  TunnelRecord tunnels;
  tunnels.shape = regions.shape();
  if (regions.atoms > 0) tunnels.atoms = atoms_of(state, regions.atoms);
  RenderStats stats;
  Image image = preprocess(state.scene(), view, stats, {}, &tunnels);
  CacheContent content = cache_content(state, std::move(image), std::string(32, 'a'), std::move(tunnels));
  content.storage.atoms = regions.atoms;
  return content;
}

OpenedCache opened_cache(const std::filesystem::path& path) {
  OpenedCache opened;
  const CacheAnswer answer = open_cache(path, true, opened);
  EXPECT_EQ(answer.fault, CacheFault::none) << answer.file << ": " << answer.detail;
  return opened;
}

Replayer replayer_of_cache(const SceneState& state, const ViewOptions& view, const RegionOptions& regions,
                           const std::filesystem::path& path, const ResidencyOptions& residency) {
  write_cache(path, content_with_tunnels(state, view, regions));
  OpenedCache opened = opened_cache(path);
  return Replayer(std::move(*opened.state), std::move(opened.image), regions, std::make_unique<Residency>(residency),
                  std::move(opened.tunnels));
}

}  // namespace relook
