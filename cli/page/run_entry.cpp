#include "page/run_entry.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::size_t kLongestName = 160, kLongestText = 400, kLongestClass = 20;  // bytes
constexpr std::size_t kMostParts = 64;                                             // of an array or object
constexpr int kDeepest = 8;
constexpr std::size_t kMostDetailBytes = 8192;  // of one entry

constexpr std::array<std::string_view, 34> kColumns{"/step",
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

/// The number at a pointer, seconds to four digits; null: there is none.
Json number_at(const Json& entry, std::string_view pointer) {
  const Json::json_pointer place{std::string(pointer)};
  if (!entry.contains(place)) return nullptr;
  const Json& value = entry.at(place);
  if (!value.is_number()) return nullptr;
  if (!value.is_number_float()) return value;
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value.get<double>());
  const double rounded = std::strtod(text, nullptr);
  return rounded == 0 ? Json(0) : Json(rounded);
}

std::string text_at(const Json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The place of an entry among the frames of a drag or wedge, from 1; 0: it is the step's own.
std::size_t frame_in_step(const Json& entry) {
  for (const char* kind : {"drag_frame", "wedge_frame"})
    if (const auto found = entry.find(kind); found != entry.end() && found->is_number_integer())
      return found->get<std::size_t>();
  return 0;
}

/// At most `most` bytes of a text, whole characters, with "…" where it was cut.
std::string cut_text(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "…";
}

/// A value with its long texts and lists cut.
Json cut(const Json& value, std::size_t longest, int depth = 0) {
  if (value.is_string()) return cut_text(value.get_ref<const std::string&>(), longest);
  if (!value.is_structured()) return value;
  if (depth == kDeepest) return "…";
  Json shorter = value.is_array() ? Json::array() : Json::object();
  std::size_t count = 0;
  for (const auto& [key, part] : value.items()) {
    if (++count > kMostParts) break;
    if (value.is_array())
      shorter.push_back(cut(part, longest, depth + 1));
    else
      shorter[cut_text(key, longest)] = cut(part, longest, depth + 1);
  }
  if (count > kMostParts) {
    const std::string more = "… " + std::to_string(value.size() - kMostParts) + " more";
    if (value.is_array())
      shorter.push_back(more);
    else
      shorter["…"] = more;
  }
  return shorter;
}

Json operation_json(const PatchOperation& operation) {
  constexpr const char* kNames[] = {"add", "remove", "replace", "move", "copy", "test"};
  Json json{{"op", kNames[static_cast<std::size_t>(operation.op)]}, {"path", cut_text(operation.path, kLongestText)}};
  if (!operation.from.empty()) json["from"] = cut_text(operation.from, kLongestText);
  if (operation.op == PatchOp::add || operation.op == PatchOp::replace || operation.op == PatchOp::test)
    json["value"] = cut(operation.value, kLongestText);
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

std::string stem_of(const Json& entry, std::size_t i) {
  const std::string frame = text_at(entry, "frame"), preview = text_at(entry, "preview");
  const std::string stem = std::filesystem::path(frame).stem().string();
  const bool is_numbered = !stem.empty() && stem.size() <= 40 && stem.find_first_not_of("0123456789_") == stem.npos;
  if (!is_numbered || frame != "frames/" + stem + ".exr" || preview != "previews/" + stem + ".png")
    throw InputError("report.json", "/steps/" + std::to_string(i), "names no frame and preview of its run");
  return stem;
}

Json row_of(const Json& entry, const std::string& stem) {
  Json row{stem, frame_in_step(entry) > 0 ? 1 : 0, cut_text(text_at(entry, "name"), kLongestName),
           cut_text(text_at(entry, "class"), kLongestClass)};
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
    details.add("reasons", reasons->size(), [&](std::size_t i) { return cut((*reasons)[i], kLongestText); });
  const Json number = number_at(entry, "/step");
  const std::size_t place = number.is_number_integer() ? number.get<std::size_t>() : 0;
  if (place == 0 || place > journal.steps.size()) return std::move(details.json());
  const JournalStep& step = journal.steps[place - 1];
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
    shown[key] = head.contains(key) ? cut(head.at(key), kLongestText) : Json(nullptr);
  return shown;
}

}  // namespace relook
