// Modules of ours that are loaded when first needed, because the libraries behind them are slow to load or seldom used.
#pragma once

namespace relook {

/// A function that a module exports: from the program's folder or, installed, ../lib/relook. The module stays loaded.
/// Throws Error when it is missing, "PURPOSE" being what cannot be done then ("decode images").
[[nodiscard]] void* module_function(const char* module, const char* function, const char* purpose);

/// Whether the module's file is there.
[[nodiscard]] bool has_module(const char* module);

}  // namespace relook
