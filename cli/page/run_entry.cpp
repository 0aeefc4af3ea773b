#include "page/run_entry.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "page/cut.h"
#include "page/run_marks.h"

namespace relook {
namespace {

constexpr std::size_t kLongestName = 160, kLongestText = 400, kLongestClass = 20, kLongestNote = 2000;  // bytes
constexpr std::size_t kMostDetailBytes = 8192;                                                          // of one entry

constexpr std::array<std::string_view, 38> kColumns{"/step",
                                                    "/pixels_changed",
                                                    "/samples_affected",
                                                    "/regions_visited",
                                                    "/regions_culled",
                                                    "/ray_tests",
                                                    "/ray_tests_culled",
                                                    "/ray_updates",
                                                    "/shadow_updates",
                                                    "/color_trees_evaluated",
                                                    "/seconds/classify",
                                                    "/seconds/select",
                                                    "/seconds/test",
                                                    "/seconds/update",
                                                    "/seconds/evaluate",
                                                    "/seconds/write",
                                                    "/seconds/total",
                                                    "/seconds/cpu",
                                                    "/full_render/seconds",
                                                    "/full_render/cpu_seconds",
                                                    "/full_render/measured",
                                                    "/resident/ray_paths",
                                                    "/resident/ray_trees",
                                                    "/resident/sample_colors",
                                                    "/resident/light_sums",
                                                    "/resident/kept_rays",
                                                    "/resident/kept_segments",
                                                    "/resident/kept_terms",
                                                    "/resident/kept_vertices",
                                                    "/resident/color_trees",
                                                    "/resident/groups",
                                                    "/resident/tunnels",
                                                    "/resident/total",
                                                    "/evicted/total",
                                                    "/rebuilt/total",
                                                    "/reloaded/total",
                                                    "/verify/pixels_compared",
                                                    "/verify/pixels_different"};

/// The number at a pointer, seconds to four digits, or 1 and 0 for true and false; null: there is none.
Json number_at(const Json& entry, std::string_view pointer) {
  const Json::json_pointer place{std::string(pointer)};
  if (!entry.contains(place)) return nullptr;
  const Json& value = entry.at(place);
  if (value.is_boolean()) return value.get<bool>() ? 1 : 0;
  if (!value.is_number()) return nullptr;
  if (!value.is_number_float()) return value;
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value.get<double>());
  const double rounded = std::strtod(text, nullptr);
  return rounded == 0 ? Json(0) : Json(rounded);
}

Json operation_json(const PatchOperation& operation) {
  Json json = whole_operation_json(operation);
  for (const char* place : {"path", "from"})
    if (json.contains(place)) json[place] = cut_json(json[place], kLongestText);
  if (json.contains("value")) json["value"] = cut_json(json["value"], kLongestText);
  return json;
}

/// The details of one entry: lists, whose last items are left out when all would take more than kMostDetailBytes.
class Details {
 public:
  /// Adds a list of `count` items. `item(i)`: the JSON of one.
  template <class Item>
  void add(const char* key, std::size_t count, const Item& item) {
    if (count == 0) return;
    Json& list = json_[key] = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
      Json next = item(i);
      const std::size_t bytes = json_text(next).size();
      if (bytes > left_bytes_) {
        json_["cut"] = true;
        return;
      }
      left_bytes_ -= bytes;
      list.push_back(std::move(next));
    }
  }
  void add_edit(const Edit& edit) {
    add("edit", edit.size(), [&](std::size_t i) { return operation_json(edit[i]); });
  }
  [[nodiscard]] Json& json() { return json_; }

 private:
  Json json_ = Json::object();
  std::size_t left_bytes_ = kMostDetailBytes;
};

}  // namespace

std::span<const std::string_view> row_columns() { return kColumns; }

Json whole_operation_json(const PatchOperation& operation) {
  constexpr const char* kNames[] = {"add", "remove", "replace", "move", "copy", "test"};
  Json json{{"op", kNames[static_cast<std::size_t>(operation.op)]}, {"path", operation.path}};
  if (!operation.from.empty()) json["from"] = operation.from;
  if (operation.op == PatchOp::add || operation.op == PatchOp::replace || operation.op == PatchOp::test)
    json["value"] = operation.value;
  return json;
}

std::string stem_of(const Json& entry, std::size_t i) {
  const std::string frame = text_at(entry, "frame"), preview = text_at(entry, "preview");
  const std::string stem = std::filesystem::path(frame).stem().string();
  const bool is_numbered = !stem.empty() && stem.size() <= 40 && stem.find_first_not_of("0123456789_") == stem.npos;
  if (!is_numbered || frame != "frames/" + stem + ".exr" || preview != "previews/" + stem + ".png")
    throw InputError("report.json", "/steps/" + std::to_string(i), "names no frame and preview of its run");
  return stem;
}

Json row_of(const Json& entry, const std::string& stem, Json marks) {
  Json row{stem, cut_text(text_at(entry, "name"), kLongestName), cut_text(text_at(entry, "class"), kLongestClass),
           std::move(marks)};
  for (const std::string_view column : kColumns) row.push_back(number_at(entry, column));
  return row;
}

Json details_of(const Json& entry, const Journal& journal, const Json& kinds) {
  Details details;
  if (!kinds.empty()) details.json()["overlays"] = kinds;
  if (const auto resumed = entry.find("resumed"); resumed != entry.end() && *resumed == true)
    details.json()["resumed"] = true;
  const auto reasons = entry.find("reasons");
  if (reasons != entry.end() && reasons->is_array())
    details.add("reasons", reasons->size(), [&](std::size_t i) { return cut_json((*reasons)[i], kLongestText); });
  if (const std::string note = text_at(entry, "note"); !note.empty())
    details.json()["note"] = cut_text(note, kLongestNote);
  if (const auto extras = entry.find("extras"); extras != entry.end() && !extras->is_null())
    details.add("extras", 1, [&](std::size_t) { return cut_json(*extras, kLongestText); });
  const JournalStep* known = step_of(entry, journal);
  if (known == nullptr) return std::move(details.json());
  const JournalStep& step = *known;
  details.add("select", step.select.size(), [&](std::size_t i) { return cut_text(step.select[i], kLongestText); });
  const std::size_t frame = frame_in_step(entry);
  if (frame > 0 && frame <= step.frames())
    details.add_edit(step.edit_of(frame - 1));
  else if (frame == 0)
    details.add_edit(step.edit);  // none for the step of a drag or a wedge
  return std::move(details.json());
}

Json shown_head(const Json& head) {
  Json shown = Json::object();
  for (const char* key : {"program", "scene", "journal", "camera", "resolution", "samples", "noise", "options",
                          "machine", "full_render_seconds", "cache_bytes", "cache_damage", "interrupted"})
    shown[key] = head.contains(key) ? cut_json(head.at(key), kLongestText) : Json(nullptr);
  if (Json& journal = shown["journal"]; journal.is_object())
    if (const std::string note = text_at(head.at("journal"), "note"); !note.empty())
      journal["note"] = cut_text(note, kLongestNote);
  // Of where the journal is only the way there from the run: an URL (report/places.h).
  const Json::json_pointer place("/places/journal/0");
  shown["journal_url"] = head.contains(place) && head.at(place).is_string() ? head.at(place) : Json(nullptr);
  return shown;
}

}  // namespace relook
