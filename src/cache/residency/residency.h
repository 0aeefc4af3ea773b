// What stays in memory under a budget (paper 4.1, 4.3): pieces of an image, one for each kind and tile, are resident,
// on disk in a spill file, or missing and to be worked out again by whoever needs them. The lowest weight leaves first.
// Invariant: resident pieces and all else in the process keep within the budget, as far as pieces that are in use
// allow.
#pragma once
#include <array>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/system/memory.h"
#include "cache/residency/access_log.h"
#include "cache/residency/spill_file.h"

namespace relook {

enum class PieceKind : std::uint8_t {
  ray_trees,
  sample_colors,
  light_sums,
  light_layers,
  kept_rays,
  kept_segments,
  kept_terms,
  kept_vertices,
  tunnels
};
inline constexpr std::size_t kPieceKinds = static_cast<std::size_t>(PieceKind::tunnels) + 1;
[[nodiscard]] std::string_view kind_name(PieceKind kind);
[[nodiscard]] constexpr std::size_t index_of(PieceKind kind) { return static_cast<std::size_t>(kind); }

struct ResidencyOptions {
  std::optional<std::uint64_t> memory_bytes;  // of the whole process; none: no limit
  std::uint64_t most_derived_bytes = machine_memory_bytes() / 2;  // of kept rays and the like where there is no limit
  std::uint64_t reserve_bytes = 0;            // left to a change beside pieces until one has been measured
  EvictionPolicy policy = EvictionPolicy::weight;
  std::filesystem::path spill_folder;  // "": nothing is spilled
  std::uint64_t disk_bytes = ~std::uint64_t{0};
  bool logs_accesses = false;
  std::function<std::uint64_t()> process_bytes = resident_set_bytes;  // empty: only pieces count
};

/// What a replay needs beside pieces and what is there before its first change, as far as that can be foreseen.
struct MemoryNeeds {
  std::uint64_t change_bytes = 0;      // of a change, while it is worked on
  std::uint64_t aside_bytes = 0;       // of work aside, see Residency::begin_aside(); 0: there will be none
  std::uint64_t structures_bytes = 0;  // acceleration structures that changes will build and keep
};

/// How the owner's data of one kind come and go. The functions are called for one tile at a time, those for different
/// tiles from different threads.
struct PieceHandler {
  std::function<Bytes(std::size_t tile)> pack;
  std::function<void(std::size_t tile, BytesView)> unpack;
  std::function<void(std::size_t tile)> drop;
  bool may_be_missing = false;  // the owner can do without a copy
  /// Worked out from other pieces sooner than read from a disk: never on one, and moves are not counted. With
  /// may_be_missing, without pack and unpack.
  bool is_derived = false;
  /// Makes a stored piece resident and returns its bytes; none: it cannot be had, and is missing.
  std::function<std::optional<std::uint64_t>(std::size_t tile)> fetch;
};

struct PieceCounts {
  std::array<std::uint64_t, kPieceKinds> evicted{}, reloaded{};
  std::array<std::uint64_t, kPieceKinds> fetched{};  // stored pieces that were used for the first time
  std::uint64_t others_evicted = 0;
  std::uint64_t evicted_bytes = 0, reloaded_bytes = 0;  // evicted: others included
};

/// Something outside of Residency that could leave memory, too.
struct Victim {
  double weight = 0;
  std::function<std::uint64_t()> drop;  // returns how many it stands for, as PieceCounts counts
};

class Residency {
 public:
  /// Throws IoError if the spill folder cannot hold a file.
  explicit Residency(ResidencyOptions options);

  /// While it lives, the piece stays where it is.
  class Lease {
   public:
    Lease() = default;
    Lease(Residency* residency, PieceKind kind, std::size_t tile) : residency_(residency), kind_(kind), tile_(tile) {}
    Lease(Lease&& other) noexcept
        : residency_(std::exchange(other.residency_, nullptr)), kind_(other.kind_), tile_(other.tile_) {}
    Lease& operator=(Lease&&) = delete;
    ~Lease() {
      if (residency_ != nullptr) residency_->release(kind_, tile_);
    }

   private:
    Residency* residency_ = nullptr;
    PieceKind kind_ = PieceKind::ray_trees;
    std::size_t tile_ = 0;
  };

  /// While it lives, there is work aside.
  class Aside {
   public:
    explicit Aside(Residency* residency) : residency_(residency) {}
    Aside(Aside&& other) noexcept : residency_(std::exchange(other.residency_, nullptr)) {}
    Aside& operator=(Aside&&) = delete;
    ~Aside() {
      if (residency_ != nullptr) residency_->end_aside();
    }

   private:
    Residency* residency_ = nullptr;
  };

  /// To be called before the first change; without it no needs are foreseen.
  void set_needs(const MemoryNeeds& needs);
  /// All pieces of the kind are missing then, whatever was there before.
  void add_kind(PieceKind kind, std::size_t tiles, PieceHandler handler);
  [[nodiscard]] bool has_kind(PieceKind kind) const { return !kinds_[index_of(kind)].pieces.empty(); }
  /// `bytes`: of what `list` offers. Not called while set otherwise.
  void set_others(std::function<std::uint64_t()> bytes, std::function<void(std::vector<Victim>&)> list);

  [[nodiscard]] EvictionPolicy policy() const { return options_.policy; }
  [[nodiscard]] bool is_limited() const { return options_.memory_bytes.has_value(); }
  [[nodiscard]] std::uint64_t most_derived_bytes() const { return options_.most_derived_bytes; }
  /// From now on sizes and uses are noted without a limit, too, because pieces may be missing.
  void track() { tracks_pieces_ = true; }
  /// Does anyone care about sizes, uses and what is missing?
  [[nodiscard]] bool is_watched() const { return is_limited() || options_.logs_accesses || tracks_pieces_; }

  /// The piece has new content and is resident. May evict other pieces. `rebuild_seconds`: measured or estimated from
  /// what has been measured; none: as before.
  void set(PieceKind kind, std::size_t tile, std::uint64_t bytes, std::optional<double> rebuild_seconds,
           double surface_area = 1);
  /// The piece is stored where it can be fetched from as long as it does not change (a cache), of about so many bytes.
  void set_stored(PieceKind kind, std::size_t tile, std::uint64_t bytes, double rebuild_seconds, double surface_area);
  void set_surface_area(PieceKind kind, std::size_t tile, double surface_area);
  /// Makes the piece resident unless it is missing, and keeps it so. One of several threads that ask for a piece on
  /// disk reads it, the others wait. Throws IoError, and the piece is on disk as before.
  [[nodiscard]] Lease use(PieceKind kind, std::size_t tile);
  /// The piece will be used soon: if it is on disk, the system begins to fetch it. Nothing else changes.
  void expect(PieceKind kind, std::size_t tile);
  /// Is a missing piece worth being worked out again and kept? Where room is short, only if its last use before this
  /// change gives it more weight than what would have to leave: of pieces that are used in turn and do not fit
  /// together, some stay instead of each making the next one leave. `bytes`: about; if it was there before, that
  /// counts.
  [[nodiscard]] bool is_worth_room(PieceKind kind, std::size_t tile, std::uint64_t bytes);
  /// Drops a piece that may be missing, with its copy.
  void forget(PieceKind kind, std::size_t tile);

  /// A new change begins: ages advance, memory outside of pieces is measured, what is over the budget leaves. Throws
  /// ResourceError that names the floor if the budget cannot be kept.
  void begin_change();
  /// Work aside begins: between two changes, what it holds is given back before the next (a full render to compare
  /// with). Pieces leave until what the last one held fits, before the first what the needs foresee; then further ones
  /// as claim() and measure() say. Throws ResourceError that names the floor.
  [[nodiscard]] Aside begin_aside();
  /// Measures what is held aside, and makes room for that. Called as it grows, from any thread.
  void measure_aside();
  /// `bytes` more are about to be taken beside pieces, before they show in the process; negative: were given back.
  void claim(std::int64_t bytes);
  /// Throws ResourceError that names the floor if what stays is more than the budget.
  void require_floor();
  /// Evicts until `bytes` more fit, as far as possible; do they?
  bool make_room(std::uint64_t bytes);

  /// What has happened since the last call.
  [[nodiscard]] PieceCounts take_counts();
  /// The number of changes so far.
  [[nodiscard]] std::uint64_t change() const { return change_; }
  /// Something outside of Residency that could leave memory is used: for the access log. `number`: which of its kind.
  void note_use_of_other(std::string_view kind, std::size_t number, std::uint64_t bytes, double seconds);
  /// See cache/residency/access_log.h.
  [[nodiscard]] std::string access_log() const { return std::string(kAccessLogHeader) + log_; }

 private:
  enum class State : std::uint8_t { missing, spilled, stored, loading, resident };
  struct Piece {
    State state = State::missing;
    PieceFacts facts;
    double rebuild_seconds = 0;
    std::uint64_t use_before = 0;  // the last change before facts.last_use that used it
    std::uint32_t pins = 0;
    bool is_stored = false, has_left = false;
    std::optional<SpillFile::Extent> copy;
  };
  struct Kind {
    PieceHandler handler;
    std::vector<Piece> pieces;  // by tile
  };
  struct Candidate {
    double weight;
    PieceKind kind;
    std::size_t tile;    // of a piece
    std::size_t victim;  // or index into victims_
  };

  /// Trims of the allocator in one change: each takes some milliseconds.
  static constexpr std::uint32_t kMostTrims = 32;

  [[nodiscard]] Piece& piece(PieceKind kind, std::size_t tile) { return kinds_[index_of(kind)].pieces[tile]; }
  void release(PieceKind kind, std::size_t tile);
  void bring_back(PieceKind kind, std::size_t tile);
  bool fetch(PieceKind kind, std::size_t tile);
  void touch(PieceKind kind, std::size_t tile);
  void log_use(std::string_view kind, std::size_t tile, const PieceFacts& facts, double seconds);
  [[nodiscard]] std::uint64_t known_bytes() const;
  [[nodiscard]] bool fits(std::uint64_t bytes) const;
  [[nodiscard]] std::uint64_t outside_now() const;
  void measure_outside();
  bool make_room_locked(std::uint64_t bytes);
  [[nodiscard]] std::uint64_t floor_bytes() const;
  void require_floor_locked() const;
  void end_aside();
  void list_candidates();
  bool evict(PieceKind kind, std::size_t tile);
  void evict_other(const Victim& victim);
  [[nodiscard]] double return_seconds(const Piece& piece, bool is_derived) const;
  void free_copy(Piece& piece);

  ResidencyOptions options_;
  std::unique_ptr<SpillFile> spill_;
  std::array<Kind, kPieceKinds> kinds_;
  std::function<std::uint64_t()> others_bytes_;
  std::function<void(std::vector<Victim>&)> list_others_;
  mutable std::mutex mutex_;
  std::condition_variable loaded_;  // a piece is not `loading` any more
  std::uint64_t change_ = 0, resident_bytes_ = 0;
  std::uint64_t reserve_bytes_ = 0;  // the most that a change has held beside pieces and gave back
  std::uint64_t base_bytes_ = 0;     // beside pieces, as this change began
  std::int64_t claimed_bytes_ = 0;   // since then
  std::uint64_t outside_bytes_ = 0;  // beside pieces: base, claims and reserve, or as measured if more
  MemoryNeeds needs_;
  bool is_aside_ = false;
  std::uint64_t before_aside_ = 0;       // beside pieces, as work aside began
  std::uint64_t aside_most_ = 0;         // beside pieces, the most that has been measured during it
  std::uint64_t outside_of_change_ = 0;  // outside_bytes_ as work aside began: of the change before it
  double gdsf_inflation_ = 0;
  double seconds_per_byte_ = 1e-9;        // of the spill file, measured as it is used
  double fetch_seconds_per_byte_ = 3e-9;  // of what is stored, measured likewise
  std::vector<Candidate> candidates_;     // the next to leave last; made when needed, used up or for one change
  std::vector<Victim> victims_;
  std::uint32_t trims_left_;  // in this change
  bool tracks_pieces_ = false;
  PieceCounts counts_;
  std::string log_;
};

}  // namespace relook
