#include "page/page_details.h"

#include <span>
#include <utility>

#include "frame/deflate.h"
#include "page/page.h"

namespace relook {
namespace {

std::string compressed(const std::string& text) {
  return base64(Deflater().zlib({reinterpret_cast<const unsigned char*>(text.data()), text.size()}));
}

}  // namespace

void PageDetails::start_chunk(const std::vector<std::size_t>& sources) {
  open_.least = open_.all = "{\"sources\":" + Json(sources).dump() + ",\"entries\":[";
  bytes_ += open_.all.size();
}

void PageDetails::add(Json details, const Json& tiles) {
  details.update(tiles);
  const std::string text = (entries_ == 0 ? "" : ",\n") + script_json(details);
  open_.all += text;
  open_.least += (entries_ == 0 ? "" : ",\n") + script_json(tiles);
  bytes_ += text.size();
  if (++entries_ == kEntriesPerChunk) end_chunk();
}

void PageDetails::end_chunk() {
  if (entries_ == 0) return;
  open_.all += "]}";
  open_.least += "]}";
  bytes_ += 3;
  entries_ = 0;
  if (is_beside_)
    write_beside(open_);
  else
    chunks_.push_back(std::move(open_));
  open_ = {};
}

void PageDetails::move_out() {
  is_beside_ = true;
  for (Chunk& chunk : chunks_) write_beside(std::exchange(chunk, {}));
  chunks_.clear();
}

void PageDetails::write_beside(const Chunk& chunk) {
  std::string packed = compressed(chunk.all);
  if (written_bytes_ + packed.size() > most_bytes_) packed = compressed(chunk.least);
  const std::string number = std::to_string(written_);
  const std::string text = std::string(kStepsCall) + number + ",\"" + packed + "\");\n";
  write_file(files_->new_steps(written_++), text);
  written_bytes_ += text.size();
}

std::string PageDetails::in_page() const {
  if (is_beside_) return "null";
  std::string list = "[";
  for (const Chunk& chunk : chunks_) list += (list.size() > 1 ? "," : "") + chunk.all;
  return list + "]";
}

}  // namespace relook
