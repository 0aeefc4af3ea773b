// The options of verbs that follow a scene file: `export` writes one, `watch` waits for the next.
#include "options/shared_options.h"

namespace relook {

void add_export(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& verb = *app.add_subcommand("export", "Write a scene as a journal leaves it, as glTF");
  verb.add_option("INPUT", arguments.inputs, "glTF scene (.gltf or .glb), or cache")->required()->expected(1);
  verb.add_option("-o,--output", arguments.output, ".glb, or .gltf with files in a folder beside it")->required();
  verb.add_option("--journal", arguments.journal, "Edit the scene by this journal first; -: standard input");
  verb.add_option("--step", arguments.step, "Last step to apply; all")
      ->check(CLI::Range(0, 1000000))
      ->needs("--journal");
  verb.add_option("--look", arguments.view.look_patch, "JSON Patch (RFC 6902) applied to the look document first");
  verb.add_option("--camera", arguments.view.camera, "Camera that the journal is for, which it cannot move");
  verb.add_option("--lights", raw.lights, "auto: add a key, a fill and a rim light")->check(CLI::IsMember({"auto"}));
  verb.add_option("--integrator", raw.integrator, "That --lights auto are for; path")
      ->check(CLI::IsMember(std::vector<std::string>{kIntegratorWords.begin(), kIntegratorWords.end()}))
      ->needs("--lights");
}

void add_watch(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& verb = *app.add_subcommand("watch", "Replay each new export of a scene as a step of a journal");
  verb.add_option("SCENE", arguments.inputs, "glTF scene (.gltf or .glb) that is exported again and again")
      ->required()
      ->expected(1);
  verb.add_option("--cache", arguments.cache, "Cache of the scene as it is first; made where there is none")
      ->required();
  verb.add_option("-o,--output", arguments.output, "Run folder to write; its journal lies beside it, RUN.json")
      ->required();
  verb.add_option("--interval", arguments.watch.interval_seconds, "Seconds from look to look; 0.5")
      ->check(CLI::Range(0.05, 3600.0));
  verb.add_option("--exports", arguments.watch.most_exports, "End after so many exports; without: on a signal")
      ->check(CLI::Range(0, 1000000));
  add_look_patch(verb, arguments);
  add_view(verb, arguments, raw);
  add_frame_options(verb, arguments);
}

}  // namespace relook
