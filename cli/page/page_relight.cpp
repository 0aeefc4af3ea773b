#include "page/page_relight.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "frame/deflate.h"
#include "image/layers/relight_file.h"
#include "page/page.h"
#include "page/run_entry.h"
#include "page/run_marks.h"

namespace relook {
namespace {

constexpr std::size_t kMostOperations = 400;  // of a way to a frame of a drag

std::string text_in(const FrameTiles& frame, std::string_view file) {
  for (const auto& [name, text] : frame.texts())
    if (name == kRelightAttribute) return text;
  throw InputError(file, kRelightAttribute, "missing: no layers of light");
}

using HashWords = std::array<std::uint64_t, 2>;
HashWords words_of(const std::string& hash) {
  constexpr int kHexadecimal = 16;
  constexpr std::size_t kDigits = 16;
  return {std::stoull(hash.substr(0, kDigits), nullptr, kHexadecimal),
          std::stoull(hash.substr(kDigits), nullptr, kHexadecimal)};
}

/// What a journal step that starts from an entry's frame says: `from`, and the operations before its own; null: there
/// are too many of them.
Json start_of(const Json& entry, const Journal& journal) {
  const auto place = entry.at("step").get<std::size_t>();
  const JournalStep* known = step_of(entry, journal);
  if (known == nullptr || known->form() == StepForm::edit) return {{"from", place}, {"operations", Json::array()}};
  const JournalStep& step = *known;
  const auto before = entry.find("from");
  const Json from = before == entry.end() ? Json(place - 1) : before->is_null() ? Json(0) : *before;
  const std::size_t number = frame_in_step(entry), last = (number == 0 ? step.frames() : number) - 1;
  Json operations = Json::array();
  for (std::size_t i = step.form() == StepForm::wedge ? last : 0; i <= last; ++i)
    for (const PatchOperation& operation : step.edit_of(i)) {
      if (operations.size() == kMostOperations) return {{"from", from}, {"operations", nullptr}};
      operations.push_back(whole_operation_json(operation));
    }
  return {{"from", from}, {"operations", std::move(operations)}};
}

}  // namespace

/// Says where each tile is from, and returns those that are new.
std::vector<std::size_t> PageRelight::place_tiles(std::size_t number, const FrameTiles& frame) {
  std::string names;
  for (const std::string& name : channels_) names += name + " ";
  const HashWords of_names = words_of(hash128(bytes_of(names)));
  std::vector<TileKey> keys(frame.count());
  parallel_for(keys.size(), [&](std::size_t tile) {
    const HashWords of_bytes = words_of(hash128(frame.packed(tile)));
    keys[tile] = {tile, of_bytes[0] ^ of_names[0], of_bytes[1] ^ of_names[1]};
  });
  std::vector<std::size_t> fresh;
  sources_.resize(keys.size());
  for (std::size_t tile = 0; tile < keys.size(); ++tile) {
    const auto [place, is_new] = stored_.emplace(keys[tile], number);
    sources_[tile] = place->second;
    if (is_new) fresh.push_back(tile);
  }
  return fresh;
}

void PageRelight::take(std::size_t number, const Json& entry, const std::string& stem) {
  const auto has_layers = entry.find("relight");
  if (has_layers == entry.end() || *has_layers != true) return;
  FrameTiles frame;
  std::vector<std::size_t> fresh;
  if (stem != stem_) {  // of a drag or wedge as a whole it is the last frame's
    const std::filesystem::path file = folder_ / "relight" / (stem + ".exr");
    frame = FrameTiles(read_file(file), file.string());
    text_ = text_in(frame, file.string());
    channels_.clear();
    for (const FrameTiles::Channel& channel : frame.channels()) channels_.push_back(channel.name);
    fresh = place_tiles(number, frame);
    stem_ = stem;
  }
  Json head = parse_json(text_, "relook:relight");
  head.update({{"start", start_of(entry, *journal_)}, {"channels", channels_}, {"sources", counted(sources_)}});
  const std::string text = script_json(head);
  const std::string packed_head =
      base64(Deflater().zlib({reinterpret_cast<const unsigned char*>(text.data()), text.size()}));
  std::string sizes;
  for (const std::size_t tile : fresh) sizes += (sizes.empty() ? "" : ",") + std::to_string(frame.packed(tile).size());
  bundles_.add(number, [&](const PixelBundles::Append& append) {
    append("[" + std::to_string(number) + ",\"" + packed_head + "\"," + Json(runs_of(fresh)).dump() + ",[" + sizes +
           "],\"");
    append_base64(
        fresh, [&](std::size_t tile) { return frame.packed(tile); }, append);
    append("\"]");
  });
  entries_.push_back(number);
}

Json PageRelight::finish() {
  bundles_.end_file();
  if (entries_.empty()) return nullptr;
  return {{"bundles", bundles_.first_entries()}, {"entries", runs_of(entries_)}};
}

}  // namespace relook
