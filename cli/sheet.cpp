// `relook sheet`: the frames of a run on one contact sheet, with names and values: a grid keeps its rows and columns.
#include <algorithm>

#include "frame/frame_file.h"
#include "frame/sheet/contact_sheet.h"
#include "input/run_input.h"
#include "options/named_files.h"
#include "verbs.h"

namespace relook {
namespace {

std::string text_of_member(const Json& json, const char* key) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

const Json& list_member(const Json& json, const char* key) {
  static const Json kNone = Json::array();
  const auto found = json.is_object() ? json.find(key) : json.end();
  return json.is_object() && found != json.end() && found->is_array() ? *found : kNone;
}

/// What an axis or a value is of: its label, or the last words of its path.
std::string axis_name(const Json& axis) {
  const std::string label = text_of_member(axis, "label");
  if (!label.empty()) return label;
  const std::string path = text_of_member(axis, "path");
  const std::size_t last = path.find_last_of('/');
  if (last == std::string::npos || last == 0) return path;
  const std::string tail = path.substr(last + 1);
  const bool is_component = tail.find_first_not_of("0123456789") == std::string::npos;
  const std::size_t before = path.find_last_of('/', last - 1);
  return is_component && before != std::string::npos ? path.substr(before + 1) : tail;
}

std::vector<std::string> value_lines(const Json& entry) {
  std::vector<std::string> lines;
  for (const Json& value : list_member(entry, "values"))
    lines.push_back(axis_name(value) + ": " + text_of_member(value, "text"));
  return lines;
}

SheetAxis axis_of(const Json& axis) {
  SheetAxis shown{axis_name(axis), {}};
  for (const Json& text : list_member(axis, "texts"))
    shown.texts.push_back(text.is_string() ? text.get<std::string>() : "");
  return shown;
}

/// "3" of "frames/0003.exr", "3.02" of "frames/0003_02.exr".
std::string number_of(const Json& entry) {
  const std::string stem = std::filesystem::path(text_of_member(entry, "frame")).stem().string();
  const std::size_t begin = std::min(stem.find_first_not_of('0'), stem.size());
  std::string text = begin == stem.size() || stem[begin] == '_' ? "0" + stem.substr(begin) : stem.substr(begin);
  std::ranges::replace(text, '_', '.');
  return text;
}

class SheetOfRun {
 public:
  SheetOfRun(const Arguments& arguments, const RunInput& run, Console& console)
      : arguments_(arguments), run_(run), console_(console), is_preview_(is_preview_name(arguments.output)) {
    if (is_preview_) style_ = {display_view_of_environment(), arguments.own_exposure.value_or(run.exposure())};
    if (is_preview_ && run.view() != (style_.view ? style_.view->id() : ""))
      console.warn({run.folder().string() + ": its previews are of another display view: set $OCIO as it was then"});
  }

  [[nodiscard]] ContactSheet sheet();
  [[nodiscard]] std::size_t pictures() const { return pictures_; }
  [[nodiscard]] Bytes encoded(const Frame& drawn) const {
    if (is_preview_) return encode_displayed(drawn, style_);
    FrameMeta meta;
    meta.scene_hash = text_of_member(run_.head().at("scene"), "hash");
    meta.name = run_.name();
    meta.note = "contact sheet";
    return encode_exr(drawn, meta, PixelFormat::half);
  }

 private:
  [[nodiscard]] bool is_wanted(const Json& entry) const;
  [[nodiscard]] SheetPicture picture_of(const Json& entry);
  void add_step(const Json& entry);
  void add_numbered(const Json& entry);
  void end_numbered(const Json& entry);
  [[nodiscard]] std::vector<std::string> notes() const;

  const Arguments& arguments_;
  const RunInput& run_;
  Console& console_;
  bool is_preview_;
  PreviewStyle style_;
  ContactSheet sheet_;
  bool is_open_ = false;  // the last group is of a drag or wedge that has not ended
  std::size_t pictures_ = 0;
};

bool SheetOfRun::is_wanted(const Json& entry) const {
  if (!arguments_.steps) return true;
  const auto step = entry.at("step").get<std::uint32_t>();
  return step >= arguments_.steps->first && (!arguments_.steps->last || step <= *arguments_.steps->last);
}

SheetPicture SheetOfRun::picture_of(const Json& entry) {
  const std::filesystem::path file = run_.folder() / text_of_member(entry, "frame");
  Frame frame = decode_exr(file);
  if (is_preview_) frame = as_displayed(frame, style_);
  ++pictures_;
  return {scaled_down(frame, arguments_.sheet_width), number_of(entry) + "  " + text_of_member(entry, "name"),
          value_lines(entry)};
}

void SheetOfRun::add_step(const Json& entry) {
  if (sheet_.groups.empty() || !sheet_.groups.back().heading.empty()) sheet_.groups.emplace_back();
  sheet_.groups.back().pictures.push_back(picture_of(entry));
}

/// A frame of a drag or wedge, which has a group of its own.
void SheetOfRun::add_numbered(const Json& entry) {
  if (!is_open_) {
    sheet_.groups.emplace_back();
    const std::string number = number_of(entry);
    sheet_.groups.back().heading = number.substr(0, number.find('.')) + "  " + text_of_member(entry, "name");
    if (const std::string note = text_of_member(entry, "note"); !note.empty()) sheet_.groups.back().notes = {note};
    is_open_ = true;
  }
  SheetPicture picture = picture_of(entry);
  picture.name = number_of(entry);
  sheet_.groups.back().pictures.push_back(std::move(picture));
}

/// The step as a whole, behind its frames, says what its axes are.
void SheetOfRun::end_numbered(const Json& entry) {
  is_open_ = false;
  SheetGroup& group = sheet_.groups.back();
  const Json& axes = list_member(entry, "axes");
  if (axes.size() != 2) return;
  SheetGroup::Grid grid{axis_of(axes[0]), axis_of(axes[1])};
  if (grid.rows.texts.size() * grid.columns.texts.size() != group.pictures.size()) return;  // frames are missing
  for (SheetPicture& picture : group.pictures) picture.values.clear();
  group.grid = std::move(grid);
}

std::vector<std::string> SheetOfRun::notes() const {
  const Json& head = run_.head();
  const auto file_name = [&](const char* key) {
    return std::filesystem::path(text_of_member(head.value(key, Json()), "file")).filename().string();
  };
  std::string line = file_name("scene") + ", camera " + text_of_member(head, "camera");
  if (!is_preview_) line += ", linear";
  if (is_preview_ && style_.exposure != 0) line += ", " + exposure_text(style_.exposure) + " EV";
  std::vector<std::string> lines{line};
  const Json journal = head.value("journal", Json());
  const std::string note = text_of_member(journal, "note"), author = text_of_member(journal, "author");
  if (!note.empty() || !author.empty()) lines.push_back(note + (author.empty() ? "" : " \u2014 " + author));
  return lines;
}

ContactSheet SheetOfRun::sheet() {
  sheet_.title = run_.name();
  sheet_.notes = notes();
  sheet_.columns = arguments_.columns;
  const ReportEntries entries = run_.entries();
  const Progress progress = console_.stage("sheet");
  for (std::size_t i = 0; i < entries.count; ++i) {
    progress(static_cast<double>(i) / static_cast<double>(entries.count));
    const Json entry = entries.at(i);
    if (!is_wanted(entry)) continue;
    const bool is_numbered = entry.at("drag_frame").is_number() || entry.at("wedge_frame").is_number();
    if (is_numbered)
      add_numbered(entry);
    else if (is_open_)
      end_numbered(entry);
    else
      add_step(entry);
  }
  console_.end_stage();
  if (pictures_ == 0) throw UsageError("--steps: the run has no frame of these steps");
  return std::move(sheet_);
}

}  // namespace

ExitCode run_sheet(const Arguments& arguments, Console& console) {
  const std::vector<std::filesystem::path> runs = runs_at(arguments.inputs[0]);
  if (runs.size() > 1)
    throw UsageError(arguments.inputs[0], "is a folder of " + std::to_string(runs.size()) +
                                              " runs: a sheet is of one, like " + runs.front().string());
  const RunInput run(runs.front());
  SheetOfRun maker(arguments, run, console);
  const ContactSheet sheet = maker.sheet();
  const Frame drawn = draw_contact_sheet(sheet);
  write_file(arguments.output, maker.encoded(drawn));
  console.line(arguments.output + ": " + std::to_string(maker.pictures()) + " pictures, " +
               std::to_string(drawn.width) + "x" + std::to_string(drawn.height) + " pixels");
  console.json({{"sheet", printable(arguments.output)},
                {"pictures", maker.pictures()},
                {"width", drawn.width},
                {"height", drawn.height}});
  return ExitCode::ok;
}

}  // namespace relook
