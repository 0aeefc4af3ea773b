// Groups, tunnels, atoms and shadow counters decide what is looked at, never what is found.
#include <gtest/gtest.h>

#include <ostream>

#include "matrix_rows.h"
#include "region_checks.h"
#include "run_program.h"
#include "tunnel_caches.h"

namespace relook {
namespace {

/// Groups, tunnels, atoms and shadow counters decide what is looked at, never what is found.
struct StructureCase {
  RegionOptions regions;
  std::uint32_t shadow_bits;
};

std::vector<StructureCase> every_combination() {
  std::vector<StructureCase> cases;
  for (const std::size_t groups : {0U, 1U, 4U})
    for (const std::size_t tunnels : {0U, 1U, 2U})
      for (const std::uint32_t atoms : {0U, 1U})
        for (const std::uint32_t shadow_bits : {0U, 1U, 2U, 3U, 4U})
          cases.push_back({{.groups = groups, .tunnels = tunnels, .atoms = atoms}, shadow_bits});
  return cases;
}

std::vector<MatrixRow> structure_rows() {
  return {
      row("colour", set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.2, 0.7, 0.3, 1})),
      row("index of refraction", set("/materials/Glass/extensions/KHR_materials_ior/ior", 1.8)),
      row("let light through", set("/materials/Matte/extensions/KHR_materials_transmission/transmissionFactor", 0.5)),
      row("part colours", set("/materials/Matte/extensions/KHR_materials_volume/thicknessFactor", 1),
          set("/materials/Matte/extensions/KHR_materials_dispersion/dispersion", 5)),
      row("move", set("/nodes/Ball/translation", {0.4, 0.9, 0.3})),
      row("move two", set("/nodes/MirrorBall/translation", {-1.2, 1.1, 0.2}),
          set("/nodes/GlassBall/scale", {0.8, 0.8, 0.8})),
      row("hide", set("/nodes/Ball/extensions/KHR_node_visibility/visible", false)),
      row("block light again", set("/materials/Matte/extensions/KHR_materials_transmission/transmissionFactor", 0)),
      row("show", set("/nodes/Ball/extensions/KHR_node_visibility/visible", true)),
      row("move a light", set("/nodes/Lamp/translation", {1.5, 4.2, 2.5})),
  };
}

void PrintTo(const StructureCase& c, std::ostream* out) {
  *out << c.regions.groups << " groups, " << c.regions.tunnels << " tunnels, " << c.regions.atoms << " atoms, "
       << c.shadow_bits << " shadow bits";
}

std::string structures_name(const testing::TestParamInfo<StructureCase>& info) {
  const auto& [regions, shadow_bits] = info.param;
  return "groups_" + std::to_string(regions.groups) + "_tunnels_" + std::to_string(regions.tunnels) + "_atoms_" +
         std::to_string(regions.atoms) + "_shadow_bits_" + std::to_string(shadow_bits);
}

class Structures : public testing::TestWithParam<StructureCase> {};

TEST_P(Structures, NoCombinationChangesAFrame) {
  const auto [regions, shadow_bits] = GetParam();
  const ScratchFolder folder("structures");
  Replayer replayer =
      replayer_of_cache(test_scene(TestScene::study, 40, 30), {1, 5, shadow_bits}, regions, folder / "c");
  for (const MatrixRow& row : structure_rows()) {
    SCOPED_TRACE(row.name);
    replayer.step(edit_of(row.operations), "structures", ".");
    expect_fresh_image(replayer);
    EXPECT_EQ(stale_tiles(replayer), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Structures, testing::ValuesIn(every_combination()), structures_name);

}  // namespace
}  // namespace relook
