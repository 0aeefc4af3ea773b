#include "inspect/inspect_journal.h"

#include <optional>
#include <utility>

#include "base/error.h"
#include "edit/apply.h"
#include "edit/journal_text.h"
#include "edit/journal_walk.h"
#include "edit/scene_history.h"
#include "input/open_look.h"
#include "options/outputs.h"
#include "report/edit_hashes.h"

namespace relook {
namespace {

Json step_json(const Journal& journal, std::uint32_t number) {
  const JournalStep& step = journal.steps[number - 1];
  Json selected = Json::array();
  for (const std::string& pointer : step.select) selected.push_back(pointer);
  return {{"step", number},
          {"name", step.name},
          {"operations", step.edit.size()},
          {"drag_frames", step.drag.size()},
          {"wedge_frames", step.wedge.size()},
          {"select", std::move(selected)},
          {"from", state_before(journal, number)},
          {"keep", step.keep},
          {"note", text_or_null(step.said.note)},
          {"author", text_or_null(step.said.author)},
          {"extras", step.said.extras}};
}

void add_classification(Json& entry, const Classification& classification) {
  entry["class"] = change_class_name(classification.change);
  entry["reasons"] = classification.reasons;
}

/// `words`: what is said of it beside its name.
void print_step(const Json& entry, const std::string& label, const std::string& words, Console& console) {
  std::string line = label + " \"" + printable(entry["name"].get<std::string>()) + "\"";
  line += words;
  if (!entry.contains("class")) {
    const std::size_t dragged = entry["drag_frames"].get<std::size_t>(),
                      wedge = entry["wedge_frames"].get<std::size_t>();
    line += dragged > 0 ? ": a drag of " + std::to_string(dragged) + " frames"
            : wedge > 0 ? ": a wedge of " + std::to_string(wedge) + " values"
                        : ": " + std::to_string(entry["operations"].get<std::size_t>()) + " operations";
    console.line(line);
    return;
  }
  console.line(line + ": " + entry["class"].get<std::string>());
  for (const Json& reason : entry["reasons"]) console.line("  " + printable(reason.get<std::string>()));
}

/// `inspect --json`, written as it grows: a journal may have a million frames.
class JsonOutput {
 public:
  JsonOutput(const Journal& journal, bool is_wanted, Console& console) : console_(console), is_wanted_(is_wanted) {
    std::string head = json_text({{"hash", journal.hash}, {"journal", journal.file}}, 2);
    head.resize(head.rfind('\n'));
    print(head + ",\n  \"steps\": [");
  }
  void add(const Json& entry) {
    if (!is_wanted_) return;
    std::string text = is_empty_ ? "\n    " : ",\n    ";
    for (const char c : json_text(entry, 2)) {
      text += c;
      if (c == '\n') text += "    ";
    }
    print(text);
    is_empty_ = false;
  }
  void end() { print(is_empty_ ? "]\n}\n" : "\n  ]\n}\n"); }

 private:
  void print(const std::string& text) {
    if (is_wanted_) console_.print(text);
  }

  Console& console_;
  bool is_wanted_, is_empty_ = true;
};

void list_steps(const Journal& journal, JsonOutput& output, Console& console) {
  for (std::uint32_t number = 1; number <= journal.steps.size(); ++number) {
    const Json entry = step_json(journal, number);
    print_step(entry, std::to_string(number), origin_text(journal, number), console);
    output.add(entry);
  }
}

/// Lists all frames of a journal, each with its class.
void list_frames(const Journal& journal, SceneState& state, JsonOutput& output, Console& console) {
  SceneHistory history(journal);
  follow_edits(JournalWalk(journal), [&](const JournalEvent& event) {
    console.check_interrupt();
    Json entry = step_json(journal, event.place.step);
    std::string label = std::to_string(event.place.step);
    if (event.place.number) {
      entry[event.step->form() == StepForm::drag ? "drag_frame" : "wedge_frame"] = *event.place.number;
      label += "." + std::to_string(*event.place.number);
    }
    if (event.step->form() == StepForm::wedge) entry["values"] = event.step->wedge.values_json(event.frame);
    add_classification(entry, apply_event(state, journal, event, history).classification);
    const std::string origin = event.is_first_frame() ? origin_text(journal, event.place.step) : "";
    print_step(entry, label, values_text(journal, event.place.step, event.frame) + origin, console);
    output.add(entry);
  });
}

}  // namespace

void inspect_journal(const Arguments& arguments, Console& console) {
  const Journal journal = read_journal(arguments.inputs[0], [&] { console.check_interrupt(); });
  require_not_outputs(arguments, files_of(journal), "a file of the journal");
  std::optional<SceneState> state;
  if (!arguments.scene.empty()) {
    state.emplace(open_look_state(arguments.scene, arguments, console));
    console.warn(check_journal(*state, journal));
  }
  JsonOutput output(journal, arguments.json, console);
  if (state)
    list_frames(journal, *state, output, console);
  else
    list_steps(journal, output, console);
  output.end();
}

}  // namespace relook
