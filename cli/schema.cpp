// `relook schema`: JSON Schemas of journals, of any scene or of one, and of report.json.
#include <algorithm>

#include "edit/guide/journal_schema.h"
#include "input/open_look.h"
#include "page/page_assets.h"
#include "verbs.h"

namespace relook {

ExitCode run_schema(const Arguments& arguments, Console& console) {
  if (arguments.inputs[0] == "report") {
    const auto found = std::ranges::find(page_assets(), "report.schema.json", &PageAsset::name);
    require(found != page_assets().end(), "the schema of reports is built in");
    console.print(std::string(found->text()));
    return ExitCode::ok;
  }
  if (arguments.scene.empty()) {
    console.print(json_text(journal_schema(), 1) + "\n");
    return ExitCode::ok;
  }
  const SceneState state = open_look_state(arguments.scene, arguments, console);
  console.print(json_text(journal_schema(&state.document()), 1) + "\n");
  return ExitCode::ok;
}

}  // namespace relook
