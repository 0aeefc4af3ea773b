// What replays cost when not everything is kept (paper 4.3): budgets and policies.
#pragma once
#include "setup.h"

namespace relook {

/// `options`: as for the other measures.
void print_budgets(const BenchOptions& options);

}  // namespace relook
