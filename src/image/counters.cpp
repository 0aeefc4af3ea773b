#include "image/counters.h"

namespace relook {

Moves& Moves::operator+=(const Moves& other) {
  ray_trees += other.ray_trees;
  sample_colors += other.sample_colors;
  light_sums += other.light_sums;
  color_trees += other.color_trees;
  tunnels += other.tunnels;
  bytes += other.bytes;
  return *this;
}

Moves rebuilt_trees(const GrowCounters& counters) {
  Moves rebuilt;
  rebuilt.ray_trees = counters.trees_rebuilt;
  rebuilt.bytes = counters.hits_rebuilt * sizeof(Hit);
  return rebuilt;
}

Counters& Counters::operator+=(const Counters& other) {
  samples_total += other.samples_total;
  samples_affected += other.samples_affected;
  pixels_changed += other.pixels_changed;
  by_groups += other.by_groups;
  by_tunnels += other.by_tunnels;
  ray_tests += other.ray_tests;
  ray_tests_culled += other.ray_tests_culled;
  culled += other.culled;
  ray_updates += other.ray_updates;
  shadow_updates += other.shadow_updates;
  object_rays += other.object_rays;
  color_trees_evaluated += other.color_trees_evaluated;
  color_trees_reused += other.color_trees_reused;
  tunnels_read += other.tunnels_read;
  evicted += other.evicted;
  rebuilt += other.rebuilt;
  reloaded += other.reloaded;
  return *this;
}

}  // namespace relook
