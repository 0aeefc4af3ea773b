// Sums that lights share, under `path`: every edit of a member and of who is one gives the pixels, sums and ray trees of
// a fresh preprocess of the edited document, bit for bit.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "matrix_rows.h"
#include "path_checks.h"
#include "run_program.h"
#include "scene/light_sums.h"

namespace relook {
namespace {

std::string lamp_name(int i) { return std::string(i < 10 ? "L0" : "L") + std::to_string(i); }
std::string sum_at(int i) { return "/lights/" + lamp_name(i) + "/extras/relook/sum"; }
std::string shown(int i) { return "/nodes/" + lamp_name(i) + "/extensions/KHR_node_visibility/visible"; }

/// On a spiral above the floor.
Json place_of_lamp(int i, double height) {
  const double turn = 2.4 * i, out = 0.7 + 0.06 * i;
  return {out * std::cos(turn), height + 0.02 * i, out * std::sin(turn)};
}

/// Twenty lamps, of which the import has the last four share "others": L16 and L17 points, L18 a soft spot, L19 a
/// rectangle that the camera sees. A floor, a ball, a mirror, a pane.
SceneState twenty_lamps(std::uint32_t width, std::uint32_t height) {
  SceneBuilder scene;
  const Json dull = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.6}}}};
  Json pane = dull;
  pane["doubleSided"] = true;
  pane["pbrMetallicRoughness"]["baseColorFactor"] = {0.9, 0.6, 0.4, 1};
  pane["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  const int matte = scene.material("Matte", dull);
  const int mirror = scene.material("Mirror", {{"pbrMetallicRoughness", {{"roughnessFactor", 0.1}}}});
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(4, 2), matte)}});
  scene.node("Ball", {{"mesh", scene.mesh("Ball", sphere_mesh(0.5F, 12, 8), matte)}, {"translation", {0.5, 0.5, 0.4}}});
  scene.node("MirrorBall", {{"mesh", scene.mesh("MirrorBall", sphere_mesh(0.5F, 12, 8), mirror)},
                            {"translation", {-0.8, 0.5, -0.3}}});
  scene.node("Pane", {{"mesh", scene.mesh("Pane", plane_mesh(0.8F, 1), scene.material("Pane", pane))},
                      {"translation", {0.6, 1.4, -0.2}}});
  for (int i = 0; i < 19; ++i) {
    Json light = {{"type", i == 18 ? "spot" : "point"}, {"intensity", 3}, {"color", {1, 0.5 + 0.02 * i, 0.8}}};
    if (i == 18) light["extras"] = {{"relook", {{"radius", 0.2}}}};
    scene.light(lamp_name(i), light, {{"translation", place_of_lamp(i, 2.4)}, {"rotation", {-0.7, 0, 0, 0.71}}});
  }
  scene.area_light("L19", {{"type", "rect"}, {"intensity", 4}, {"size", 0.6}},
                   {{"translation", {0.2, 1.7, -1}}, {"rotation", {-0.3, 0, 0, 0.95}},
                    {"extras", {{"relook", {{"visible", true}}}}}});
  scene.look_at(Point(0.2F, 1.6F, 4.2F), Point(0, 0.5F, 0), 44, width, height);
  return with_integrator(scene.state(), Integrator::path);
}

std::vector<std::string> sum_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const LightSum& sum : light_sums(scene)) names.push_back(sum.name);
  return names;
}

std::vector<MatrixRow> member_rows() {
  std::vector<MatrixRow> rows;
  for (const int i : {16, 18, 19}) {
    const std::string name = lamp_name(i), light = "/lights/" + name, node = "/nodes/" + name;
    rows.push_back(row(name + ": colour", set(light + "/color", {0.2, 1, 0.4})));
    rows.push_back(row(name + ": intensity", set(light + "/intensity", 7.5)));
    rows.push_back(row(name + ": temperature", set(light + "/extras/relook/temperature", 3200)));
    rows.push_back(row(name + ": black", set(light + "/intensity", 0)));
    rows.push_back(row(name + ": not black", set(light + "/intensity", 5)));
    rows.push_back(row(name + ": place", set(node + "/translation", place_of_lamp(i + 5, 1.9))));
    rows.push_back(row(name + ": place and colour", set(node + "/translation", place_of_lamp(i + 7, 1.8)),
                       set(light + "/color", {1, 0.4, 0.3})));
    rows.push_back(row(name + ": rate", set(light + "/extras/relook/rate", 0.25)));
    rows.push_back(row(name + ": excludes", set(node + "/extras/relook/excludes", Json::array({"Ball"}))));
    rows.push_back(row(name + ": excludes none", removed(node + "/extras/relook/excludes")));
    rows.push_back(row(name + ": hidden", set(shown(i), false)));
    rows.push_back(row(name + ": shown", set(shown(i), true)));
  }
  rows.push_back(row("range", add("/lights/L17/range", 3.5)));
  rows.push_back(row("cone", set("/lights/L18/spot/outerConeAngle", 0.5)));
  rows.push_back(row("radius", set("/lights/L18/extras/relook/radius", 0)));
  rows.push_back(row("size", set("/lights/L19/size", 0.9)));
  rows.push_back(row("unseen", set("/nodes/L19/extras/relook/visible", false)));
  return rows;
}

std::vector<MatrixRow> membership_rows() {
  return {
      row("one more", set(sum_at(3), "others")),
      row("its colour", set("/lights/L03/color", {0.1, 0.4, 1})),
      row("one of its own", set(sum_at(17), "")),
      row("its colour, no sample", set("/lights/L17/color", {1, 0.2, 0.2})),
      row("its sum is left out, which is the same", removed(sum_at(17))),
      row("another sum", set(sum_at(18), "a.set")),
      row("two come to it", set(sum_at(0), "a.set"), set(sum_at(16), "a.set")),
      row("one goes from each to the other", set(sum_at(3), "a.set"), set(sum_at(18), "others")),
      row("one goes and is another colour", set(sum_at(0), "others"), set("/lights/L00/color", {0.3, 1, 0.3})),
      row("one goes and moves", set(sum_at(0), ""), set("/nodes/L00/translation", {0.3, 1.8, 1.4})),
      row("one goes as an object moves", set(sum_at(0), "others"), set("/nodes/Ball/translation", {0.3, 0.6, 0.6})),
      row("one goes as a surface changes", set(sum_at(16), "others"),
          set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.4, 0.6, 0.9, 1})),
      row("a surface and a colour", set("/materials/Matte/pbrMetallicRoughness/baseColorFactor", {0.7, 0.6, 0.5, 1}),
          set("/lights/L16/color", {0.9, 0.2, 0.8})),
      row("a member is renamed", Json{{"op", "move"}, {"from", "/nodes/L16"}, {"path", "/nodes/Aa"}}),
      row("a member more", add("/nodes/Zz", {{"translation", {-1, 2, 1}},
                                             {"extensions", {{"KHR_lights_punctual", {{"light", "L16"}}}}}})),
      row("and the colour of both", set("/lights/L16/color", {0.5, 0.5, 1})),
      row("a member deleted", removed("/nodes/Aa")),
      row("one sum is gone", set(sum_at(3), "")),
      row("all lamps in one", set(sum_at(1), "others"), set(sum_at(2), "others"), set(sum_at(3), "others"),
          set(sum_at(17), "others")),
      row("the last member hidden, of a sum of its name", set(sum_at(2), "alone")),
      row("hidden", set(shown(2), false)),
      row("shown", set(shown(2), true)),
  };
}

TEST(SharedSums, edits_of_members_give_the_sums_of_a_fresh_preprocess) {
  for (const std::uint32_t samples : {1U, 4U})
    expect_full_renders(twenty_lamps(24, 18), path_view(samples), member_rows(), std::nullopt);
}

TEST(SharedSums, edits_of_who_is_a_member_give_the_sums_of_a_fresh_preprocess) {
  expect_full_renders(twenty_lamps(68, 18), path_view(1), membership_rows(), std::nullopt);
}

TEST(SharedSums, stand_between_the_lights_and_the_sky_by_their_names) {
  Replayer replayer = path_replayer(twenty_lamps(8, 6), path_view(1));
  std::vector<std::string> names = sum_names(replayer.state().scene());
  EXPECT_EQ(names.size(), 16U + 1 + 2 + 3);  // alone; "others"; sky and suns; ambient, background, unlit
  EXPECT_EQ(names[15], "light_L15");
  EXPECT_EQ(names[16], "lights_others");
  EXPECT_EQ(names[17], "sky");
  expect_path_step(replayer, edit_of(row("", set(sum_at(5), "a.set")).operations), "one goes");
  names = sum_names(replayer.state().scene());
  EXPECT_EQ(names[15], "lights_a_set");
  EXPECT_EQ(names[16], "lights_others");
  for (const LightSum& sum : light_sums(replayer.state().scene()))
    if (sum.kind == LightSum::Kind::shared) { EXPECT_EQ(sum.color, (std::array<double, 3>{1, 1, 1})) << sum.name; }
}

// Colours and intensities are powers of two, so that terms times them are exact: the sum of both is 4 S_a + 2 S_b but
// for the last bit of the grid.
TEST(SharedSums, of_two_lamps_are_both_lamps_with_their_colours) {
  SceneBuilder scene;
  const int matte = scene.material("Matte", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  scene.node("Ground", {{"mesh", scene.mesh("Ground", plane_mesh(4, 2), matte)}});
  scene.light("A", {{"type", "point"}, {"intensity", 4}}, {{"translation", {1, 2, 0}}});
  scene.light("B", {{"type", "point"}, {"intensity", 8}, {"color", {0.25, 0.5, 1}}}, {{"translation", {-1, 1.5, 0.5}}});
  scene.look_at(Point(0, 1.6F, 4.2F), Point(0, 0.5F, 0), 44, 12, 8);
  SceneState apart = with_integrator(scene.state(), Integrator::path);
  const Image alone = preprocessed(apart.scene(), path_view(2));
  (void)apply_edit(apart, edit_of(row("", set("/lights/A/extras/relook/sum", "both"),
                                      set("/lights/B/extras/relook/sum", "both")).operations), "sums", ".");
  const Image both = preprocessed(apart.scene(), path_view(2));
  const PackedSums &two = alone.light_sums[0], &one = both.light_sums[0];
  ASSERT_EQ(one.sums() + 1, two.sums());
  for (std::size_t pixel = 0; pixel < one.pixels(); ++pixel)
    for (std::size_t c = 0; c < 3; ++c) {
      const double a = 4 * two.value(0, pixel)[c], b = std::array<double, 3>{2, 4, 8}[c] * two.value(1, pixel)[c];
      EXPECT_NEAR(one.value(0, pixel)[c], a + b, 1e-15 * (a + b)) << pixel;
    }
}

TEST(SharedSums, a_members_colour_shoots_no_rays_and_looks_at_what_it_lights) {
  SceneState state = twenty_lamps(28, 21);
  // Below the floor: its light reaches little of what is seen.
  (void)apply_edit(state, edit_of(row("", set("/nodes/L16/translation", {-1.9, -0.5, 0})).operations), "place", ".");
  Replayer replayer = path_replayer(state, path_view(2));
  const auto affected = [&](const char* light) {
    const MatrixRow edit = row(light, set(std::string("/lights/") + light + "/intensity", 6.5));
    const StepResult step = expect_path_step(replayer, edit_of(edit.operations), edit.name);
    EXPECT_EQ(step.counters.ray_updates + step.counters.shadow_updates, 0U) << light;
    EXPECT_EQ(step.classification.change, ChangeClass::color) << light;
    return step.counters.samples_affected;
  };
  EXPECT_EQ(affected("L05"), 0U);
  const std::uint64_t of_lit = affected("L17"), of_dark = affected("L16");
  EXPECT_GT(of_lit, 0U);
  EXPECT_LT(of_dark, of_lit);
}

TEST(SharedSums, are_read_from_a_cache) {
  const ScratchFolder folder("cache");
  Replayer replayer = path_replayer(twenty_lamps(68, 12), path_view(2), {}, {}, folder / "c");
  for (const MatrixRow& edit : {row("colour", set("/lights/L18/color", {0.2, 1, 0.4})),
                                row("another sum", set(sum_at(16), "set"))})
    expect_path_step(replayer, edit_of(edit.operations), edit.name);
}

TEST(SharedSums, have_names_that_are_texts) {
  Replayer replayer = path_replayer(twenty_lamps(8, 6), path_view(1));
  const Json look = replayer.state().document().look;
  const std::vector<PackedSums> sums = replayer.image().light_sums;
  for (const Json& wrong : {Json(3), Json(), Json::array({"others"})}) {
    try {
      static_cast<void>(replayer.step(
          edit_of(row("", set("/lights/L16/color", {1, 0, 0}), set(sum_at(16), wrong)).operations), "j.json", "."));
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("expected a string"), std::string::npos) << error.what();
    }
    EXPECT_EQ(replayer.state().document().look, look);
    EXPECT_EQ(replayer.image().light_sums, sums);
  }
}

}  // namespace
}  // namespace relook
