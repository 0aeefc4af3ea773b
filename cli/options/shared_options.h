// Options that several verbs take, and the way inputs and outputs are declared; see verb_options.h.
#pragma once
#include <CLI/CLI.hpp>

#include "options/verb_options.h"

namespace relook {

void add_common(CLI::App& verb, Arguments& arguments, RawTexts& raw);
/// Adds --root and --strict-gltf, for verbs that read scenes or journals.
void add_import_rules(CLI::App& verb, Arguments& arguments);
CLI::Option* add_look_patch(CLI::App& verb, Arguments& arguments,
                            const char* help = "JSON Patch (RFC 6902) applied to the look document first");
CLI::Option* add_lights(CLI::App& verb, RawTexts& raw, const char* help = "auto: add a key, a fill and a rim light");
CLI::Option* add_output(CLI::App& verb, Arguments& arguments, const char* help);
void add_inputs(CLI::App& verb, Arguments& arguments, const char* name, const char* help, int least, int most);

// verb_options.cpp
/// Adds the VIEW options but --look, and returns them.
std::vector<const CLI::Option*> add_view(CLI::App& verb, Arguments& arguments, RawTexts& raw);
void add_frame_options(CLI::App& verb, Arguments& arguments);

// scene_verbs.cpp
void add_export(CLI::App& app, Arguments& arguments, RawTexts& raw);
void add_watch(CLI::App& app, Arguments& arguments, RawTexts& raw);

// journal_options.cpp
void add_journal(CLI::App& app, Arguments& arguments, RawTexts& raw);
void add_schema(CLI::App& app, Arguments& arguments, RawTexts& raw);

}  // namespace relook
