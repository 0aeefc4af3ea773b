// Mutations of JSON that keep it JSON: values, keys and places out of choices.
#pragma once
#include "base/json.h"
#include "fuzz_case.h"

namespace relook {

/// Changes one value: sets it, removes it, puts it elsewhere, or adds a member.
void mutate_json(Json& root, Choices& choices);

}  // namespace relook
