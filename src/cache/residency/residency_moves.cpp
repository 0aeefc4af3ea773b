// Pieces on their way: out of memory to the spill file, back from there, from the store that they came from. What is
// read is read outside of the mutex, by one thread a piece.
#include <algorithm>
#include <chrono>
#include <optional>

#include "cache/residency/residency.h"

namespace relook {

void Residency::bring_back(PieceKind kind, std::size_t tile) {
  std::unique_lock lock(mutex_);
  Piece& p = piece(kind, tile);
  loaded_.wait(lock, [&] { return p.state != State::loading; });
  if (p.state != State::spilled && p.state != State::stored) return;
  const State from = p.state;
  make_room_locked(p.facts.bytes);
  resident_bytes_ += p.facts.bytes;
  p.state = State::loading;
  const std::optional<SpillFile::Extent> extent = p.copy;
  lock.unlock();
  const PieceHandler& handler = kinds_[index_of(kind)].handler;
  const auto start = std::chrono::steady_clock::now();
  std::optional<std::uint64_t> bytes = p.facts.bytes;
  const auto settle = [&](State state) {
    lock.lock();
    p.state = state;
    loaded_.notify_all();
  };
  try {
    if (from == State::stored)
      bytes = handler.fetch(tile);
    else
      handler.unpack(tile, spill_->read(*extent));
  } catch (...) {
    handler.drop(tile);  // what is there of it
    settle(from);
    resident_bytes_ -= p.facts.bytes;
    throw;
  }
  settle(bytes ? State::resident : State::missing);
  resident_bytes_ -= p.facts.bytes;
  p.is_stored = p.is_stored && bytes;
  if (!bytes) return;
  p.facts.bytes = std::max<std::uint64_t>(*bytes, 1);
  resident_bytes_ += p.facts.bytes;
  const bool is_first = from == State::stored && !p.has_left;
  ++(is_first ? counts_.fetched : counts_.reloaded)[index_of(kind)];
  counts_.reloaded_bytes += is_first ? 0 : p.facts.bytes;
  if (from != State::stored) return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fetch_seconds_per_byte_ += 0.1 * (seconds / static_cast<double>(p.facts.bytes) - fetch_seconds_per_byte_);
}

void Residency::expect(PieceKind kind, std::size_t tile) {
  if (!spill_) return;
  std::optional<SpillFile::Extent> extent;
  {
    const std::lock_guard lock(mutex_);
    const Piece& p = piece(kind, tile);
    if (p.state == State::spilled) extent = p.copy;
  }
  if (extent) spill_->expect(*extent);
}

bool Residency::evict(PieceKind kind, std::size_t tile) {
  Piece& p = piece(kind, tile);
  const PieceHandler& handler = kinds_[index_of(kind)].handler;
  if (p.state != State::resident || p.pins > 0) return false;
  if (!p.copy && !p.is_stored && spill_ && !handler.is_derived) {
    const auto start = std::chrono::steady_clock::now();
    p.copy = spill_->write(handler.pack(tile));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    seconds_per_byte_ += 0.1 * (seconds / static_cast<double>(p.facts.bytes) - seconds_per_byte_);
  }
  if (!p.copy && !p.is_stored && !handler.may_be_missing) return false;
  handler.drop(tile);
  p.state = p.copy ? State::spilled : p.is_stored ? State::stored : State::missing;
  p.has_left = true;
  resident_bytes_ -= p.facts.bytes;
  if (handler.is_derived) return true;
  ++counts_.evicted[index_of(kind)];
  counts_.evicted_bytes += p.facts.bytes;
  return true;
}

void Residency::free_copy(Piece& piece) {
  if (piece.copy) spill_->free(*piece.copy);
  piece.copy.reset();
}

}  // namespace relook
