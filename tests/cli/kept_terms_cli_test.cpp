// A colour is edited twice under --integrator path, through the program: the second time from terms that the first edit
// has kept, whatever lets light through and however lights are summed, and every frame is the full render.
#include "cli_fixture.h"

namespace relook {
namespace {

class KeptTermsCli : public Cli {
 protected:
  static Json color_of(const char* material, Json value) {
    return {{"name", material},
            {"edit",
             {{{"op", "replace"},
               {"path", std::string("/materials/") + material + "/pbrMetallicRoughness/baseColorFactor"},
               {"value", std::move(value)}}}}};
  }
  /// The spheres, with a leaf of half coverage in the place of the pane, under `lamps` lights. Returns its path.
  [[nodiscard]] std::string write_scene(int lamps) const {
    const std::filesystem::path source = std::filesystem::path(kScene).parent_path();
    std::filesystem::copy(source, at("scene"), std::filesystem::copy_options::recursive);
    Json gltf = read_json(kScene);
    for (Json& material : gltf["materials"]) {
      if (material["name"] != "Veil") continue;
      material = {{"name", "Leaf"},
                  {"alphaMode", "BLEND"},
                  {"doubleSided", true},
                  {"pbrMetallicRoughness", {{"baseColorFactor", {0.3, 0.8, 0.4, 0.5}}, {"metallicFactor", 0}}}};
    }
    Json& lights = gltf["extensions"]["KHR_lights_punctual"]["lights"];
    for (int i = 1; i < lamps; ++i) {
      const std::string name = "Lamp" + std::to_string(i);
      lights.push_back({{"name", name}, {"type", "point"}, {"intensity", 10}, {"color", {1, 0.9, 0.04 * i}}});
      gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
      gltf["nodes"].push_back({{"name", name},
                               {"translation", {0.4 * i - 4, 3 + 0.1 * i, 2 - 0.2 * i}},
                               {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
    }
    const std::string file = at("scene/spheres.gltf");
    write_text(file, gltf.dump());
    return file;
  }
  /// The report of a replay of the journal.
  [[nodiscard]] Json replayed(const std::string& scene) const {
    const ProgramResult made = relook({"preprocess", scene, "-o", at("c"), "--resolution", "64x40", "--samples", "2",
                                       "--integrator", "path", "--quiet"});
    EXPECT_EQ(made.exit_code, 0) << made.output;
    const ProgramResult run = relook({"replay", at("c"), at("j.json"), "-o", at("run"), "--verify", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return run.exit_code == 0 ? read_json(at("run/report.json")) : Json::object();
  }
  /// Each material twice.
  void expect_second_edits_from_kept_terms(int lamps) {
    Json steps = Json::array();
    for (const char* material : {"Paint", "Glass", "Leaf"}) {
      steps.push_back(color_of(material, {0.2, 0.5, 0.9, 0.5}));
      steps.push_back(color_of(material, {0.9, 0.4, 0.1, 0.45}));
    }
    write_text(at("j.json"), Json{{"relook", "journal/1"}, {"steps", steps}}.dump());
    const Json report = replayed(write_scene(lamps));
    ASSERT_EQ(report["steps"].size(), 7U);
    EXPECT_EQ(report["steps"][0]["resident"]["kept_terms"], 0);
    for (std::size_t i = 1; i < 7; ++i) {
      const Json& step = report["steps"][i];
      SCOPED_TRACE("step " + std::to_string(i) + " " + step["name"].get<std::string>());
      EXPECT_EQ(step["verify"]["pixels_different"], 0);
      EXPECT_EQ(step["class"], "color");
      EXPECT_EQ(step["ray_updates"], 0);
      EXPECT_GT(step["samples_affected"], 0);
      EXPECT_GT(step["pixels_changed"], 0);
      EXPECT_GT(step["resident"]["kept_terms"], 0);
      const bool is_first = i % 2 == 1;
      EXPECT_EQ(step["color_trees_reused"], is_first ? Json(0) : step["color_trees_evaluated"]);
      if (is_first) continue;
      EXPECT_EQ(step["samples_affected"], report["steps"][i - 1]["samples_affected"]);
      EXPECT_EQ(step["resident"]["kept_terms"], report["steps"][i - 1]["resident"]["kept_terms"]);
    }
  }
};

TEST_F(KeptTermsCli, what_is_opaque_glass_or_a_leaf_is_edited_again_from_kept_terms) {
  expect_second_edits_from_kept_terms(1);
}

TEST_F(KeptTermsCli, of_chosen_parameters_are_there_before_the_first_edit) {
  write_text(at("j.json"), Json{{"relook", "journal/1"},
                                {"steps",
                                 {color_of("Paint", {0.2, 0.5, 0.9, 1}), color_of("Glass", {0.9, 0.4, 0.1, 1}),
                                  color_of("Mirror", {0.5, 0.4, 0.1, 1})}}}
                               .dump());
  ASSERT_EQ(
      relook({"preprocess", kScene, "-o", at("c"), "--resolution", "64x40", "--samples", "2", "--quiet"}).exit_code, 0);
  ASSERT_EQ(relook({"replay", at("c"), at("j.json"), "-o", at("r"), "--verify", "--quiet", "--params",
                    "/materials/Paint", "/materials/Glass/pbrMetallicRoughness"})
                .exit_code,
            0);
  const Json steps = read_json(at("r/report.json"))["steps"];
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(steps[i]["verify"]["pixels_different"], 0);
    EXPECT_GT(steps[i]["color_trees_evaluated"], 0) << i;
    EXPECT_EQ(steps[i]["color_trees_reused"], i < 3 ? steps[i]["color_trees_evaluated"] : Json(0)) << i;
  }
}

TEST_F(KeptTermsCli, so_it_is_where_lights_share_a_sum) { expect_second_edits_from_kept_terms(20); }

}  // namespace
}  // namespace relook
