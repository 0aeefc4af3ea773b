// Two exports of a scene as one step: what differs between their look documents, entity by entity, by name.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "edit/draft/journal_draft.h"

namespace relook {

/// An image, or geometry as .glb, that the step brings in, to be written below the journal's folder.
struct DraftFile {
  std::string name;  // relative to that folder
  std::shared_ptr<const Bytes> bytes;
};

struct DiffDraft {
  JournalDraft draft;
  std::vector<DraftFile> files;
};

/// The step after which `before` looks like `after`. `folder`: for files, relative to the journal's. Cameras and
/// variants, which no journal edits, are named in warnings. Throws InputError for what else it cannot say: instances
/// that differ, other inverse bind matrices of a skin, an image without content.
[[nodiscard]] DiffDraft draft_diff(const LookDocument& before, const LookDocument& after, const std::string& folder);

}  // namespace relook
