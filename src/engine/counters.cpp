#include "engine/counters.h"

namespace relook {

Counters& Counters::operator+=(const Counters& other) {
  samples_total += other.samples_total;
  samples_affected += other.samples_affected;
  pixels_changed += other.pixels_changed;
  by_groups += other.by_groups;
  by_tunnels += other.by_tunnels;
  ray_tests += other.ray_tests;
  ray_tests_culled += other.ray_tests_culled;
  culled_by_tunnels += other.culled_by_tunnels;
  ray_updates += other.ray_updates;
  shadow_updates += other.shadow_updates;
  object_rays += other.object_rays;
  color_trees_evaluated += other.color_trees_evaluated;
  ray_trees_rebuilt += other.ray_trees_rebuilt;
  return *this;
}

}  // namespace relook
