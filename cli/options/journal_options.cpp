// The options of `relook journal` and its kinds, and of `relook schema`.
#include "options/shared_options.h"

namespace relook {
namespace {

constexpr std::uint32_t kMostTurns = 10000;  // frames

void add_turntable(CLI::App& journal, Arguments& arguments) {
  CLI::App& turntable = *journal.add_subcommand("turntable", "Nodes, or the environment, turned all the way round");
  add_inputs(turntable, arguments, "SCENE NODE", "Scene or cache, and a node or all; all", 1, 2);
  TurntableOptions& options = arguments.turntable;
  turntable.add_option("--frames", options.frames, "Frames of the turn; 24")->check(CLI::Range(1U, kMostTurns));
  turntable.add_option("--axis", options.axis, "Of the world: x, y or z; y")->check(CLI::IsMember({"x", "y", "z"}));
  turntable.add_option("--degrees", options.degrees, "Of the whole turn, counter-clockwise; 360")
      ->check(CLI::Range(-36000.0, 36000.0));
  turntable.add_option("--about", options.about, "bounds: the middle of what turns; origin: the scene's; bounds")
      ->check(CLI::IsMember({"bounds", "origin"}));
  turntable.add_flag("--environment", options.environment,
                     "Turn the environment, after the nodes, or alone where no node is named");
}

void add_aim(CLI::App& journal, Arguments& arguments) {
  CLI::App& aim = *journal.add_subcommand("aim", "A light or a node pointed at a target, and placed around it");
  add_inputs(aim, arguments, "SCENE NODE TARGET", "Scene or cache, a node or light, and a node or a point x,y,z", 3, 3);
  AimOptions& options = arguments.aim;
  aim.add_option("--azimuth", options.azimuth,
                 "Place it so many degrees round the target: 0 is the camera's side, 90 its right hand; as it is")
      ->check(CLI::Range(-36000.0, 36000.0));
  aim.add_option("--elevation", options.elevation, "Place it so many degrees above the target; as it is")
      ->check(CLI::Range(-90.0, 90.0));
  aim.add_option("--distance", options.distance, "Place it so many metres from the target; as it is")
      ->check(CLI::Range(1e-6, 1e6));
  aim.add_option("--orbit", options.orbit, "Frames of a drag once round the target; without: one edit")
      ->check(CLI::Range(1U, kMostTurns));
}

void add_rig(CLI::App& journal, Arguments& arguments) {
  CLI::App& rig = *journal.add_subcommand("rig", "Lights around a target: all of them, then each alone");
  add_inputs(rig, arguments, "SCENE", "Scene or cache", 1, 1);
  RigOptions& options = arguments.rig;
  rig.add_option("--style", options.style, "three-point, softboxes, rim or product; three-point")
      ->check(CLI::IsMember(std::vector<std::string>{kRigStyles.begin(), kRigStyles.end()}));
  rig.add_option("--target", options.target, "Node to light; all that is visible");
  rig.add_flag("--lamps", options.uses_lamps, "Spots in place of areas, which --integrator whitted does without");
  rig.add_flag("--replace", options.replaces, "Put out the scene's own lights and environment in the rig, too");
  rig.add_option("--level", options.level, "Value of a white surface that faces the strongest light; 0.8")
      ->check(CLI::Range(1e-6, 1e6));
}

}  // namespace

void add_journal(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& journal = *app.add_subcommand("journal", "Write a journal from what a scene or cache contains");
  journal.require_subcommand(1);
  CLI::App& diff = *journal.add_subcommand("diff", "The step between two exports of a scene");
  CLI::App& variants = *journal.add_subcommand("variants", "A step for each of the scene's material variants");
  CLI::App& animation = *journal.add_subcommand("animation", "A frame for each sample of an animation of the scene");
  CLI::App& wedge = *journal.add_subcommand("wedge", "A frame for each value of one parameter");
  add_inputs(diff, arguments, "A B", "Scene or cache, and the same edited", 2, 2);
  add_inputs(variants, arguments, "SCENE", "Scene or cache", 1, 1);
  add_inputs(animation, arguments, "SCENE", "glTF scene (.gltf or .glb); a cache has no animations", 1, 1);
  add_inputs(wedge, arguments, "SCENE POINTER VALUES",
             "Scene or cache, a parameter's path in its look document, values (JSON or names) or ranges A..B:N", 3,
             10000);
  SampleTimes& times = arguments.sample_times;
  animation.add_option("--fps", times.frames_per_second, "Frames a second; 24")->check(CLI::Range(1e-3, 1e4));
  animation.add_option("--from", times.from, "First time in seconds; the first keyframe's")
      ->check(CLI::Range(0.0, 1e6));
  animation.add_option("--to", times.to, "Last time in seconds; the last keyframe's")->check(CLI::Range(0.0, 1e6));
  animation.add_option("--animation", arguments.animation, "Name or number of the animation; the first");
  add_turntable(journal, arguments);
  add_aim(journal, arguments);
  add_rig(journal, arguments);
  for (CLI::App* source : journal.get_subcommands(nullptr)) {
    add_output(*source, arguments, "Journal to write")->required();
    source->add_option("--camera", arguments.view.camera, "Camera that the journal is for, which it cannot move");
    add_look_patch(*source, arguments);
    add_lights(*source, raw);
    add_import_rules(*source, arguments);
    add_common(*source, arguments, raw);
  }
}

void add_schema(CLI::App& app, Arguments& arguments, RawTexts& raw) {
  CLI::App& schema = *app.add_subcommand("schema", "Print the JSON Schema of journals or of report.json");
  schema.add_option("KIND", arguments.inputs, "journal or report")
      ->required()
      ->expected(1)
      ->check(CLI::IsMember({"journal", "report"}));
  CLI::Option* const scene = schema.add_option("--scene", arguments.scene,
                                               "Scene or cache that journals are for: its names and pointers alone");
  add_look_patch(schema, arguments)->needs(scene);
  add_lights(schema, raw)->needs(scene);
}

}  // namespace relook
