#include "cache/residency/residency.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/error.h"

namespace relook {

std::string_view kind_name(PieceKind kind) {
  switch (kind) {
    case PieceKind::ray_trees:
      return "ray_trees";
    case PieceKind::sample_colors:
      return "sample_colors";
    case PieceKind::light_sums:
      return "light_sums";
    case PieceKind::light_layers:
      return "light_layers";
    case PieceKind::kept_rays:
      return "kept_rays";
    case PieceKind::kept_segments:
      return "kept_segments";
    case PieceKind::kept_terms:
      return "kept_terms";
    case PieceKind::kept_vertices:
      return "kept_vertices";
    case PieceKind::tunnels:
      return "tunnels";
  }
  return "";
}

Residency::Residency(ResidencyOptions options) : options_(std::move(options)), trims_left_(kMostTrims) {
  if (is_limited() && !options_.spill_folder.empty() && options_.disk_bytes > 0)
    spill_ = std::make_unique<SpillFile>(options_.spill_folder, options_.disk_bytes);
  reserve_bytes_ = options_.reserve_bytes;
}

void Residency::add_kind(PieceKind kind, std::size_t tiles, PieceHandler handler) {
  const std::lock_guard lock(mutex_);
  for (Piece& p : kinds_[index_of(kind)].pieces) {
    if (p.state == State::resident) resident_bytes_ -= p.facts.bytes;
    free_copy(p);
  }
  candidates_.clear();
  kinds_[index_of(kind)] = {std::move(handler), std::vector<Piece>(tiles)};
}

void Residency::set_others(std::function<std::uint64_t()> bytes, std::function<void(std::vector<Victim>&)> list) {
  others_bytes_ = std::move(bytes);
  list_others_ = std::move(list);
}

void Residency::set(PieceKind kind, std::size_t tile, std::uint64_t bytes, std::optional<double> rebuild_seconds,
                    double surface_area) {
  if (!is_watched()) return;
  const std::lock_guard lock(mutex_);
  Piece& p = piece(kind, tile);
  if (p.state == State::resident) resident_bytes_ -= p.facts.bytes;
  free_copy(p);
  p.state = State::resident;
  p.is_stored = false;
  p.facts.bytes = std::max<std::uint64_t>(bytes, 1);
  p.facts.surface_area = surface_area;
  p.rebuild_seconds = rebuild_seconds.value_or(p.rebuild_seconds);
  resident_bytes_ += p.facts.bytes;
  ++p.pins;
  make_room_locked(0);
  --p.pins;
}

void Residency::set_stored(PieceKind kind, std::size_t tile, std::uint64_t bytes, double rebuild_seconds,
                           double surface_area) {
  if (!is_watched()) return;
  const std::lock_guard lock(mutex_);
  Piece& p = piece(kind, tile);
  require(p.state == State::missing && kinds_[index_of(kind)].handler.fetch, "what is stored was not there before");
  p.state = State::stored;
  p.is_stored = true;
  p.facts.bytes = std::max<std::uint64_t>(bytes, 1);
  p.facts.surface_area = surface_area;
  p.rebuild_seconds = rebuild_seconds;
}

void Residency::set_surface_area(PieceKind kind, std::size_t tile, double surface_area) {
  if (!is_watched()) return;
  const std::lock_guard lock(mutex_);
  piece(kind, tile).facts.surface_area = surface_area;
}

Residency::Lease Residency::use(PieceKind kind, std::size_t tile) {
  if (!is_watched()) return {};
  {
    const std::lock_guard lock(mutex_);
    touch(kind, tile);
    ++piece(kind, tile).pins;
  }
  Lease lease(this, kind, tile);  // ends, too, if the piece does not come
  bring_back(kind, tile);
  return lease;
}

void Residency::release(PieceKind kind, std::size_t tile) {
  const std::lock_guard lock(mutex_);
  --piece(kind, tile).pins;
}

void Residency::touch(PieceKind kind, std::size_t tile) {
  PieceFacts& facts = piece(kind, tile).facts;
  if (facts.last_use == change_ && facts.uses > 0) return;
  piece(kind, tile).use_before = std::exchange(facts.last_use, change_);
  facts.gdsf_inflation = gdsf_inflation_;
  ++facts.uses;
  if (options_.logs_accesses) log_use(kind_name(kind), tile, facts, return_seconds(piece(kind, tile), kinds_[index_of(kind)].handler.is_derived));
}

void Residency::note_use_of_other(std::string_view kind, std::size_t number, std::uint64_t bytes, double seconds) {
  if (!options_.logs_accesses) return;
  const std::lock_guard lock(mutex_);
  PieceFacts facts;
  facts.bytes = std::max<std::uint64_t>(bytes, 1);
  log_use(kind, number, facts, seconds);
}

void Residency::log_use(std::string_view kind, std::size_t tile, const PieceFacts& facts, double seconds) {
  char line[160];
  std::snprintf(line, sizeof line, "%llu %s %zu %llu %.6g %.6g\n", static_cast<unsigned long long>(change_),
                std::string(kind).c_str(), tile, static_cast<unsigned long long>(facts.bytes), seconds,
                facts.surface_area);
  log_ += line;
}

void Residency::forget(PieceKind kind, std::size_t tile) {
  const std::lock_guard lock(mutex_);
  Piece& p = piece(kind, tile);
  require(kinds_[index_of(kind)].handler.may_be_missing, "only what can be worked out again is forgotten");
  if (p.state == State::resident) {
    resident_bytes_ -= p.facts.bytes;
    kinds_[index_of(kind)].handler.drop(tile);
  }
  free_copy(p);
  p.is_stored = false;
  p.state = State::missing;
}

PieceCounts Residency::take_counts() {
  const std::lock_guard lock(mutex_);
  return std::exchange(counts_, {});
}

}  // namespace relook
