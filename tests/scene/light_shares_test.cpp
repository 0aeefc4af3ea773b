// What an import writes into the lights of a scene that has many: `sum` and `rate`, of those that say nothing of it.
#include <gtest/gtest.h>

#include <map>

#include "scene/compile/compile_material.h"
#include "scene/look/light_shares.h"

namespace relook {
namespace {

/// "L00", in the order of a file and of the light order alike.
std::string lamp_name(std::size_t i) { return std::string(i < 10 ? "L0" : "L") + std::to_string(i); }

/// A file with so many point lights and a node for each. `of_relook`: by light, its extras.relook.
Json lamps(std::size_t count, const std::map<std::string, Json>& of_relook = {}) {
  Json gltf = Json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "nodes": []})");
  Json lights = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = lamp_name(i);
    lights.push_back({{"type", "point"}, {"name", name}});
    if (const auto found = of_relook.find(name); found != of_relook.end())
      lights.back()["extras"] = {{"relook", found->second}};
    gltf["nodes"].push_back({{"name", name}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    gltf["scenes"][0]["nodes"].push_back(i);
  }
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
  return gltf;
}

LookDocument document_of(const Json& gltf) {
  ImportedGltf imported;
  imported.file = "t.gltf";
  imported.gltf = gltf;
  return make_look_document(std::move(imported));
}

std::string sum_of(const LookDocument& document, const std::string& light) {
  const Json* sum = member_at(document.look["lights"][light], {"extras", "relook", "sum"});
  return sum == nullptr ? "" : sum->get<std::string>();
}
double rate_of(const LookDocument& document, const std::string& light) {
  const Json* rate = member_at(document.look["lights"][light], {"extras", "relook", "rate"});
  return rate == nullptr ? 1 : rate->get<double>();
}

TEST(LightShares, sixteen_lights_are_as_the_file_has_them) {
  const LookDocument document = document_of(lamps(16));
  for (const auto& light : document.look["lights"]) EXPECT_FALSE(light.contains("extras"));
}

TEST(LightShares, from_the_seventeenth_on_lights_share_a_sum) {
  const LookDocument document = document_of(lamps(20));
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(sum_of(document, lamp_name(i)), i < 16 ? "" : "others") << i;
}

// The largest power of two with which 16 lights at most are sampled at a deeper vertex, but not below 1/4.
TEST(LightShares, rates_bound_what_a_deeper_vertex_costs) {
  for (const auto& [count, rate] : std::initializer_list<std::pair<std::size_t, double>>{
           {16, 1}, {17, 0.5}, {32, 0.5}, {33, 0.25}, {64, 0.25}, {65, 0.25}, {150, 0.25}}) {
    const LookDocument document = document_of(lamps(count));
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(rate_of(document, lamp_name(i)), rate) << i << " of " << count;
  }
}

TEST(LightShares, what_a_file_says_stays) {
  const LookDocument document = document_of(lamps(20, {{"L03", {{"sum", "set"}}},
                                                       {"L17", {{"sum", ""}}},
                                                       {"L18", {{"rate", 1}}},
                                                       {"L19", {{"sum", "set"}, {"rate", 0.75}}}}));
  EXPECT_EQ(sum_of(document, "L03"), "set");
  EXPECT_EQ(sum_of(document, "L17"), "");
  EXPECT_EQ(sum_of(document, "L19"), "set");
  EXPECT_EQ(rate_of(document, "L17"), 0.5);
  EXPECT_EQ(rate_of(document, "L18"), 1);
  EXPECT_EQ(rate_of(document, "L19"), 0.75);
  // L17 is alone and counts, L03 is not: L00 to L15 without L03 are the other fifteen.
  for (std::size_t i = 0; i < 16; ++i)
    if (i != 3) { EXPECT_EQ(sum_of(document, lamp_name(i)), "") << i; }
  EXPECT_EQ(sum_of(document, "L16"), "others");
  EXPECT_EQ(sum_of(document, "L18"), "others");
}

TEST(LightShares, a_light_counts_as_often_as_nodes_place_it) {
  Json gltf = lamps(4);
  for (int i = 0; i < 16; ++i) {
    gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
    gltf["nodes"].push_back(gltf["nodes"][1]);
  }
  const LookDocument document = document_of(gltf);
  EXPECT_EQ(sum_of(document, "L01"), "others");
  for (const char* alone : {"L00", "L02", "L03"}) EXPECT_EQ(sum_of(document, alone), "") << alone;
  EXPECT_EQ(rate_of(document, "L00"), 0.5);
}

TEST(LightShares, automatic_lights_come_after_those_of_the_file) {
  for (const std::size_t count : {15U, 16U}) {
    LookDocument document = document_of(lamps(count));
    const Camera camera{};
    (void)add_auto_lights(document, camera, Integrator::path);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(sum_of(document, lamp_name(i)), "") << i;
      EXPECT_EQ(rate_of(document, lamp_name(i)), 1) << i;
    }
    EXPECT_EQ(sum_of(document, "key"), count == 15 ? "" : "others");
    EXPECT_EQ(sum_of(document, "fill"), "others");
    EXPECT_EQ(sum_of(document, "rim"), "others");
    EXPECT_EQ(rate_of(document, "rim"), 0.5);
  }
}

}  // namespace
}  // namespace relook
