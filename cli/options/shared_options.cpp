#include "options/shared_options.h"

namespace relook {

void add_common(CLI::App& verb, Arguments& arguments, RawTexts& raw) {
  verb.add_option("--threads", arguments.threads, "Threads to use; 0: all")->check(CLI::Range(0, 1024));
  verb.add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  if (verb.get_name() == "compare" || verb.get_name() == "plan")
    verb.add_flag("--json{-}", raw.json, "Print results as one JSON object; =FILE writes it there");
  else
    verb.add_flag("--json", arguments.json, "Print results as one JSON object");
  verb.add_option("--progress", raw.progress, "auto, plain, json, openjd or none")
      ->type_name("{auto,plain,json,openjd,none}");
  verb.add_flag("--log-json", arguments.log_json, "Warnings, errors and progress on stderr as one JSON object a line");
  verb.add_flag("--overwrite", arguments.overwrite,
                "Replace another run or cache, or another file, that is where the output goes; never an input");
  verb.add_option("--import-memory", raw.import_memory,
                  "Most memory that scenes' and caches' images and geometry may unpack to, like 4G; 2G");
  verb.add_option("--trace", arguments.trace, "File to write: what took how long, for Perfetto (Chrome trace events)");
}

void add_import_rules(CLI::App& verb, Arguments& arguments) {
  verb.add_option("--root", arguments.import.roots,
                  "Folder whose files scenes and journals may name, like a library of textures; may be repeated")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR")
      ->allow_extra_args(false);
  verb.add_flag(
      "--strict-gltf", arguments.import.is_strict,
      "Refuse what is against the glTF specification, also where it has one plain meaning or nothing uses it");
}

CLI::Option* add_look_patch(CLI::App& verb, Arguments& arguments, const char* help) {
  return verb.add_option("--look", arguments.view.look_patch, help);
}

CLI::Option* add_lights(CLI::App& verb, RawTexts& raw, const char* help) {
  return verb.add_option("--lights", raw.lights, help)->check(CLI::IsMember({"auto"}));
}

CLI::Option* add_output(CLI::App& verb, Arguments& arguments, const char* help) {
  return verb.add_option("-o,--output", arguments.output, help);
}

void add_inputs(CLI::App& verb, Arguments& arguments, const char* name, const char* help, int least, int most) {
  verb.add_option(name, arguments.inputs, help)->required()->expected(least, most);
}

}  // namespace relook
