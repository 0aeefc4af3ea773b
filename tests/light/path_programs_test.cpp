// Programs of the path integrator: a vertex looks its textures up once, however many lights reach it. That the pieces
// together say what a surface does with light is for path_reference_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "color/path/path_programs.h"
#include "test_scenes.h"

namespace relook {
namespace {

/// Calls check(material, key) for the sides of all materials of a scene, and for vertices that blur what goes through.
template <class Check>
void for_each_side(const Scene& scene, const Check& check) {
  for (std::uint32_t index = 0; index < scene.materials.size(); ++index)
    for (const bool inside : {false, true})
      for (const bool blurs : {false, true}) {
        PathKey key;
        key.material = MaterialId(index);
        key.inside = inside;
        key.blurs = blurs;
        SCOPED_TRACE(index);
        check(key);
      }
}

/// How often a kernel asks for the values of each slot.
std::map<Slot, int> lookups(const Kernel& kernel, Op op) {
  std::map<Slot, int> count;
  for (const Kernel::Step& step : kernel.varying)
    if (step.op == op) ++count[step.payload.slot()];
  return count;
}

std::size_t columns_read(const Kernel& kernel) {
  std::size_t count = 0;
  for (const Kernel::Step& step : kernel.varying)
    if (step.op == Op::column) count = std::max(count, step.payload.number() + std::size_t{1});
  return count;
}

TEST(PathPrograms, a_lit_vertex_looks_up_each_texture_once_for_all_lights) {
  std::size_t textured = 0;
  for (const TestScene which : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const SceneState state = test_scene(which, 8, 8);
    PathPrograms programs;
    for_each_side(state.scene(), [&](PathKey key) {
      key.lit = true;
      const Kernel& surface = programs.get(state.scene(), key).program->kernel;
      PathKey of_light = key;
      of_light.piece = PathPiece::light;
      of_light.lit = false;
      of_light.children = {};
      const Kernel& light = programs.get(state.scene(), of_light).program->kernel;
      for (const Op op : {Op::texture, Op::procedural_weight, Op::coordinates, Op::tangent_frame}) {
        EXPECT_TRUE(lookups(light, op).empty());
        for (const auto& [slot, times] : lookups(surface, op)) {
          EXPECT_EQ(times, 1) << "slot " << static_cast<int>(slot);
          ++textured;
        }
      }
    });
  }
  EXPECT_GT(textured, 0U);
}

TEST(PathPrograms, all_surfaces_of_a_side_yield_the_columns_that_lights_read) {
  for (const TestScene which : {TestScene::spheres, TestScene::cards, TestScene::study}) {
    const SceneState state = test_scene(which, 8, 8);
    PathPrograms programs;
    for_each_side(state.scene(), [&](const PathKey& side) {
      PathKey of_light = side;
      of_light.piece = PathPiece::light;
      const std::size_t read = columns_read(programs.get(state.scene(), of_light).program->kernel);
      for (const bool gathers : {false, true})
        for (const Branch child : {Branch::transparency, Branch::reflection, Branch::diffuse}) {
          PathKey key = side;
          key.gathers = gathers;
          const bool is_unlit = state.scene().material(key.material).model == IlluminationModel::unlit;
          if (!is_unlit || child == Branch::transparency) key.children.add(child);
          const std::size_t without = programs.get(state.scene(), key).program->kernel.outputs.size();
          EXPECT_EQ(without, 3 * (key.children.size() + 4));
          key.lit = true;
          EXPECT_EQ(programs.get(state.scene(), key).program->kernel.outputs.size(), without + read);
        }
    });
  }
}

}  // namespace
}  // namespace relook
