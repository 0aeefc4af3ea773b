// `relook blame`: which steps of a run changed a pixel, through which objects and lights.
#include <array>
#include <cstring>
#include <filesystem>
#include <span>

#include "edit/journal_walk.h"
#include "image/cached_image.h"
#include "input/load_cache.h"
#include "options/outputs.h"
#include "options/values.h"
#include "report/edit_hashes.h"
#include "report/pixel_history.h"
#include "report/places.h"
#include "report/report_file.h"
#include "verbs.h"

namespace relook {
namespace {

/// What a run was made from.
struct RunSource {
  std::string scene_hash;
  Journal journal;
  std::uint32_t steps = 0;  // of the journal that the run has done
  std::string cache;
};

/// A file or folder of the run: where the command line says; else the first that is there of where it was relative to
/// the run, where it was absolutely, and the report's own name for it. Throws InputError that names the option.
std::string find_part(const JsonView& report, const std::string& run, const std::string& given, const char* part,
                      const JsonView& name) {
  if (!given.empty()) return given;
  const std::optional<std::filesystem::path> place =
      find_place(run, report.value().value("places", Json::object()).value(part, Json()));
  if (place) return place->string();
  const std::string named = name.text();
  std::error_code error;
  if (std::filesystem::exists(named, error)) return named;
  throw InputError(run, "", "its " + std::string(part) + " \"" + printable(named) + "\" is not found; say --" + part);
}

RunSource read_run(const Arguments& arguments) {
  const std::string& run = arguments.inputs[0];
  const std::filesystem::path path = std::filesystem::path(run) / kReportName;
  const std::string file = path.string();
  const Bytes bytes = read_file(path);
  const Json report = parse_json(text_of(bytes), file);
  const JsonView view(report, file);
  if (view.at("relook").text() != "report/1") view.at("relook").fail("not a report that this program reads");
  RunSource source;
  source.scene_hash = view.at("scene").at("hash").text();
  source.cache = find_part(view, run, arguments.cache, "cache", view.at("cache"));
  source.journal = read_journal(find_part(view, run, arguments.journal, "journal", view.at("journal").at("file")));
  if (source.journal.hash != view.at("journal").at("hash").text())
    throw InputError(source.journal.file, "", "is not as it was when " + run + " was made");
  const JsonView steps = view.at("steps");
  steps.require_array();
  if (steps.size() > 0)
    source.steps = static_cast<std::uint32_t>(
        steps.at(steps.size() - 1).at("step").integer(0, static_cast<std::int64_t>(source.journal.steps.size())));
  return source;
}

Json color_json(const Rgba& color) { return {color.r, color.g, color.b, color.a}; }

std::string text(const Rgba& color) {
  char text[128];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g, %.6g)", static_cast<double>(color.r),
                static_cast<double>(color.g), static_cast<double>(color.b), static_cast<double>(color.a));
  return text;
}

void print_paths(const std::vector<std::string>& paths, Console& console) {
  for (const std::string& line : paths) console.line("    " + printable(line));
}

/// A cache's image as it was rendered, with the pixel's history from there.
std::unique_ptr<PixelHistory> open_pixel(const RunSource& source, std::uint32_t x, std::uint32_t y) {
  OpenedCache opened = open_cache(source.cache, true);
  const Frame& frame = opened.image.frame;
  if (opened.scene_hash != source.scene_hash) require_sound({CacheFault::other_scene, "", ""}, source.cache);
  if (x >= frame.width || y >= frame.height)
    throw UsageError("PIXEL: the image is " + std::to_string(frame.width) + "x" + std::to_string(frame.height) +
                     " pixels");
  auto history = std::make_unique<PixelHistory>(std::move(*opened.state), opened.image.view, x, y);
  const Rgba color = history->color();
  if (std::memcmp(&color, &frame.pixels[std::size_t{y} * frame.width + x], sizeof color) != 0)
    throw Error(ExitCode::damaged_cache, source.cache, "pixel " + std::to_string(x) + "," + std::to_string(y),
                "the cache's frame is not that of its scene; preprocess again");
  return history;
}

class Blame {
 public:
  Blame(PixelHistory& pixel, Console& console) : pixel_(pixel), console_(console), paths_(pixel.paths()) {
    console_.line("before any step: " + text(pixel.color()));
    print_paths(paths_, console_);
  }

  void run(const Journal& journal, std::uint32_t steps) {
    SceneHistory history(journal);
    follow_edits(JournalWalk(journal, 1, steps), [&](const JournalEvent& event) {
      console_.check_interrupt();
      if (event.back_to) {
        static_cast<void>(pixel_.step([&](SceneState& state) {
          return EditedScene{go_back(state, journal, event, history), {}};
        }));
        paths_ = pixel_.paths();
      }
      const PixelStep result =
          pixel_.step([&](SceneState& state) { return make_edit(state, journal, event, history); });
      if (result.is_changed) note(event.place, event.step->name, result);
    });
  }
  [[nodiscard]] Json found() { return std::move(found_); }

 private:
  void note(const FramePlace& place, const std::string& name, const PixelStep& result) {
    const std::string change(change_class_name(result.classification.change));
    console_.line(step_label(place) + " " + change + " \"" + printable(name) + "\": " + text(result.before) + " -> " +
                  text(result.after));
    Json causes = Json::array();
    for (const std::string& cause : result.causes) {
      causes.push_back(printable(cause));
      console_.line("  " + printable(cause));
    }
    if (pixel_.paths() != paths_) print_paths(pixel_.paths(), console_);
    paths_ = pixel_.paths();
    Json entry{{"step", place.step},
               {"name", name},
               {"class", change},
               {"frame", frame_name(place)},
               {"before", color_json(result.before)},
               {"after", color_json(result.after)},
               {"causes", causes},
               {"paths", paths_}};
    found_.push_back(std::move(entry));
  }

  PixelHistory& pixel_;
  Console& console_;
  std::vector<std::string> paths_;
  Json found_ = Json::array();
};

}  // namespace

ExitCode run_blame(const Arguments& arguments, Console& console) {
  const auto [x, y] = parse_pixel("PIXEL", arguments.inputs[1]);
  const RunSource source = read_run(arguments);
  const std::array<std::filesystem::path, 2> parts{source.journal.path, source.cache};
  require_not_outputs(arguments, parts, "a part of the run");
  require_not_outputs(arguments, files_of(source.journal), "a file of the journal");
  const std::unique_ptr<PixelHistory> pixel = open_pixel(source, x, y);
  const Rgba color = pixel->color();
  const std::vector<std::string> paths = pixel->paths();
  Blame blame(*pixel, console);
  blame.run(source.journal, source.steps);
  const Json found = blame.found();
  console.line(std::to_string(found.size()) + " frames changed pixel " + arguments.inputs[1]);
  console.json({{"run", arguments.inputs[0]},
                {"pixel", {x, y}},
                {"base", color_json(color)},
                {"paths", paths},
                {"changes", found}});
  return ExitCode::ok;
}

}  // namespace relook
