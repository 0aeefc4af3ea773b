// What a run's page shows of one step at a time (run_entry.h), and the tiles that each frame brought: in chunks of 256
// entries, in the page while there is room, else compressed in pixels/steps_*.js beside it. Used by run_page.cpp.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/json.h"
#include "page/page_files.h"

namespace relook {

inline constexpr std::size_t kEntriesPerChunk = 256;

class PageDetails {
 public:
  /// `files` outlives this. Beside the page, texts are left out when all would take more than `most_bytes`.
  PageDetails(PageFiles& files, std::uint64_t most_bytes) : files_(&files), most_bytes_(most_bytes) {}

  /// Whether the next entry is the first of a chunk: start_chunk() goes before it.
  [[nodiscard]] bool is_between_chunks() const { return entries_ == 0; }
  /// `sources`: the entry that each tile is from before the chunk's first entry, as PagePixels has it.
  void start_chunk(const std::vector<std::size_t>& sources);
  /// Adds the next entry. `tiles`: what the pixels need, which is kept when texts are left out.
  void add(Json details, const Json& tiles);
  void end_chunk();

  /// Moves all chunks, and those to come, from the page to files beside it.
  void move_out();
  [[nodiscard]] bool is_beside() const { return is_beside_; }
  [[nodiscard]] std::size_t bytes_in_page() const { return is_beside_ ? 0 : bytes_; }
  /// JSON, as script_json() writes it: a list of the chunks, or null when they are beside the page.
  [[nodiscard]] std::string in_page() const;

 private:
  struct Chunk {
    std::string all, least;  // JSON; the same without texts
  };
  void write_beside(const Chunk& chunk);

  PageFiles* files_;
  std::uint64_t most_bytes_;
  Chunk open_;
  std::size_t entries_ = 0;    // of open_
  std::vector<Chunk> chunks_;  // in the page
  std::size_t bytes_ = 0;      // of chunks_ and open_
  bool is_beside_ = false;
  std::size_t written_ = 0;          // chunks beside the page
  std::uint64_t written_bytes_ = 0;  // of them
};

}  // namespace relook
