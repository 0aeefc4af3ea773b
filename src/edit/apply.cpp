#include "edit/apply.h"

#include <algorithm>

#include "edit/transaction.h"
#include "scene/look/look_names.h"

namespace relook {
namespace {

/// The node that "/nodes/<name>/..." points into.
std::string node_of(const SceneState& state, const std::string& pointer, const PatchPlace& place, Tokens& tokens) {
  if (!pointer.empty()) tokens = split_pointer(pointer, place.file, place.where);
  if (tokens.size() < 2 || tokens[0] != "nodes")
    throw InputError(place.file, place.where, "a drag moves the nodes of its selection and nothing else");
  return resolve_token(state.document(), Section::nodes, tokens[1]);
}

}  // namespace

SceneDelta apply_edit(SceneState& state, const Edit& edit, std::string_view file, const std::filesystem::path& folder) {
  return Transaction(state, file, folder).apply(edit);
}

void check_drag_scope(const SceneState& state, const JournalStep& step, std::size_t entry, std::string_view file) {
  std::vector<std::string> selection;
  for (std::size_t i = 0; i < step.select.size(); ++i) {
    const PatchPlace place{file, step.where + "/select/" + std::to_string(i)};
    Tokens tokens;
    selection.push_back(node_of(state, step.select[i], place, tokens));
    if (!name_exists(state.document(), Target::nodes, selection.back()))
      throw InputError(file, place.where, missing_name(state.document(), Target::nodes, selection.back()));
  }
  for (const PatchOperation& operation : step.drag.at(entry)) {
    if (operation.op == PatchOp::test) continue;
    const bool has_from = operation.op == PatchOp::move || operation.op == PatchOp::copy;
    for (const char* key : {"/path", "/from"}) {
      if (key == std::string_view("/from") && !has_from) continue;
      const PatchPlace place{file, operation.where + key};
      Tokens tokens;
      const std::string node =
          node_of(state, key == std::string_view("/from") ? operation.from : operation.path, place, tokens);
      if (tokens.size() < 3 || tokens[2] == "children")
        throw InputError(file, place.where, "a drag neither adds nor removes nodes");
      std::string at = node;
      while (!at.empty() && std::find(selection.begin(), selection.end(), at) == selection.end())
        at = state.parent_of(at);
      if (at.empty()) throw InputError(file, place.where, "node \"" + node + "\" is not part of the selection");
    }
  }
}

}  // namespace relook
