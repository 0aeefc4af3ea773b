#include "edit/guide/journal_schema.h"

#include <map>
#include <vector>

#include "edit/guide/field_schema.h"
#include "scene/look/look_check.h"
#include "scene/look/look_names.h"
#include "scene/look/look_paths.h"

namespace relook {
namespace {

constexpr std::string_view kAnyName = "[^/]+";
constexpr std::string_view kIndex = "[0-9]{1,9}", kWildcard = R"([^/]*\*[^/]*)";
/// glTF's own place of lights means the same.
constexpr std::string_view kLightPlace = "(/extensions/(KHR_lights_punctual|EXT_lights_area))?";

Json text_schema(std::string_view description) { return {{"type", "string"}, {"description", description}}; }
Json reference(const std::string& definition) { return {{"$ref", "#/$defs/" + definition}}; }
Json whole(const std::string& pattern) { return {{"type", "string"}, {"pattern", "^" + pattern + "$"}}; }
Json needs(std::string_view key) { return {{"required", {key}}}; }
Json condition(Json when, Json then) { return {{"if", std::move(when)}, {"then", std::move(then)}}; }

std::string joined(const std::vector<std::string>& alternatives) {
  std::string text;
  for (const std::string& alternative : alternatives) text += (text.empty() ? "" : "|") + alternative;
  return text;
}

/// The names of a section, or none where there are too many.
std::vector<std::string> listed_names(const LookDocument* document, Section section) {
  std::vector<std::string> names;
  if (document == nullptr) return names;
  for (const auto& item : document->look.at(std::string(section_name(section))).items()) names.push_back(item.key());
  if (names.size() > kMostListedNames) names.clear();
  return names;
}
bool are_listed(const LookDocument* document, Section section) {
  return document != nullptr && document->look.at(std::string(section_name(section))).size() <= kMostListedNames;
}

/// The parts of a journal's schema, with the names of a scene or for any names.
class JournalSchema {
 public:
  /// `suffix`: of definitions, "" or "OfScene".
  JournalSchema(const LookDocument* document, std::string suffix, Json& definitions)
      : document_(document),
        suffix_(std::move(suffix)),
        definitions_(definitions),
        fields_([this](Target target) { return name_schema(target); }) {}

  /// Defines a step; returns a reference to it.
  Json step(const Json& pointers) {
    gather_places();
    Json any_pointer = whole("(" + joined(patterns_) + ")?");
    if (!pointers.empty()) any_pointer = {{"anyOf", {{{"enum", pointers}}, std::move(any_pointer)}}};
    define("pointer", std::move(any_pointer));
    define("operation", operation());
    define("edit", {{"type", "array"}, {"items", own_ref("operation")}, {"description", "RFC 6902 operations"}});
    define("axis", axis());
    define("step", step_body());
    for (const auto& [name, body] : fields_.definitions().items()) define(name, renamed(body));
    return own_ref("step");
  }

 private:
  void define(const std::string& name, Json body) { definitions_[name + suffix_] = std::move(body); }
  [[nodiscard]] Json own_ref(const std::string& name) const { return reference(name + suffix_); }

  /// References of FieldSchemas with the suffix.
  [[nodiscard]] Json renamed(Json schema) const {
    if (schema.is_object() && schema.contains("$ref")) {
      schema["$ref"] = schema["$ref"].get<std::string>() + suffix_;
      return schema;
    }
    if (schema.is_structured())
      for (Json& part : schema) part = renamed(std::move(part));
    return schema;
  }

  [[nodiscard]] Json name_schema(Target target) const {
    const Json any{{"type", {"string", "integer"}}};
    if (target >= Target::cameras || !are_listed(document_, static_cast<Section>(target))) return any;
    return {{"anyOf",
             {{{"enum", listed_names(document_, static_cast<Section>(target))}},
              {{"type", "integer"}, {"minimum", 0}, {"description", "glTF's index"}}}}};
  }

  /// A regular expression for one token: the name of an entity.
  [[nodiscard]] std::string name_pattern(Section section) const {
    if (!are_listed(document_, section)) return std::string(kAnyName);
    std::vector<std::string> names{std::string(kIndex), std::string(kWildcard)};
    for (const std::string& name : listed_names(document_, section))
      names.push_back(quoted_pattern(escape_token(name)));
    return "(" + joined(names) + ")";
  }

  void gather_places() {
    for (std::size_t s = 0; s < kSectionCount; ++s) {
      const auto section = static_cast<Section>(s);
      Json extra = Json::object();
      if (section == Section::nodes) extra["asset"] = text_schema("A glTF file below the journal's folder");
      const std::string noun(target_noun(static_cast<Target>(s)));
      const Json entity = fields_.of_object(noun, schema_of(section), extra);
      const std::string start =
          (section == Section::lights ? std::string(kLightPlace) : "") + "/" + std::string(section_name(section));
      add_rule(start, {{"type", "object"}, {"additionalProperties", entity}});
      add_rule(start + "/" + std::string(kAnyName), entity);
      std::string below = places_below(start + "/" + std::string(kAnyName), schema_of(section));
      if (section == Section::nodes) below += "|/asset";
      patterns_.push_back(start + "(/" + name_pattern(section) + "(" + below + ")?)?");
    }
    add_rule("/scene", fields_.of_object("scene", scene_schema()));
    patterns_.push_back("/scene(" + places_below("/scene", scene_schema()) + ")?");
    patterns_.push_back("/extensions(" + places_below("/extensions", extensions_schema()) + ")?");
  }

  /// Adds the rules of all places below an object. Returns a pattern for what follows its pointer.
  std::string places_below(const std::string& start, const Schema& schema) {
    std::vector<std::string> patterns;
    for_each_place_below(schema, fields_, [&](const std::string& pattern, const Json& value) {
      patterns.push_back(pattern);
      add_rule(start + pattern, value);
    });
    return joined(patterns);
  }

  void add_rule(const std::string& pattern, const Json& value) { rules_[renamed(value).dump()].push_back(pattern); }

  [[nodiscard]] Json operation() const {
    const auto op_is = [](const Json& words) {
      return Json{{"properties", {{"op", {{"enum", words}}}}}, {"required", {"op"}}};
    };
    Json all = {condition(op_is({"add", "replace", "test"}), needs("value")),
                condition(op_is({"move", "copy"}), {{"required", {"from"}}, {"properties", {{"value", false}}}}),
                condition(op_is({"remove"}), {{"properties", {{"value", false}}}}),
                condition(op_is({"add", "replace", "remove", "test"}), {{"properties", {{"from", false}}}})};
    for (const auto& [value, patterns] : rules_)
      all.push_back(condition(
          {{"properties", {{"path", whole("(" + joined(patterns) + ")")}, {"op", {{"enum", {"add", "replace"}}}}}},
           {"required", {"op", "path"}}},
          {{"properties", {{"value", Json::parse(value)}}}}));
    return {{"type", "object"},
            {"required", {"op", "path"}},
            {"additionalProperties", false},
            {"properties",
             {{"op", {{"enum", {"replace", "add", "remove", "move", "copy", "test"}}}},
              {"path", own_ref("pointer")},
              {"from", own_ref("pointer")},
              {"value", true}}},
            {"allOf", std::move(all)}};
  }

  [[nodiscard]] Json axis() const {
    const Json numbers{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 1}, {"maxItems", 16}};
    const Json end{{"anyOf", {{{"type", "number"}}, numbers}}};
    const Json range{
        {"type", "object"},
        {"required", {"from", "to"}},
        {"additionalProperties", false},
        {"properties",
         {{"from", end},
          {"to", end},
          {"count", {{"type", "integer"}, {"minimum", 2}, {"description", "Of values, both ends included"}}},
          {"step", {{"type", "number"}, {"description", "From one value to the next; with scale log a factor"}}},
          {"scale", {{"enum", {"linear", "log", "step"}}}}}},
        {"oneOf", {needs("count"), needs("step")}}};
    Json all = Json::array();
    for (const auto& [value, patterns] : rules_) {
      const Json schema = Json::parse(value);
      all.push_back(condition(
          {{"properties", {{"path", whole("(" + joined(patterns) + ")")}}}, {"required", {"path"}}},
          {{"properties", {{"values", {{"items", schema}}}, {"range", {{"properties", {{"from", schema}}}}}}}}));
    }
    return {{"type", "object"},
            {"required", {"path"}},
            {"additionalProperties", false},
            {"properties",
             {{"path", own_ref("pointer")},
              {"label", text_schema("What the parameter is called")},
              {"values", {{"type", "array"}, {"minItems", 1}}},
              {"labels", {{"type", "array"}, {"items", {{"type", "string"}}}, {"description", "As many as values"}}},
              {"range", range}}},
            {"oneOf", {needs("values"), needs("range")}},
            {"allOf", std::move(all)}};
  }

  [[nodiscard]] Json step_body() const {
    const Json node = whole("/nodes/" + name_pattern(Section::nodes));
    const auto only = [](const Json& present, const Json& absent) {
      Json part{{"required", present}};
      for (const Json& key : absent) part["properties"][key.get<std::string>()] = false;
      return part;
    };
    return {
        {"type", "object"},
        {"additionalProperties", false},
        {"properties",
         {{"name", text_schema("What the step is called")},
          {"note", text_schema("Carried into report and frames")},
          {"author", text_schema("Carried into report and frames")},
          {"extras", {{"description", "Anything; carried into report and frames"}}},
          {"from",
           {{"type", {"string", "integer"}},
            {"minimum", 0},
            {"description",
             "Where the step starts: \"base\", or the name or number of an earlier step; without: the step before"}}},
          {"keep", {{"type", "boolean"}, {"description", "Of a wedge or drag: false puts back what it changed"}}},
          {"edit", own_ref("edit")},
          {"select", {{"type", "array"}, {"minItems", 1}, {"uniqueItems", true}, {"items", node}}},
          {"drag", {{"type", "array"}, {"minItems", 1}, {"items", own_ref("edit")}, {"description", "A frame each"}}},
          {"wedge",
           {{"description", "Values of one parameter, a frame each; two axes are a grid"},
            {"anyOf",
             {own_ref("axis"), {{"type", "array"}, {"minItems", 1}, {"maxItems", 2}, {"items", own_ref("axis")}}}}}}}},
        {"oneOf",
         {only({"edit"}, {"select", "drag", "wedge", "keep"}), only({"select", "drag"}, {"edit", "wedge"}),
          only({"wedge"}, {"edit", "select", "drag"})}}};
  }

  const LookDocument* document_;
  std::string suffix_;
  Json& definitions_;
  FieldSchemas fields_;
  std::map<std::string, std::vector<std::string>> rules_;  // schema of a value -> patterns of its pointers
  std::vector<std::string> patterns_;                      // of all pointers
};

/// Pointers for editors to offer. Sections with the fewest come first; those that are too many are left out.
Json listed_pointers(const LookDocument& document) {
  std::map<std::string_view, Json> by_section;
  for_each_path(document, [&](const LookPath& path) {
    Json& pointers = by_section[path.section];
    if (pointers.is_null()) pointers = Json::array();
    if (pointers.size() <= kMostListedPointers) pointers.push_back(path.pointer);
  });
  std::vector<Json> sections;
  for (auto& [section, pointers] : by_section) sections.push_back(std::move(pointers));
  std::ranges::sort(sections, {}, &Json::size);
  Json all = Json::array();
  for (const Json& pointers : sections)
    if (all.size() + pointers.size() <= kMostListedPointers) all.insert(all.end(), pointers.begin(), pointers.end());
  return all;
}

/// Matches journals with an operation that may bring in a name.
Json brings_names() {
  std::string sections;
  for (std::size_t s = 0; s < kSectionCount; ++s)
    sections += (s == 0 ? "" : "|") + std::string(section_name(static_cast<Section>(s)));
  const Json operation{{"properties",
                        {{"op", {{"enum", {"add", "replace", "move", "copy"}}}},
                         {"path", whole("(" + std::string(kLightPlace) + "/(" + sections + ")(/[^/]*(/asset)?)?)?")}}},
                       {"required", {"op", "path"}}};
  const Json edit{{"type", "array"}, {"contains", operation}};
  const Json step{{"anyOf",
                   {{{"properties", {{"edit", edit}}}, {"required", {"edit"}}},
                    {{"properties", {{"drag", {{"type", "array"}, {"contains", edit}}}}}, {"required", {"drag"}}}}}};
  return {{"properties", {{"steps", {{"type", "array"}, {"contains", step}}}}}, {"required", {"steps"}}};
}

std::string comment(const LookDocument* document) {
  if (document == nullptr) return "Of any scene; relook schema journal --scene SCENE names those of one.";
  std::string text = "Names and pointers of " + printable(document->file) + ".";
  for (std::size_t s = 0; s < kSectionCount; ++s)
    if (!are_listed(document, static_cast<Section>(s)))
      text += " There are too many " + std::string(section_name(static_cast<Section>(s))) +
              " to list: any name is taken for one.";
  return text + " A journal that adds or renames an entity may use any name.";
}

}  // namespace

Json journal_schema(const LookDocument* document) {
  Json definitions = Json::object();
  const Json pointers = document == nullptr ? Json::array() : listed_pointers(*document);
  const auto steps_of = [](const Json& step) {
    return Json{{"properties", {{"steps", {{"type", "array"}, {"items", step}}}}}};
  };
  const Json any = steps_of(JournalSchema(nullptr, "", definitions).step(pointers));
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "relook journal/1"},
              {"$comment", comment(document)},
              {"type", "object"},
              {"required", {"relook", "steps"}},
              {"additionalProperties", false},
              {"properties",
               {{"relook", {{"const", "journal/1"}}},
                {"$schema", text_schema("Where this schema lies, for editors")},
                {"generated", text_schema("Written by relook journal")},
                {"note", text_schema("Carried into report and frames")},
                {"author", text_schema("Carried into report and frames")},
                {"extras", {{"description", "Anything; carried into report and frames"}}},
                {"steps", true}}}};
  if (document == nullptr)
    schema["allOf"] = Json::array({any});
  else
    schema.update(Json{{"if", brings_names()},
                       {"then", any},
                       {"else", steps_of(JournalSchema(document, "OfScene", definitions).step(pointers))}});
  schema["$defs"] = std::move(definitions);
  return schema;
}

}  // namespace relook
