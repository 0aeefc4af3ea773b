// Every edit of lights under `path`: what they give, whom, their shapes and places, the environment, what emits. After
// each row pixels, sums of light and ray trees are those of a fresh preprocess of the edited document, bit for bit.
#include <gtest/gtest.h>

#include "base/error.h"
#include "matrix_rows.h"
#include "path_checks.h"

namespace relook {
namespace {

const std::string kSky = "/scene/extras/relook/environment/";
const std::string kGlow = "/materials/Glow/";

std::string shown(const std::string& node) { return "/nodes/" + node + "/extensions/KHR_node_visibility/visible"; }
Json placed_light(const char* extension, const char* light, Json translation) {
  return {{"translation", std::move(translation)},
          {"rotation", {-0.5, 0, 0, 0.8660254}},
          {"extensions", {{extension, {{"light", light}}}}}};
}

std::vector<MatrixRow> gift_rows() {
  std::vector<MatrixRow> rows;
  for (const std::string name : {"Lamp", "Spot", "Sun", "Window", "Dish"}) {
    const std::string light = "/lights/" + name;
    rows.push_back(row(name + ": colour", set(light + "/color", {0.2, 1, 0.4})));
    rows.push_back(row(name + ": intensity", set(light + "/intensity", 7.5)));
    rows.push_back(row(name + ": temperature", set(light + "/extras/relook/temperature", 3200)));
    rows.push_back(row(name + ": black", set(light + "/intensity", 0)));
    rows.push_back(row(name + ": not black", set(light + "/intensity", 11), set(light + "/color", {1, 0.7, 0.5})));
    const std::string excludes = "/nodes/" + name + "/extras/relook/excludes";
    rows.push_back(row(name + ": excludes", set(excludes, Json::array({"Ball", "Pane"}))));
    rows.push_back(row(name + ": excludes another", set(excludes, Json::array({"Ground"}))));
    rows.push_back(row(name + ": excludes none", removed(excludes)));
  }
  rows.push_back(row("cone", set("/lights/Spot/spot/outerConeAngle", 0.4)));
  rows.push_back(row("inner cone", set("/lights/Spot/spot/innerConeAngle", 0.1)));
  rows.push_back(row("range of a point", add("/lights/Lamp/range", 5)));
  rows.push_back(row("range of a soft spot", add("/lights/Spot/range", 6)));
  rows.push_back(row("no range", removed("/lights/Lamp/range")));
  rows.push_back(row("excluded once more, by a light that moves",
                     set("/nodes/Lamp/extras/relook/excludes", Json::array({"Coated"})),
                     set("/nodes/Lamp/translation", {1.5, 3, 3})));
  rows.push_back(row("an excluded node moves", set("/nodes/Coated/translation", {0.6, 0.4, 1})));
  rows.push_back(row("ambient", set("/scene/extras/relook/ambient", {0.1, 0.05, 0.02})));
  return rows;
}

std::vector<MatrixRow> shape_rows() {
  std::vector<MatrixRow> rows;
  for (const std::string name : {"Lamp", "Spot"}) {
    const std::string radius = "/lights/" + name + "/extras/relook/radius";
    rows.push_back(row(name + ": radius", set(radius, 0.4)));
    rows.push_back(row(name + ": no radius", set(radius, 0)));
    rows.push_back(row(name + ": a radius again", set(radius, 0.15)));
    rows.push_back(row(name + ": seen", set("/nodes/" + name + "/extras/relook/visible", true)));
    rows.push_back(row(name + ": within view", set("/nodes/" + name + "/translation", {0.3, 1.2, 1.4})));
    rows.push_back(row(name + ": unseen", set("/nodes/" + name + "/extras/relook/visible", false)));
    rows.push_back(row(name + ": away", set("/nodes/" + name + "/translation", {1, 3.5, 2})));
  }
  const std::string angle = "/lights/Sun/extras/relook/angle";
  rows.push_back(row("angle", set(angle, 0.3)));
  rows.push_back(row("no angle", set(angle, 0)));
  rows.push_back(row("an angle again", set(angle, 0.02)));
  rows.push_back(row("a sun that turns", set("/nodes/Sun/rotation", {-0.5, 0.1, 0, 0.86})));
  rows.push_back(row("a sun that is seen", set("/nodes/Sun/extras/relook/visible", true)));
  rows.push_back(row("size of a rectangle", set("/lights/Window/size", 0.6)));
  rows.push_back(row("its aspect", set("/lights/Window/rect/aspect", 4)));
  rows.push_back(row("it moves", set("/nodes/Window/translation", {0.5, 1.4, 2.4})));
  rows.push_back(row("it turns", set("/nodes/Window/rotation", {-0.2, 0.3, 0, 0.93})));
  rows.push_back(row("it grows with its node", set("/nodes/Window/scale", {1, 2, 1})));
  rows.push_back(row("it is nothing", set("/nodes/Window/scale", {0, 0, 0})));
  rows.push_back(row("it is back", set("/nodes/Window/scale", {1, 1, 1})));
  rows.push_back(row("it is seen", set("/nodes/Window/extras/relook/visible", true)));
  rows.push_back(row("a disk instead", set("/lights/Window/type", "disk")));
  rows.push_back(row("a rectangle again", set("/lights/Window/type", "rect")));
  rows.push_back(row("size of a disk", set("/lights/Dish/size", 1.3)));
  rows.push_back(row("a disk within view", set("/nodes/Dish/translation", {-0.4, 1.3, -0.9})));
  rows.push_back(row("a disk that is unseen", set("/nodes/Dish/extras/relook/visible", false)));
  for (const std::string name : {"Lamp", "Spot", "Sun", "Window", "Dish"})
    rows.push_back(row(name + ": rate", set("/lights/" + name + "/extras/relook/rate", 0.5)));
  rows.push_back(row("a point becomes a spot", set("/lights/Lamp/type", "spot")));
  rows.push_back(row("and a sun", set("/lights/Lamp/type", "directional"), set("/lights/Lamp/intensity", 0.5)));
  return rows;
}

std::vector<MatrixRow> order_rows() {
  return {
      row("an area light more", add("/nodes/Another", placed_light("EXT_lights_area", "Window", {-1.2, 2.2, 2}))),
      row("another one, last", add("/nodes/Zenith", placed_light("EXT_lights_area", "Dish", {0, 2.5, 1}))),
      row("a lamp of its own", add("/lights/Bulb", {{"type", "point"}, {"intensity", 9}}),
          add("/nodes/Bulb", placed_light("KHR_lights_punctual", "Bulb", {-2, 2, 1.5}))),
      row("a light is renamed and comes first", Json{{"op", "move"}, {"from", "/nodes/Window"}, {"path", "/nodes/Aa"}}),
      row("and last", Json{{"op", "move"}, {"from", "/nodes/Aa"}, {"path", "/nodes/Zz"}}),
      row("its colour afterwards", set("/lights/Window/color", {1, 0.4, 0.7})),
      row("hidden", set(shown("Lamp"), false)),
      row("shown", set(shown("Lamp"), true)),
      row("an area hidden", set(shown("Zz"), false)),
      row("an area shown, another one hidden", set(shown("Zz"), true), set(shown("Dish"), false)),
      row("a light deleted", removed("/nodes/Another")),
      row("two deleted, one added", removed("/nodes/Zenith"), removed("/nodes/Lamp"),
          add("/nodes/Mid", placed_light("KHR_lights_punctual", "Lamp", {1, 3, 2}))),
      row("an object between light and floor", set("/nodes/Ball/translation", {0.4, 1.6, 1.1})),
      row("an object added there",
          add("/nodes/Twin", {{"mesh", "GlassBall"}, {"translation", {-0.5, 1.5, 1}}, {"scale", {0.5, 0.5, 0.5}}})),
      row("an object deleted", removed("/nodes/Twin")),
      row("a light and an object at once", set("/nodes/Mid/translation", {-1, 3, 2}),
          set("/nodes/Coated/translation", {0.2, 0.6, 1.4})),
      row("a light, its colour and a surface at once", set("/nodes/Zz/translation", {1, 2, 2}),
          set("/lights/Window/intensity", 20), set("/materials/Matte/pbrMetallicRoughness/roughnessFactor", 0.9),
          set(kSky + "intensity", 0.3)),
      row("a light moves while another one is renamed", set("/nodes/Mid/translation", {0, 3, 3}),
          Json{{"op", "move"}, {"from", "/nodes/Sun"}, {"path", "/nodes/Bright"}}),
      row("no lamp is left", removed("/nodes/Mid"), removed("/nodes/Spot"), removed("/nodes/Bulb"),
          removed("/nodes/Bright"), removed("/nodes/Zz")),
      row("one again", add("/nodes/Lamp", placed_light("KHR_lights_punctual", "Lamp", {2, 4, 3}))),
  };
}

std::vector<MatrixRow> sky_rows() {
  return {
      row("tint", set(kSky + "color", {1, 0.6, 0.4})),
      row("intensity", set(kSky + "intensity", 1.7)),
      row("rotation", set(kSky + "rotation", 2.1)),
      row("rotation and tint", set(kSky + "rotation", -0.7), set(kSky + "color", {0.8, 1, 1})),
      row("another image", set(kSky + "image", "SecondSkyImage")),
      row("an image without suns", set(kSky + "image", "EvenSkyImage")),
      row("turned without suns", set(kSky + "rotation", 1)),
      row("no image", removed(kSky + "image")),
      row("turned without an image", set(kSky + "rotation", 0.2)),
      row("an image again", add(kSky + "image", "SkyImage")),
      row("see it", set(kSky + "background", nullptr)),
      row("see it turned", set(kSky + "rotation", 1.1)),
      row("see its tint", set(kSky + "color", {0.5, 0.9, 1})),
      row("see another one", set(kSky + "image", "SecondSkyImage")),
      row("a background", set(kSky + "background", {{"color", {0.2, 0.1, 0.1}}})),
      row("its colour", set(kSky + "background/color", {0.1, 0.4, 0.1})),
      row("its image", set(kSky + "background", {{"image", "PictureImage"}, {"intensity", 0.5}})),
      row("its rotation", set(kSky + "background", {{"image", "PictureImage"}, {"rotation", 0.9}})),
      row("its other image", set(kSky + "background", {{"image", "SecondImage"}, {"rotation", 0.9}})),
      row("turned behind it", set(kSky + "rotation", 2.4)),
      row("no background, another image", set(kSky + "background", nullptr), set(kSky + "image", "SkyImage")),
      row("black", set(kSky + "intensity", 0)),
      row("and not", set(kSky + "intensity", 0.6)),
      row("an object that leaves the sky free", set("/nodes/MirrorBall/translation", {-2.5, 0.7, -1})),
  };
}

std::vector<MatrixRow> emission_rows() {
  const std::string strength = kGlow + "extensions/KHR_materials_emissive_strength/emissiveStrength";
  return {
      row("factor", set(kGlow + "emissiveFactor", {0.2, 0.9, 0.6})),
      row("strength", set(strength, 7)),
      row("no factor", set(kGlow + "emissiveFactor", {0, 0, 0})),
      row("a factor again", set(kGlow + "emissiveFactor", {1, 0.6, 0.5})),
      row("no strength", set(strength, 0)),
      row("a strength again", set(strength, 3)),
      row("another image", set(kGlow + "emissiveTexture", {{"index", "Second"}})),
      row("the texture's image", set("/textures/Second/source", "PictureImage")),
      row("the image of emission and ground", set("/textures/Picture/source", "SecondImage")),
      row("no image", removed(kGlow + "emissiveTexture")),
      row("an image again", add(kGlow + "emissiveTexture", {{"index", "Picture"}})),
      row("another place of the image",
          set(kGlow + "emissiveTexture/extensions/KHR_texture_transform", {{"offset", {0.3, 0.1}}, {"scale", {2, 2}}})),
      row("it moves", set("/nodes/Glow/translation", {0.2, 0.4, 1.9})),
      row("it grows", set("/nodes/Glow/scale", {1.5, 0.7, 1.2})),
      row("its surface", set(kGlow + "pbrMetallicRoughness/baseColorFactor", {0.6, 0.6, 0.2, 1})),
      row("its roughness", set(kGlow + "pbrMetallicRoughness/roughnessFactor", 0.1)),
      row("two of them", add("/nodes/Glow2", {{"mesh", "Glow"}, {"translation", {-1.2, 1.6, 0.9}}})),
      row("one of them", set("/nodes/Glow/extensions/KHR_node_visibility/visible", false)),
      row("none of them", removed("/nodes/Glow2")),
      row("it is back", set("/nodes/Glow/extensions/KHR_node_visibility/visible", true)),
      row("another one emits, before it", set("/materials/Cloth/emissiveFactor", {0.1, 0.2, 0.5})),
      row("a third one, moved at once", set("/materials/Veil/emissiveFactor", {0.5, 0.1, 0.1}),
          set("/nodes/Veil/translation", {-1.2, 0.6, 1.5})),
      row("glass that emits", set("/materials/Glass/emissiveFactor", {0.05, 0.2, 0.05})),
      row("seen from behind", set(kGlow + "doubleSided", true)),
      row("a mesh takes its material", set("/meshes/Phong/primitives/0/material", "Glow")),
      row("and the first one again", set("/meshes/Phong/primitives/0/material", "Phong")),
      row("unlit ends it", set(kGlow + "extras/relook/model", "unlit")),
      row("and begins it", set(kGlow + "extras/relook/model", "metallic-roughness")),
      row("the first one ends", set("/materials/Cloth/emissiveFactor", {0, 0, 0})),
  };
}

/// Terms are kept for the next edit of a colour: lights that come and go between such edits give sums other places.
std::vector<MatrixRow> between_colors_rows() {
  const auto ground = [](double red) {
    return row("colour of the ground", set("/materials/Ground/pbrMetallicRoughness/baseColorFactor", {red, 0.5, 0.2, 1}));
  };
  return {
      ground(0.1),
      ground(0.9),
      row("a lamp is gone", removed("/nodes/Lamp")),
      ground(0.3),
      row("three at once", set(shown("Window"), false), set(shown("Spot"), false), set(kGlow + "emissiveFactor", {0, 0, 0})),
      ground(0.8),
      row("a colour of another", set("/materials/Coated/pbrMetallicRoughness/baseColorFactor", {0.2, 0.2, 0.9, 1})),
      ground(0.2),
      row("the others", set(shown("Sun"), false), set(shown("Dish"), false)),
      ground(0.7),
      row("its light comes back", set(shown("Window"), true)),
      ground(0.4),
      row("with a colour", set(shown("Spot"), true),
          set("/materials/Ground/pbrMetallicRoughness/baseColorFactor", {0.6, 0.6, 0.6, 1})),
      ground(0.9),
      row("a light moves", set("/nodes/Window/translation", {0.5, 1.4, 2.4})),
      ground(0.5),
      row("it moves on", set("/nodes/Window/translation", {0.2, 1.6, 2.2})),
      row("an object moves", set("/nodes/Coated/translation", {0.6, 0.4, 1})),
      ground(0.1),
      row("it moves on, too", set("/nodes/Coated/translation", {0.5, 0.5, 0.8})),
      ground(0.6),
      row("a light moves once more", set("/nodes/Window/translation", {0.1, 1.8, 2.3})),
  };
}

/// Vertices are kept for the next light that moves: whatever comes between such edits.
std::vector<MatrixRow> between_moves_rows() {
  const auto window = [](double x) { return row("the window moves", set("/nodes/Window/translation", {x, 1.4, 2.4})); };
  const auto turned = [](double angle) { return row("the sky turns", set(kSky + "rotation", angle)); };
  return {
      window(0.5),
      window(0.4),
      window(0.3),
      turned(0.4),
      turned(0.8),
      row("another sky", set(kSky + "image", "SecondSkyImage")),
      row("a colour", set("/materials/Ground/pbrMetallicRoughness/baseColorFactor", {0.9, 0.5, 0.2, 1})),
      window(0.2),
      window(0.1),
      turned(1.2),
      row("a bucket of roughness", set("/materials/Coated/pbrMetallicRoughness/roughnessFactor", 0.9)),
      window(0),
      window(0.1),
      row("colour and light", set("/materials/Ground/pbrMetallicRoughness/baseColorFactor", {0.2, 0.5, 0.2, 1}),
          set("/nodes/Window/translation", {0.2, 1.4, 2.4})),
      window(0.3),
      window(0.4),
      row("an object moves", set("/nodes/Coated/translation", {0.6, 0.4, 1})),
      window(0.5),
      window(0.4),
      row("a light more", add("/nodes/Another", placed_light("EXT_lights_area", "Window", {-1.2, 2.2, 2}))),
      row("one more, first", add("/nodes/Aaa", placed_light("EXT_lights_area", "Dish", {0, 2.5, 1}))),
      row("the size of two", set("/lights/Window/size", 0.7)),
      row("who is lit", set("/nodes/Window/extras/relook/excludes", Json::array({"Ball", "Pane"}))),
      window(0.6),
      row("a lamp moves", set("/nodes/Lamp/translation", {1.2, 3, 2})),
      row("two lights and the sky", set("/nodes/Lamp/translation", {1, 3, 2}),
          set("/nodes/Dish/translation", {0, 2.4, 1}), set(kSky + "rotation", -0.3)),
      row("a light less", removed("/nodes/Another")),
      window(0.5),
      row("one less, one more", removed("/nodes/Aaa"),
          add("/nodes/Zzz", placed_light("EXT_lights_area", "Dish", {0.3, 2.5, 1}))),
      row("glass clearer", set("/materials/Glass/pbrMetallicRoughness/baseColorFactor", {0.5, 0.9, 0.9, 1})),
      window(0.4),
      turned(0.1),
  };
}

struct LightRows {
  const char* name;
  std::vector<MatrixRow> (*rows)();
  std::uint32_t samples;
};
void PrintTo(const LightRows& c, std::ostream* out) { *out << c.name << ", " << c.samples << " samples"; }

class LightEdits : public testing::TestWithParam<LightRows> {};

TEST_P(LightEdits, GiveTheSumsOfAFreshPreprocess) {
  const LightRows c = GetParam();
  const bool is_wide = c.samples == 1;  // of two tiles
  expect_full_renders(lights_scene(is_wide ? 68 : 28, is_wide ? 18 : 21), path_view(c.samples), c.rows(), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(Path, LightEdits,
                         testing::Values(LightRows{"gifts", gift_rows, 2}, LightRows{"shapes", shape_rows, 3},
                                         LightRows{"order", order_rows, 1}, LightRows{"order", order_rows, 4},
                                         LightRows{"sky", sky_rows, 1}, LightRows{"sky", sky_rows, 4},
                                         LightRows{"emission", emission_rows, 2},
                                         LightRows{"between_colours", between_colors_rows, 2},
                                         LightRows{"between_moves", between_moves_rows, 1},
                                         LightRows{"between_moves", between_moves_rows, 4}),
                         [](const testing::TestParamInfo<LightRows>& rows) {
                           return std::string(rows.param.name) + "_" + std::to_string(rows.param.samples);
                         });

TEST(LightEdit, of_colours_alone_looks_at_no_sample) {
  Replayer replayer = path_replayer(lights_scene(28, 21), path_view(2));
  for (const MatrixRow& edit : {row("lamp", set("/lights/Lamp/color", {0.2, 1, 0.4})),
                                row("area", set("/lights/Window/intensity", 30)),
                                row("temperature", set("/lights/Sun/extras/relook/temperature", 9000)),
                                row("sky", set(kSky + "color", {0.4, 0.5, 1}), set(kSky + "intensity", 2)),
                                row("emission", set(kGlow + "emissiveFactor", {0.2, 0.4, 1})),
                                row("ambient", set("/scene/extras/relook/ambient", {0.2, 0.1, 0.1})),
                                row("background", set(kSky + "background/color", {0.3, 0.3, 0.1}))}) {
    const StepResult step = expect_path_step(replayer, edit_of(edit.operations), edit.name);
    EXPECT_EQ(step.counters.samples_affected, 0U) << edit.name;
    EXPECT_EQ(step.counters.ray_updates + step.counters.shadow_updates, 0U) << edit.name;
    EXPECT_FALSE(step.changed_pixels.empty()) << edit.name;
  }
}

TEST(LightEdit, that_fails_leaves_all_as_before) {
  Replayer replayer = path_replayer(lights_scene(28, 21), path_view(2));
  const Json look = replayer.state().document().look;
  const Frame frame = replayer.image().frame;
  const std::vector<PackedSums> sums = replayer.image().light_sums;
  const MatrixRow wrong[] = {
      row("an unknown node excluded", set("/nodes/Lamp/extras/relook/excludes", Json::array({"Nobody"}))),
      row("one of two", set("/lights/Window/size", 2), set("/lights/Dish/size", -1)),
      row("after a move", set("/nodes/Window/translation", {0, 3, 0}), set("/lights/Spot/extras/relook/radius", -1)),
      row("after one more", add("/nodes/More", placed_light("EXT_lights_area", "Dish", {0, 3, 1})),
          set("/lights/Lamp/extras/relook/rate", 0)),
      row("an excluded node removed", removed("/nodes/Cloth")),
      row("an unknown image", set(kSky + "rotation", 2), set(kSky + "image", "NoImage")),
      row("after emission", set(kGlow + "emissiveFactor", {0, 0, 0}),
          set("/materials/NoMaterial/emissiveFactor", {1, 1, 1})),
      row("after a new order", removed("/nodes/Lamp"), set("/lights/Sun/extras/relook/angle", 4)),
  };
  for (const MatrixRow& edit : wrong) {
    EXPECT_THROW(static_cast<void>(replayer.step(edit_of(edit.operations), "wrong", ".")), InputError) << edit.name;
    EXPECT_EQ(replayer.state().document().look, look) << edit.name;
    EXPECT_EQ(pixel_differences(replayer.image().frame, frame), "") << edit.name;
    EXPECT_EQ(replayer.image().light_sums, sums) << edit.name;
  }
  expect_path_step(replayer, edit_of(row("", set("/nodes/Window/translation", {0, 3, 0})).operations), "afterwards");
}

}  // namespace
}  // namespace relook
