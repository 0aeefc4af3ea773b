// An animation sampled into steps: the paper's animated sequences, seen by a fixed camera.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "edit/draft/journal_draft.h"
#include "edit/patch.h"
#include "scene/look/look_names.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

constexpr double kMostAnimationFrames = 10'000;
constexpr double kMostAnimatedValues = 300'000;  // frames times channels: operations of the journal

/// A channel with the property of the look document that it animates.
struct Track {
  const AnimationChannel* channel = nullptr;
  Tokens path;
  const SchemaField* field = nullptr;
  Json last;  // what the property is after the frames so far; null: absent
  bool is_clamped = false;
};

bool is_node_transform(const Tokens& path) {
  return path.size() == 3 && path[0] == "nodes" &&
         (path[2] == "translation" || path[2] == "rotation" || path[2] == "scale");
}

bool is_morph(const Tokens& path) { return path.size() == 3 && path[0] == "nodes" && path[2] == "weights"; }

/// The node of the active camera or one above it.
bool holds_camera(const SceneState& state, const std::string& node) {
  for (std::string at = state.scene().camera.node; !at.empty(); at = state.parent_of(at))
    if (at == node) return true;
  return false;
}

/// The path in the look document of a pointer into the glTF document: entities have names there instead of indices, and
/// the lights of both extensions stand in /lights.
Tokens look_path(const LookDocument& document, Tokens tokens) {
  resolve_light_place(document, tokens);
  if (const auto section = section_of(tokens[0]); section && tokens.size() > 1)
    tokens[1] = resolve_token(document, *section, tokens[1]);
  return tokens;
}

/// Why no journal can express the channel; "" if one can. Fills `track`.
std::string obstacle(const SceneState& state, const AnimationChannel& channel, Track& track) {
  const LookDocument& document = state.document();
  track.channel = &channel;
  track.path = look_path(document, split_pointer(channel.pointer, document.file, channel.where));
  const auto section = section_of(track.path[0]);
  if (!section || track.path.size() < 3) return "journals do not edit it";
  const std::string entity = std::string(target_noun(static_cast<Target>(*section))) + " \"" + track.path[1] + "\"";
  const Json& entities = document.look[track.path[0]];
  if (!entities.contains(track.path[1])) return "the scene shows no " + entity;
  track.field = field_at(schema_of(*section), std::span(track.path).subspan(2));
  const bool is_numeric =
      track.field != nullptr && (track.field->kind == FieldKind::number || track.field->kind == FieldKind::reals ||
                                 track.field->kind == FieldKind::boolean);
  if (!is_numeric) return "journals do not edit it";
  if (*section == Section::nodes && holds_camera(state, track.path[1]) && track.path[2] != "extras")
    return entity + " holds the camera, which is fixed; another may be chosen with --camera";
  if (is_node_transform(track.path) && entities[track.path[1]].contains("matrix"))
    return entity + " has a matrix, which has no " + track.path[2];
  const Json::json_pointer place(pointer_text(track.path));
  if (document.look.contains(place))
    track.last = document.look[place];
  else if (!track.field->unwritten)
    return entity + " has no such value";
  const std::size_t width = track.field->kind != FieldKind::reals ? 1
                            : track.field->count == 0             ? track.last.size()
                                                                  : track.field->count;
  if (channel.width != width)
    throw InputError(
        document.file, channel.where,
        pointer_text(track.path) + " has " + std::to_string(width) + " numbers, not " + std::to_string(channel.width));
  return "";
}

/// The value at a time as JSON, inside the field's limits: a spline may overshoot them.
Json sampled(Track& track, double time) {
  const std::vector<double> numbers = value_at(*track.channel, time);
  if (track.field->kind == FieldKind::boolean) return numbers[0] != 0;
  Json value = Json::array();
  for (const double number : numbers) {
    const double inside = std::clamp(number, track.field->low, track.field->high);
    track.is_clamped = track.is_clamped || inside != number;
    value.push_back(short_real(static_cast<float>(inside)));
  }
  return track.field->kind == FieldKind::number ? value[0] : value;
}

Json edit_at(std::vector<Track>& tracks, double time) {
  Json edit = Json::array();
  for (Track& track : tracks) {
    Json value = sampled(track, time);
    if (value == track.last) continue;
    edit.push_back({{"op", "replace"}, {"path", pointer_text(track.path)}, {"value", value}});
    track.last = std::move(value);
  }
  return edit;
}

std::vector<double> sample_times(const std::vector<Track>& tracks, const SampleTimes& times, const std::string& file,
                                 const std::string& name) {
  float first = INFINITY, last = 0;
  for (const Track& track : tracks) {
    first = std::min(first, track.channel->times.front());
    last = std::max(last, track.channel->times.back());
  }
  const double from = times.from.value_or(static_cast<double>(first)),
               to = times.to.value_or(static_cast<double>(last));
  if (to < from)
    throw UsageError("--from " + Json(from).dump() + " is after the end of \"" + name + "\", " + Json(to).dump());
  constexpr double kRounding = 1e-6;  // of a frame: the last keyframe counts when it is due
  const double steps = std::floor((to - from) * times.frames_per_second + kRounding);
  if (!(steps < kMostAnimationFrames))
    throw InputError(file, "",
                     "animation \"" + name + "\" has more than " + Json(kMostAnimationFrames).dump() +
                         " frames; fewer with --fps, --from, --to");
  constexpr std::size_t kNumbersOfValue = 4;  // of a rotation; many morph weights count as several values
  double values = 0;
  for (const Track& track : tracks)
    values += static_cast<double>((track.channel->width + kNumbersOfValue - 1) / kNumbersOfValue);
  if ((steps + 1) * values > kMostAnimatedValues)
    throw InputError(file, "",
                     "animation \"" + name + "\" has more than " + Json(kMostAnimatedValues).dump() +
                         " values in its frames; fewer with --fps, --from, --to");
  std::vector<double> samples;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(steps); ++i)
    samples.push_back(std::min(from + static_cast<double>(i) / times.frames_per_second, to));
  return samples;
}

/// The topmost of the nodes that move.
Json selection_of(const SceneState& state, const std::vector<Track>& tracks) {
  std::set<std::string> moved;
  for (const Track& track : tracks) moved.insert(track.path[1]);
  Json selection = Json::array();
  for (const std::string& node : moved) {
    std::string above = state.parent_of(node);
    while (!above.empty() && !moved.contains(above)) above = state.parent_of(above);
    if (above.empty()) selection.push_back(pointer_text({"nodes", node}));
  }
  return selection;
}

}  // namespace

JournalDraft draft_animation(const SceneState& state, const Animation& animation, const SampleTimes& times) {
  JournalDraft draft;
  draft.warnings = animation.warnings;
  std::vector<Track> tracks;
  for (const AnimationChannel& channel : animation.channels) {
    Track track;
    const std::string why = obstacle(state, channel, track);
    if (why.empty())
      tracks.push_back(std::move(track));
    else
      draft.warnings.push_back(channel.where + ": " + channel.pointer + " is left out: " + why);
  }
  const std::string& file = state.document().file;
  if (tracks.empty())
    throw InputError(file, "",
                     "no journal can express animation \"" + animation.name + "\"" +
                         (draft.warnings.empty() ? ": it has no channels" : ": " + draft.warnings.front()));
  const bool is_drag = std::ranges::all_of(
      tracks, [](const Track& track) { return is_node_transform(track.path) || is_morph(track.path); });
  bool has_edits = false;
  Json entries = Json::array();
  for (const double time : sample_times(tracks, times, file, animation.name)) {
    Json edit = edit_at(tracks, time);
    has_edits = has_edits || !edit.empty();
    if (is_drag)
      entries.push_back(std::move(edit));
    else
      draft.steps.push_back(
          {{"name", animation.name + " at " + Json(short_real(static_cast<float>(time))).dump() + " s"},
           {"edit", std::move(edit)}});
  }
  if (!has_edits) throw InputError(file, "", "animation \"" + animation.name + "\" changes nothing of the scene");
  if (is_drag)
    draft.steps.push_back(
        {{"name", animation.name}, {"select", selection_of(state, tracks)}, {"drag", std::move(entries)}});
  for (const Track& track : tracks)
    if (track.is_clamped)
      draft.warnings.push_back(track.channel->where + ": " + track.channel->pointer +
                               " leaves its range: those frames have the limit");
  return draft;
}

}  // namespace relook
