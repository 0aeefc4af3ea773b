// report.json keeps its names: the schema that ships with the project is the contract, and every report fits it.
#include "report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "report/journal_words.h"
#include "report/report_file.h"
#include "run_program.h"

namespace relook {
namespace {

/// The part of JSON Schema that report.schema.json uses. Unknown keywords are failures, so that none is ignored
/// silently.
class Schema {
 public:
  explicit Schema(Json document) : document_(std::move(document)) {}
  [[nodiscard]] std::vector<std::string> violations(const Json& value) const {
    std::vector<std::string> found;
    check(document_, value, "", found);
    return found;
  }

 private:
  static bool has_type(const std::string& type, const Json& value) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "boolean") return value.is_boolean();
    return type == "null" && value.is_null();
  }

  static bool fits(const std::string& keyword, const Json& rule, const Json& value) {
    if (keyword == "type") {
      if (rule.is_string()) return has_type(rule, value);
      return std::any_of(rule.begin(), rule.end(), [&](const Json& type) { return has_type(type, value); });
    }
    if (keyword == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (keyword == "pattern")
      return !value.is_string() || std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>()));
    if (keyword == "minimum") return !value.is_number() || value >= rule;
    if (keyword == "maximum") return !value.is_number() || value <= rule;
    if (keyword == "minItems") return !value.is_array() || value.size() >= rule.get<std::size_t>();
    if (keyword == "maxItems") return !value.is_array() || value.size() <= rule.get<std::size_t>();
    if (keyword == "required")
      return !value.is_object() || std::all_of(rule.begin(), rule.end(),
                                               [&](const Json& key) { return value.contains(key.get<std::string>()); });
    return keyword == "title" || keyword == "description" || keyword == "$schema" || keyword == "$defs";
  }

  void check(const Json& schema, const Json& value, const std::string& place, std::vector<std::string>& found) const {
    for (const auto& [keyword, rule] : schema.items()) {
      if (keyword == "$ref") {
        check(document_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, place, found);
      } else if (keyword == "items") {
        for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
          check(rule, value[i], place + "/" + std::to_string(i), found);
      } else if (keyword == "properties" || keyword == "additionalProperties") {
        check_members(keyword, schema, value, place, found);
      } else if (!fits(keyword, rule, value)) {
        found.push_back(place + ": " + keyword);
      }
    }
  }

  void check_members(const std::string& keyword, const Json& schema, const Json& value, const std::string& place,
                     std::vector<std::string>& found) const {
    if (!value.is_object()) return;
    const Json named = schema.value("properties", Json::object());
    for (const auto& [key, member] : value.items()) {
      if (keyword == "properties" && named.contains(key)) check(named[key], member, place + "/" + key, found);
      if (keyword == "additionalProperties" && !named.contains(key))
        check(schema[keyword], member, place + "/" + key, found);
    }
  }

  Json document_;
};

Schema shipped_schema() {
  const Bytes bytes = read_file(std::filesystem::path(RELOOK_SOURCE_DIR) / "src/report/report.schema.json");
  return Schema(parse_json(text_of(bytes), "report.schema.json"));
}

RunReport small_run() {
  RunReport report;
  report.scene = "scene.gltf";
  report.source = Json::object();
  report.places = {{"cache", {"../c", "/c"}}, {"journal", {"../j.json", "/j.json"}}};
  report.camera.width = 4;
  report.camera.height = 3;
  report.threads = 2;
  report.cache.bytes_by_part["look"] = 10;
  report.cache.total_bytes = 10;
  report.parts = {"0-3"};
  return report;
}

std::vector<StepReport> small_steps() {
  StepReport base;
  base.name = "base";
  base.words = entry_words(Journal(), 0, 0);
  base.change = ChangeClass::base;
  base.source_hash = std::string(32, 'c');
  base.frame = frame_name(base.place);
  base.files[base.frame] = {std::string(32, 'a'), 100, 1};
  StepReport dragged = base;
  dragged.place = {3, 2, 2};
  dragged.is_drag = true;
  dragged.change = ChangeClass::geometric;
  dragged.frame = frame_name(dragged.place);
  dragged.edits_hash = std::string(32, 'e');
  dragged.files = {{dragged.frame, {std::string(32, 'b'), 100, 2}}};
  dragged.verify = VerifyResult{12, 1};
  dragged.verify_percent = 100;
  return {base, dragged};
}

/// As a run has it, written and read again.
Json written(const RunReport& run) {
  const ScratchFolder folder("report");
  ReportFile file(folder / "report.json", report_head_json(run));
  for (const StepReport& step : small_steps()) file.add(step_json(step));
  file.publish();
  EXPECT_EQ(file.entries().count, 2U);
  EXPECT_EQ(file.entries().at(1)["frame"], "frames/0003_02.exr");
  return parse_json(text_of(read_file(folder / "report.json")), "report.json");
}

TEST(Report, fits_the_schema_that_ships) {
  RunReport report = small_run();
  EXPECT_EQ(shipped_schema().violations(written(report)), std::vector<std::string>{});
  report.full_render_seconds = 1.5;
  report.verify_percent = 50;
  report.structures.memory_bytes = 1 << 20;
  EXPECT_EQ(shipped_schema().violations(written(report)), std::vector<std::string>{});
}

TEST(Report, schema_notices_what_is_missing_or_wrong) {
  const Json sound = written(small_run());
  const Schema schema = shipped_schema();
  for (const auto& [key, unused] : sound.items()) {
    Json broken = sound;
    broken.erase(key);
    EXPECT_FALSE(schema.violations(broken).empty()) << key;
  }
  for (const auto& [key, unused] : sound["steps"][1].items()) {
    Json broken = sound;
    broken["steps"][1].erase(key);
    EXPECT_FALSE(schema.violations(broken).empty()) << key;
    if (key == "extras") continue;  // anything may stand there
    broken["steps"][1][key] = key == "exposure" ? Json("dark") : Json(-1);
    EXPECT_FALSE(schema.violations(broken).empty()) << key;
  }
}

TEST(Report, has_every_name_of_version_1) {
  const Json step = written(small_run())["steps"][1];
  for (const char* name : {"step",
                           "name",
                           "class",
                           "drag_frame",
                           "wedge_frame",
                           "frame",
                           "samples_total",
                           "samples_affected",
                           "pixels_changed",
                           "regions_visited",
                           "regions_culled",
                           "ray_tests",
                           "ray_tests_culled",
                           "ray_updates",
                           "shadow_updates",
                           "object_rays",
                           "color_trees_evaluated",
                           "color_trees_reused",
                           "seconds",
                           "resident",
                           "evicted",
                           "rebuilt",
                           "reloaded",
                           "peak_rss",
                           "verify"})
    EXPECT_TRUE(step.contains(name)) << name;
  for (const char* name : {"classify", "select", "test", "update", "evaluate", "write", "total"})
    EXPECT_TRUE(step["seconds"].contains(name)) << name;
  for (const char* name : {"ray_paths", "ray_trees", "sample_colors", "light_sums", "kept_rays", "kept_segments",
                           "kept_terms", "kept_vertices", "color_trees", "groups", "tunnels", "total"})
    EXPECT_TRUE(step["resident"].contains(name)) << name;
  EXPECT_EQ(step["drag_frame"], 2);
  EXPECT_EQ(step["frame"], "frames/0003_02.exr");
  EXPECT_EQ(step["class"], "geometric");
  EXPECT_EQ(step["verify"]["pixels_different"], 1);
  EXPECT_EQ(written(small_run())["frames"].size(), 2U);
}

TEST(Report, counters_add_up) {
  Counters a, b;
  a.ray_updates = 3;
  a.samples_total = 5;
  b.ray_updates = 4;
  b.color_trees_evaluated = 1;
  a += b;
  EXPECT_EQ(a.ray_updates, 7U);
  EXPECT_EQ(a.samples_total, 5U);
  EXPECT_EQ(a.color_trees_evaluated, 1U);
}

}  // namespace
}  // namespace relook
