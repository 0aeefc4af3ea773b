#include "page/page_pixels.h"

#include <algorithm>
#include <utility>

#include "page/page.h"
#include "trace/tree/ray_tree.h"

namespace relook {
namespace {

constexpr std::uint64_t kBundleBytes = 512'000;  // a file is ended beyond these

std::uint64_t bytes_of_frames(const std::filesystem::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(folder, error)) {
    if (file.path().extension() != ".exr") continue;
    const std::uintmax_t size = file.file_size(error);
    if (!error) bytes += size;
  }
  return bytes;
}

}  // namespace

std::vector<std::size_t> runs_of(const std::vector<std::size_t>& tiles) {
  std::vector<std::size_t> runs;
  for (const std::size_t tile : tiles) {
    if (runs.empty() || runs[runs.size() - 2] + runs.back() != tile)
      runs.insert(runs.end(), {tile, 1});
    else
      ++runs.back();
  }
  return runs;
}

std::vector<std::size_t> counted(const std::vector<std::size_t>& entries) {
  std::vector<std::size_t> runs;
  for (const std::size_t entry : entries) {
    if (runs.empty() || runs.back() != entry)
      runs.insert(runs.end(), {1, entry});
    else
      ++runs[runs.size() - 2];
  }
  return runs;
}

void append_base64(const std::vector<std::size_t>& tiles, const std::function<BytesView(std::size_t)>& packed_tile,
                   const PixelBundles::Append& append) {
  constexpr std::size_t kPiece = 3 << 16;
  Bytes waiting;
  for (const std::size_t tile : tiles) {
    const BytesView packed = packed_tile(tile);
    waiting.insert(waiting.end(), packed.begin(), packed.end());
    if (waiting.size() < kPiece) continue;
    const std::size_t whole = waiting.size() / 3 * 3;
    append(base64(BytesView(waiting).first(whole)));
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(whole));
  }
  append(base64(waiting));
}

void PixelBundles::add(std::size_t entry, const std::function<void(const Append&)>& write) {
  const bool is_first = !file_;
  if (is_first) {
    file_ =
        std::make_unique<FileWriter>(call_ == kRelightCall ? files_->new_relight(entry) : files_->new_pixels(entry));
    file_->append(std::string(call_) + std::to_string(entry) + ",[");
    first_entries_.push_back(entry);
  }
  file_->append(is_first ? "" : ",\n");
  write([&](std::string_view text) { file_->append(text); });
  if (file_->size() > kBundleBytes) end_file();
}

void PixelBundles::end_file() {
  if (!file_) return;
  file_->append("]);\n");
  file_->publish();
  file_.reset();
}

PagePixels::PagePixels(const std::filesystem::path& run, double exposure, PageFiles& files, std::uint32_t scale)
    : folder_(run), run_(exposure), scale_(scale), frames_bytes_(bytes_of_frames(run / "frames")), bundles_(files) {}

void PagePixels::take(std::size_t entry, const std::string& stem, bool is_last, std::size_t room_bytes) {
  if (stem != stem_) {
    const std::filesystem::path file = folder_ / "frames" / (stem + ".exr");
    Bytes bytes = read_file(file);
    read_bytes_ += bytes.size();
    run_.load(scale_ > 1 ? scaled_frame(std::move(bytes), file.string(), scale_) : std::move(bytes), file.string());
    stem_ = stem;
  }
  keep(entry, is_last, room_bytes);
}

/// Of the share that follows the bytes of the frames, a quarter may be taken from the start, and three quarters as the
/// frames come; room for the last frame is kept.
bool PagePixels::fits_beside(std::size_t bytes, bool is_last) const {
  const std::uint64_t share =
      is_last ? frames_bytes_ / 2 : frames_bytes_ / 8 + std::min(read_bytes_, frames_bytes_) / 8 * 3;
  const std::uint64_t most = (share + kFreeBesideBytes) / 8 * 7;
  const std::uint64_t last = is_last ? 0 : run_.packed_bytes() / 3 * 4 + run_.current().count() * 8 + 1000;
  return bytes_ + bytes + last <= most;
}

std::string PagePixels::record_start(std::size_t entry) const {
  std::string sizes;
  for (const std::size_t tile : run_.changed())
    sizes += (sizes.empty() ? "" : ",") + std::to_string(run_.packed(tile).size());
  return "[" + std::to_string(entry) + "," + Json(last_tiles_).dump() + ",[" + sizes + "],\"";
}

void PagePixels::keep(std::size_t entry, bool is_last, std::size_t room_bytes) {
  last_tiles_ = runs_of(run_.changed());
  has_last_ = true;
  if (run_.changed().empty()) return;
  const std::string start = record_start(entry);
  std::size_t bytes = start.size() + 60;  // with what stands around records and files
  for (const std::size_t tile : run_.changed()) bytes += (run_.packed(tile).size() + 2) / 3 * 4;
  if (!is_beside_ && bytes_ + bytes > room_bytes) move_out();
  has_last_ = !is_beside_ || fits_beside(bytes, is_last);
  if (!has_last_) return;
  bytes_ += bytes;
  const auto write = [&](const PixelBundles::Append& append) {
    append(start);
    append_base64(
        run_.changed(), [this](std::size_t tile) { return run_.packed(tile); }, append);
    append("\"]");
  };
  if (is_beside_) {
    bundles_.add(entry, write);
  } else {
    write([&, &record = records_.emplace_back(entry, "").second](std::string_view text) { record += text; });
  }
  sources_.resize(run_.current().count());
  for (const std::size_t tile : run_.changed()) sources_[tile] = entry;
  run_.keep();
}

void PagePixels::move_out() {
  is_beside_ = true;
  for (auto& [entry, record] : records_) {
    bundles_.add(entry, [&](const PixelBundles::Append& append) { append(record); });
    record = {};
  }
  records_.clear();
}

Json PagePixels::finish() {
  bundles_.end_file();
  Json channels = Json::array();
  for (const FrameTiles::Channel& channel : run_.channels())
    channels.push_back({{"name", channel.name}, {"bytes", channel.bytes}});
  return {{"width", run_.current().width()},
          {"height", run_.current().height()},
          {"channels", std::move(channels)},
          {"bundles", is_beside_ ? Json(bundles_.first_entries()) : Json(nullptr)}};
}

std::string PagePixels::in_page() const {
  if (is_beside_) return "null";
  std::string list = "[";
  for (const auto& [entry, record] : records_) list += (list.size() > 1 ? "," : "") + record;
  return list + "]";
}

}  // namespace relook
