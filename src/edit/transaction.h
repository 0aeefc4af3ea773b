// Edits of a look document, each all or nothing: operations in place, with the earlier value of every entry they touch,
// so that the price follows from the edit. Several edits may be made in one transaction, to be taken back together:
// an entry that all of them touch is kept once. Used by apply_edit and by the rehearsal of a journal.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "edit/growth.h"
#include "edit/journal.h"
#include "edit/patch.h"
#include "scene/compile/state.h"
#include "scene/look/look_schema.h"

namespace relook {

/// Entries of a look document and their values; none: no such entry.
using EntryValues = std::vector<std::pair<TouchedEntity, std::optional<Json>>>;

/// The value of an entry: of a section's, or of what has no sections ("scene", ""). Null: there is none.
[[nodiscard]] const Json* find_entry(const Json& look, const TouchedEntity& entity);

class Transaction {
 public:
  Transaction(SceneState& state, std::string_view file, std::filesystem::path folder);

  /// Applies an edit. On InputError document and assets are as before the first edit of this transaction, and the
  /// scene as before this edit; undo() takes back what earlier edits did to the scene.
  SceneDelta apply(const Edit& edit);
  /// Gives entries the values that they had in an earlier state of this document.
  SceneDelta restore(const EntryValues& values);
  /// Takes back all that was applied: document, assets and scene get their earlier values.
  void undo();
  /// Whether the edits that were applied left any entry of the document other than it was.
  [[nodiscard]] bool has_changes();
  /// Calls `visit` for each entry that was touched, single entries of whole sections, with its value before (null:
  /// none).
  void visit_touched(const std::function<void(const TouchedEntity&, const Json*)>& visit) const;
  /// From now on what `earlier` has copied counts against what a journal may copy, too.
  void count_after(const Transaction& earlier) { copied_before_ = earlier.copied_; }
  /// Takes over a transaction that came after this one: undo() takes back both.
  void absorb(Transaction&& later);

 private:
  /// An operation with its pointers resolved: names for indices, aliases replaced.
  struct Resolved {
    const PatchOperation* operation;
    Tokens path, from;
  };

  // transaction.cpp
  void run(const PatchOperation& operation, std::vector<Resolved>& done);
  [[nodiscard]] Tokens resolve(const std::string& pointer, const PatchPlace& place) const;
  void run(Resolved& resolved);
  /// What a replace overwrites. A member that its schema marks as unwritten (scene/look/look_schema.h: light range,
  /// attenuation distance, texture mapping) is created as null if the document omits it, together with the plain
  /// objects it lies in, although RFC 6902 4.3 wants it to exist; "remove", "test" and "from" keep to the RFC.
  [[nodiscard]] Json& replaced_value(const Tokens& path, const PatchPlace& place);
  /// Counts a value that is to be copied to `to` ("/nodes" and below) against what a copy may make.
  void count_copy(const Json& value, const Tokens& to, const PatchPlace& place);
  void touch(const Tokens& tokens);
  void touch(const TouchedEntity& entity);
  void note_section(const std::string& section);
  void note(const TouchedEntity& entity);
  void normalize(const Resolved& resolved);
  void normalize_entity(const TouchedEntity& entity, const Resolved& resolved);
  void restore_document();
  void give_up();
  [[noreturn]] void rethrow(const LookError& error, const std::vector<Resolved>& done) const;
  [[nodiscard]] Json* find(const TouchedEntity& entity);
  [[nodiscard]] LookDocument& document() { return state_.editable_document(); }

  // test_operation.cpp
  void run_test(const Resolved& resolved, const PatchPlace& place);
  [[nodiscard]] Json named_value(const Resolved& resolved);

  // node_edits.cpp: what adding, removing, renaming and copying a node means for the nodes around it.
  void remove_node(const std::string& name);
  void rename_node(const std::string& from, const std::string& to);
  void copy_descendants(const std::string& copy, const PatchPlace& place);
  [[nodiscard]] std::string current_parent(const std::string& node);
  void replace_excluded(const std::string& node, const std::string& by);
  void replace_joint(const std::string& joint, const std::string& by);
  void replace_mention(const std::string& parent, const std::string& child, const std::string& by);

  // asset_edits.cpp: files that an edit brings in.
  void load_image(const std::string& name, const PatchPlace& place);
  std::string keep_image(std::shared_ptr<const Bytes> bytes);
  void merge_asset(const std::string& node, const PatchPlace& place);
  void add_entry(const std::string& section, const std::string& name, Json value);

  SceneState& state_;
  std::string file_;
  std::filesystem::path folder_;

  std::set<TouchedEntity> touched_;          // by the present edit
  std::set<std::string> touched_nodes_;      // of these the nodes that it has not removed since
  std::set<TouchedEntity> touched_earlier_;  // by those before it in this transaction
  std::set<TouchedEntity> saved_;  // those that before_ has
  EntryValues before_;             // in the order of touching
  Extent copied_before_, copied_;          // by "copy", in earlier transactions and in this one
  std::map<TouchedEntity, Extent> grown_;  // entries that copies were made into, as they are then
  std::size_t mesh_count_;
  std::vector<std::string> new_geometry_, new_images_, new_instances_, new_inverse_binds_;
};

}  // namespace relook
