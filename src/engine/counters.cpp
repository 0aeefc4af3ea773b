#include "engine/counters.h"

namespace relook {

Counters& Counters::operator+=(const Counters& other) {
  samples_total += other.samples_total;
  samples_affected += other.samples_affected;
  pixels_changed += other.pixels_changed;
  regions_visited += other.regions_visited;
  regions_culled += other.regions_culled;
  ray_tests += other.ray_tests;
  ray_tests_culled += other.ray_tests_culled;
  ray_updates += other.ray_updates;
  shadow_updates += other.shadow_updates;
  object_rays += other.object_rays;
  color_trees_evaluated += other.color_trees_evaluated;
  return *this;
}

}  // namespace relook
