// The table of bounds against files: what rounding puts beyond a bound is put right with a warning, what is further out
// is refused where the scene uses it and ignored where not, --strict-gltf refuses all of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "gltf_writer.h"
#include "scene/gltf/import.h"
#include "scene/gltf/import_rules.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

struct Answer {
  std::string error;  // "" if the file is accepted
  ImportedGltf imported;
};

class ImportValues : public testing::Test {
 protected:
  ImportValues() { fs::create_directories(folder_ / "inner"); }
  ~ImportValues() override {
    set_import_rules({});
    fs::remove_all(folder_);
  }
  void write(const fs::path& name, std::string_view bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] Answer answer(std::string_view bytes, const char* name = "inner/scene.glb") const {
    write(name, bytes);
    Answer result;
    try {
      result.imported = import_gltf(folder_ / name);
    } catch (const InputError& error) {
      result.error = error.what();
    }
    return result;
  }
  [[nodiscard]] Answer answer(const SceneFile& file) const { return answer(file.glb()); }
  /// The square's JSON as a .gltf, its buffer beside it.
  [[nodiscard]] Json text_scene() const {
    const SceneFile file = square();
    write("inner/data.bin", file.binary);
    Json gltf = file.gltf;
    gltf["buffers"] = {{{"byteLength", file.binary.size()}, {"uri", "data.bin"}}};
    return gltf;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("relook_values_" + std::to_string(::getpid()));
};

/// A number of glTF with a place for a value in a file.
struct Number {
  const SchemaField* field;
  std::string pointer;  // below the entity
};

/// All numbers below a schema but relook's own.
void collect_numbers(const Schema& schema, const std::string& at, std::vector<Number>& numbers) {
  for (const SchemaField& field : schema.fields) {
    if (field.key == "extras") continue;
    const std::string pointer = at + "/" + std::string(field.key);
    if (field.kind == FieldKind::number || field.kind == FieldKind::reals) numbers.push_back({&field, pointer});
    if (field.kind == FieldKind::object) collect_numbers(*field.inner, pointer, numbers);
  }
}

/// Where entities of a section are in square(), and another that the scene does not use.
struct Home {
  const Schema* schema;
  std::string used, unused;
};

const std::vector<Home>& homes() {
  static const std::vector<Home> all{
      {&schema_of(Section::materials), "/materials/0", "/materials/1"},
      {&schema_of(Section::lights), "/extensions/KHR_lights_punctual/lights/0",
       "/extensions/KHR_lights_punctual/lights/1"},
      {&schema_of(Section::nodes), "/nodes/1", "/nodes/3"},
      {&camera_schema(), "/cameras/0", "/cameras/1"},
  };
  return all;
}

/// square() with a second material, light, node and camera that nothing names.
SceneFile with_unused() {
  SceneFile file = square();
  file.gltf["materials"].push_back(Json::object());
  Json& lights = file.gltf["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(lights[0]);
  file.gltf["nodes"].push_back(Json::object());
  file.gltf["cameras"].push_back(file.gltf["cameras"][0]);
  return file;
}

void set_number(SceneFile& file, const std::string& home, const Number& number, double value) {
  Json& entity = file.gltf[Json::json_pointer(home)];
  const bool is_array = number.field->kind == FieldKind::reals;
  const std::string key(number.field->key);
  if (key == "innerConeAngle") entity["spot"]["outerConeAngle"] = 1.5707963267948966;
  if (key == "matrix") entity.erase("translation");
  if (key == "xmag" || key == "ymag" || number.pointer.starts_with("/orthographic")) {
    entity.erase("perspective");
    entity["type"] = "orthographic";
    entity["orthographic"] = {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 0.1}, {"zfar", 1e3}};
  }
  // The slots on the way name a texture.
  const Json::json_pointer place(number.pointer);
  for (Json::json_pointer at = place.parent_pointer(); !at.empty(); at = at.parent_pointer())
    if (at.back().ends_with("Texture")) entity[at]["index"] = 0;
  if (!is_array) {
    entity[place] = value;
    return;
  }
  Json values = number.field->fallback;
  if (values.is_null()) values = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (number.field->count == 0) values = {0};
  values[0] = value;
  entity[place] = values;
}

std::vector<Number> numbers_of(const Home& home) {
  std::vector<Number> numbers;
  collect_numbers(*home.schema, "", numbers);
  return numbers;
}

double step_up(double x) { return static_cast<double>(std::nextafter(static_cast<float>(x), HUGE_VALF)); }
double step_down(double x) {  // denormal numbers count as zero
  return x == 0 ? -1e-8 : static_cast<double>(std::nextafter(static_cast<float>(x), -HUGE_VALF));
}

TEST_F(ImportValues, one_float_beyond_a_bound_of_gltf_is_the_bound_with_a_warning) {
  std::size_t tried = 0;
  for (const Home& home : homes())
    for (const Number& number : numbers_of(home)) {
      const SchemaField& field = *number.field;
      std::vector<std::pair<double, double>> beyond;  // value, bound
      if (field.high < kCeiling) beyond.emplace_back(step_up(step_up(field.high)), field.high);
      if (std::abs(field.low) < kCeiling && field.low != kAboveZero)
        beyond.emplace_back(step_down(field.low), field.low);
      for (const auto& [value, bound] : beyond) {
        SceneFile file = with_unused();
        set_number(file, home.used, number, value);
        const std::string where = home.used + number.pointer + " = " + std::to_string(value);
        const Answer tolerant = answer(file);
        EXPECT_EQ(tolerant.error, "") << where;
        EXPECT_FALSE(tolerant.imported.warnings.empty()) << where;
        const Json kept = tolerant.imported.gltf.value(Json::json_pointer(home.used + number.pointer), Json());
        EXPECT_EQ(kept.is_array() ? kept.at(0) : kept, bound) << where;
        set_import_rules({.is_strict = true, .roots = {}});
        EXPECT_NE(answer(file).error, "") << where << " --strict-gltf";
        set_import_rules({});
        ++tried;
      }
    }
  EXPECT_GT(tried, 40U);
}

TEST_F(ImportValues, a_value_far_beyond_is_refused_where_it_is_used_and_ignored_where_not) {
  std::size_t tried = 0;
  for (const Home& home : homes())
    for (const Number& number : numbers_of(home)) {
      const SchemaField& field = *number.field;
      std::vector<double> beyond;
      if (field.high < kCeiling) beyond.push_back(field.high + 1.5);
      if (std::abs(field.low) < kCeiling) beyond.push_back(field.low - 1.5);
      for (const double value : beyond) {
        if (field.key == "emissiveFactor" && value > 1) continue;  // split, see below
        SceneFile file = with_unused();
        set_number(file, home.used, number, value);
        EXPECT_NE(answer(file).error.find(": " + home.used + number.pointer), std::string::npos)
            << home.used << number.pointer << ": " << answer(file).error;
        file = with_unused();
        set_number(file, home.unused, number, value);
        EXPECT_EQ(answer(file).error, "") << home.unused << number.pointer;
        EXPECT_FALSE(answer(file).imported.warnings.empty()) << home.unused << number.pointer;
        ++tried;
      }
    }
  EXPECT_GT(tried, 40U);
}

TEST_F(ImportValues, where_gltf_has_no_bound_any_number_is_read) {
  for (const Home& home : homes())
    for (const Number& number : numbers_of(home))
      for (const double value : {1e7, 3.4028235e38, 1.7976931348623157e308}) {
        if (number.field->high < kCeiling || number.field->key == "znear") continue;  // beyond zfar
        SceneFile file = with_unused();
        set_number(file, home.used, number, value);
        EXPECT_EQ(answer(file).error, "") << home.used << number.pointer << " = " << value;
      }
}

TEST_F(ImportValues, emission_above_1_keeps_its_light) {
  SceneFile file = square();
  file.gltf["materials"][0]["emissiveFactor"] = {2, 1, 0};
  file.gltf["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 3;
  const Answer read = answer(file);
  ASSERT_EQ(read.error, "");
  const Json& material = read.imported.gltf["materials"][0];
  EXPECT_EQ(material["emissiveFactor"], (Json{1.0, 0.5, 0.0}));
  EXPECT_EQ(material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 6.0);
  EXPECT_EQ(read.imported.warnings.size(), 1U);
}

TEST_F(ImportValues, a_cone_as_wide_inside_as_outside_has_a_hard_edge) {
  SceneFile file = square();
  Json& spot = file.gltf["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"];
  spot = {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}};
  EXPECT_EQ(answer(file).error, "");
  EXPECT_EQ(answer(file).imported.warnings.size(), 1U);
  spot["innerConeAngle"] = 0.6;
  EXPECT_NE(answer(file).error, "");
}

TEST_F(ImportValues, columns_that_nothing_reads_may_hold_anything) {
  const float bad = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> uv{0, 0, bad, 0, 0, 1, 1, 1};
  struct Case {
    const char* name;
    bool is_fine;
    std::function<void(SceneFile&)> change;
  };
  const auto skin = [](SceneFile& file) {
    file.primitive()["attributes"]["JOINTS_0"] =
        file.add_accessor(file.add_view(std::vector<std::uint8_t>(16)), 5121, "VEC4", 4);
    file.primitive()["attributes"]["WEIGHTS_0"] = file.floats(std::vector<float>(16, HUGE_VALF), "VEC4", 4);
  };
  const Case cases[] = {
      {"uv of a set that no texture reads", true,
       [&](SceneFile& file) { file.primitive()["attributes"]["TEXCOORD_1"] = file.floats(uv, "VEC2", 2); }},
      {"uv of the set that a texture reads", false,
       [&](SceneFile& file) { file.primitive()["attributes"]["TEXCOORD_0"] = file.floats(uv, "VEC2", 2); }},
      {"tangents", true,
       [&](SceneFile& file) {
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
         file.primitive()["attributes"]["TANGENT"] = file.floats(std::vector<float>(16, bad), "VEC4", 4);
       }},
      {"tangents of three numbers", true,
       [&](SceneFile& file) {
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
         file.primitive()["attributes"]["TANGENT"] = file.floats(std::vector<float>(12, 1), "VEC3", 3);
       }},
      {"normals of an unlit material", true,
       [&](SceneFile& file) {
         file.gltf["materials"][0]["extensions"] = {{"KHR_materials_unlit", Json::object()}};
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, bad, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
       }},
      {"normals", false,
       [&](SceneFile& file) {
         file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, bad, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
       }},
      {"weights without a skin", true, skin},
      {"weights of a skin", false,
       [&](SceneFile& file) {
         skin(file);
         file.gltf["skins"] = {{{"joints", {1}}}};
         file.gltf["nodes"][0]["skin"] = 0;
       }},
      {"positions of a mesh that no node shows", true,
       [&](SceneFile& file) {
         Json primitive = {{"attributes", {{"POSITION", file.floats(std::vector<float>(9, bad), "VEC3", 3)}}}};
         file.gltf["meshes"].push_back({{"primitives", {primitive}}});
       }},
      {"indices of a mesh that no node shows: structure", false,
       [&](SceneFile& file) {
         Json primitive = file.primitive();
         primitive["indices"] = file.add_accessor(file.add_view<std::uint16_t>({0, 1, 4}), 5123, "SCALAR", 3);
         file.gltf["meshes"].push_back({{"primitives", {primitive}}});
       }},
  };
  for (const Case& one : cases) {
    SceneFile file = square();
    one.change(file);
    const Answer read = answer(file);
    EXPECT_EQ(read.error == "", one.is_fine) << one.name << ": " << read.error;
    if (!one.is_fine) continue;
    EXPECT_FALSE(read.imported.warnings.empty()) << one.name;
    EXPECT_EQ(read.imported.meshes.at(0).at(0).positions.size(), 4U) << one.name;
    set_import_rules({.is_strict = true, .roots = {}});
    EXPECT_NE(answer(file).error, "") << one.name << " --strict-gltf";
    set_import_rules({});
  }
}

TEST_F(ImportValues, roots_that_are_children_stand_below_their_parents) {
  SceneFile file = square();
  file.gltf["scenes"][0]["nodes"] = {1, 0, 0};
  const Answer read = answer(file);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.imported.warnings.size(), 2U);
  EXPECT_EQ(active_nodes(read.imported.gltf), (std::vector<std::size_t>{0, 1, 2}));
  file.gltf["scenes"][0]["nodes"] = {1};  // its parent is not shown
  EXPECT_EQ(active_nodes(answer(file).imported.gltf), (std::vector<std::size_t>{1}));
}

TEST_F(ImportValues, a_missing_image_matters_where_a_texture_that_is_shown_has_it) {
  Json gltf = text_scene();
  gltf["images"] = {{{"uri", "none.png"}}};
  gltf["textures"].push_back({{"source", 0}});
  const Answer read = answer(gltf.dump(), "inner/scene.gltf");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.imported.warnings.size(), 1U);
  EXPECT_FALSE(read.imported.gltf["textures"][1].contains("source"));
  gltf["textures"][0]["source"] = 0;
  EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error.find("/images/0/uri: no such file"), std::string::npos);
  gltf["textures"][0].erase("source");
  for (const char* uri : {"../none.png", ".", "/etc/none.png"}) {
    gltf["images"][0]["uri"] = uri;
    EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error, "") << uri << ": where it leads is structure";
  }
}

TEST_F(ImportValues, names_are_resolved_as_uris_are) {
  Json gltf = text_scene();
  for (const char* uri : {"./data.bin", "./a/../data.bin", "none/../data.bin", "a/./../data.bin"}) {
    gltf["buffers"][0]["uri"] = uri;
    EXPECT_EQ(answer(gltf.dump(), "inner/scene.gltf").error, "") << uri;
  }
  for (const char* uri : {"../inner/../../data.bin", "a/../../data.bin", ".."}) {
    gltf["buffers"][0]["uri"] = uri;
    EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error.find("leads out of its folder"), std::string::npos) << uri;
  }
}

TEST_F(ImportValues, roots_open_folders_and_what_links_lead_to_within_them) {
  Json gltf = text_scene();
  fs::create_directories(folder_ / "library");
  fs::create_directories(folder_ / "elsewhere");
  for (const char* at : {"library", "elsewhere"}) fs::copy_file(folder_ / "inner/data.bin", folder_ / at / "data.bin");
  fs::create_symlink(folder_ / "library/data.bin", folder_ / "inner/linked.bin");
  fs::create_symlink(folder_ / "elsewhere/data.bin", folder_ / "library/away.bin");
  fs::create_directory_symlink(folder_ / "library", folder_ / "alias");
  const auto error_of = [&](const std::string& uri) {
    gltf["buffers"][0]["uri"] = uri;
    return answer(gltf.dump(), "inner/scene.gltf").error;
  };
  const std::string library = (folder_ / "library").string();
  for (const std::string& uri : {std::string("../library/data.bin"), library + "/data.bin", std::string("linked.bin")})
    EXPECT_NE(error_of(uri), "") << uri;
  for (const char* root : {"library", "library/", "alias", "library/../library"}) {
    set_import_rules({.is_strict = false, .roots = {folder_ / root}});
    for (const std::string& uri : {std::string("../library/data.bin"), library + "/data.bin",
                                   std::string("linked.bin"), std::string("data.bin")})
      EXPECT_EQ(error_of(uri), "") << root << " " << uri;
    for (const char* uri : {"../elsewhere/data.bin", "../library/away.bin", "../library/../elsewhere/data.bin"})
      EXPECT_NE(error_of(uri).find("--root"), std::string::npos) << root << " " << uri << ": " << error_of(uri);
  }
}

TEST_F(ImportValues, what_has_one_plain_meaning_is_read_with_a_warning) {
  const std::pair<const char*, std::function<void(Json&)>> cases[] = {
      {"the cone of a light that is no spot",
       [](Json& gltf) {
         Json& light = gltf["extensions"]["KHR_lights_punctual"]["lights"][0];
         light = {{"type", "directional"}, {"spot", {{"innerConeAngle", 3}}}};
       }},
      {"an unused light without a type",
       [](Json& gltf) { gltf["extensions"]["KHR_lights_punctual"]["lights"].push_back(Json::object()); }},
      {"an integer with a fraction",
       [](Json& gltf) { gltf["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 0.0; }},
      {"a buffer that no view names",
       [](Json& gltf) { gltf["buffers"].push_back({{"byteLength", 9}, {"uri", "none.bin"}}); }},
      {"an unused image in bad base64",
       [](Json& gltf) { gltf["images"] = {{{"uri", "data:image/png;base64,*"}}}; }},
      {"an image whose type is not said",
       [](Json& gltf) { gltf["images"] = {{{"bufferView", 0}}}; }},
      {"an unused camera without a lens", [](Json& gltf) { gltf["cameras"].push_back({{"type", "perspective"}}); }},
  };
  for (const auto& [name, change] : cases) {
    Json gltf = text_scene();
    change(gltf);
    const Answer read = answer(gltf.dump(), "inner/scene.gltf");
    EXPECT_EQ(read.error, "") << name;
    EXPECT_EQ(read.imported.warnings.size(), 1U) << name;
    set_import_rules({.is_strict = true, .roots = {}});
    EXPECT_NE(answer(gltf.dump(), "inner/scene.gltf").error, "") << name << " --strict-gltf";
    set_import_rules({});
  }
}

TEST_F(ImportValues, framing_of_files_is_read_as_it_is_meant) {
  const SceneFile file = square();
  EXPECT_EQ(answer(file.glb() + std::string(9, 'x')).imported.warnings.size(), 1U);
  Json gltf = text_scene();
  EXPECT_EQ(answer("\xEF\xBB\xBF" + gltf.dump(), "inner/scene.gltf").imported.warnings.size(), 1U);
  SceneFile outside = square();
  outside.binary.clear();
  outside.gltf["buffers"] = gltf["buffers"];
  EXPECT_EQ(answer(outside.glb()).error, "") << "a .glb may name files";
  gltf = {{"asset", {{"version", "2.0"}}}};
  for (const char* uri : {"data:application/octet-stream;base64,AQIDBA==", "data:application/octet-stream;BASE64,AQIDBA==",
                          "DATA:;Base64,AQIDBA", "data:;base64,AQID%42A%3D%3D", "data:;base64,AQ\n ID\r\nBA=="}) {
    gltf["buffers"] = {{{"byteLength", 4}, {"uri", uri}}};
    EXPECT_EQ(answer(gltf.dump(), "inner/scene.gltf").error, "") << uri;
  }
}

}  // namespace
}  // namespace relook
