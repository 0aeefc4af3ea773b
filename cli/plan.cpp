// `relook plan`: the class, samples, seconds and bytes of each frame that a replay will have, without replaying it.
#include "replay/plan.h"

#include <algorithm>
#include <cstdio>

#include "cache/manifest.h"
#include "edit/apply.h"
#include "edit/journal_text.h"
#include "input/load_cache.h"
#include "options/outputs.h"
#include "report/edit_hashes.h"
#include "run/step_text.h"
#include "verbs.h"

namespace relook {
namespace {

Json frame_json(const PlannedFrame& frame) {
  return {{"step", frame.place.step},
          {"name", frame.name},
          {"from", frame.from},
          {"frame", frame_name(frame.place)},
          {"class", change_class_name(frame.classification.change)},
          {"reasons", frame.classification.reasons},
          {"samples_affected", frame.samples_affected},
          {"pixels_changed", frame.pixels_changed},
          {"seconds", frame.seconds},
          {"resident_bytes", frame.resident_bytes}};
}

void print(const Journal& journal, const PlannedFrame& frame, std::uint64_t samples, Console& console) {
  const std::size_t number = frame.place.number.value_or(1) - 1;
  std::string words = frame.is_whole_step ? "" : values_text(journal, frame.place.step, number);
  if (number == 0) words += origin_text(journal, frame.place.step);
  char numbers[128];
  std::snprintf(numbers, sizeof numbers, ": %llu samples (%.2f %%), %llu pixels, %.4f s, %.1f M",
                static_cast<unsigned long long>(frame.samples_affected),
                100 * static_cast<double>(frame.samples_affected) / static_cast<double>(samples),
                static_cast<unsigned long long>(frame.pixels_changed), frame.seconds,
                static_cast<double>(frame.resident_bytes) / (1 << 20));
  console.line((frame.is_whole_step ? std::to_string(frame.place.step) : step_label(frame.place)) + " " +
               std::string(change_class_name(frame.classification.change)) + " \"" + printable(frame.name) + "\"" +
               words + numbers);
}

}  // namespace

ExitCode run_plan(const Arguments& arguments, Console& console) {
  const std::string& cache = arguments.inputs[0];
  const Journal journal = read_journal(arguments.inputs[1], [&] { console.check_interrupt(); });
  require_not_outputs(arguments, files_of(journal), "a file of the journal");
  const CacheContent content = load_mended_cache(cache);
  const ViewOptions& view = content.image.view;
  {
    LookDocument document = content.document;
    document.assets = std::make_shared<Assets>(*document.assets);
    SceneState state(std::move(document), content.camera, content.pyramids, view.integrator);
    console.warn(check_journal(state, journal));
  }
  const Plan plan =
      plan_replay(content.document, content.camera, content.pyramids, view, journal, console.stage("planning"));
  console.end_stage();
  Json frames = Json::array();
  double seconds = 0;
  std::uint64_t most_bytes = 0;
  for (const PlannedFrame& frame : plan.frames) {
    print(journal, frame, plan.samples_total, console);
    frames.push_back(frame_json(frame));
    seconds += frame.seconds;
    most_bytes = std::max(most_bytes, frame.resident_bytes);
  }
  const Json result{{"relook", "plan/1"},
                    {"cache", cache},
                    {"journal", journal.file},
                    {"samples_total", plan.samples_total},
                    {"samples", view.samples},
                    {"noise", content.manifest->noise ? Json(*content.manifest->noise) : Json()},
                    {"proxy", {plan.proxy_width, plan.proxy_height}},
                    {"seconds", seconds},
                    {"most_resident_bytes", most_bytes},
                    {"frames", std::move(frames)}};
  char total[96];
  const auto frame_count =
      static_cast<std::size_t>(std::ranges::count(plan.frames, false, &PlannedFrame::is_whole_step));
  std::snprintf(total, sizeof total, "%zu frames: %.3f s without writing, at most %.1f M resident", frame_count,
                seconds, static_cast<double>(most_bytes) / (1 << 20));
  console.line(total + (", " + std::to_string(view.samples)) + " samples a pixel" +
               noise_text(content.manifest->noise));
  if (!arguments.json_file.empty()) write_file(arguments.json_file, json_text(result, 2) + "\n");
  console.json(result);
  return ExitCode::ok;
}

}  // namespace relook
