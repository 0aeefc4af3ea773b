// What is kept of an image through a series of edits: paths, trees, colours, frame, and what helps to find things in
// them. Brought up to date with what the passes over its tiles have found.
#pragma once
#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "base/pool.h"
#include "cache/residency/residency.h"
#include "color/path/kept_terms.h"
#include "frame/changed_pixels.h"
#include "frame/image.h"
#include "image/counters.h"
#include "image/image_pieces.h"
#include "image/new_samples.h"
#include "image/path_classes.h"
#include "image/path_index.h"
#include "image/regions.h"
#include "image/tile_layers.h"
#include "trace/update/kept_rays.h"
#include "trace/update/kept_segments.h"

namespace relook {

struct TileVertices;  // color/path/tile_vertices.h

/// Has a pixel not changed? Zeros differ by their sign.
[[nodiscard]] inline bool same_bits(const Rgba& a, const Rgba& b) { return std::memcmp(&a, &b, sizeof(Rgba)) == 0; }

class StoredImage {
 public:
  /// `atoms`: see atoms_of(); empty without atoms.
  StoredImage(Image image, std::vector<LightId> lights, std::vector<ObjectId> atoms, const RegionOptions& options,
              Residency& residency);

  [[nodiscard]] const Image& image() const { return image_; }
  [[nodiscard]] const std::vector<LightId>& lights() const { return lights_; }  // light order of the paths
  [[nodiscard]] const PathIndex& index() const { return index_; }
  [[nodiscard]] const PathClasses& classes() const { return classes_; }
  [[nodiscard]] const ImageRegions& regions() const { return regions_; }
  [[nodiscard]] Residency& residency() const { return residency_; }
  [[nodiscard]] std::uint64_t segments() const { return segments_; }
  [[nodiscard]] std::uint64_t segments(std::size_t tile) const { return tile_segments_[tile]; }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  /// Colour trees are elsewhere.
  [[nodiscard]] Resident resident() const;

  /// For objects that have been added. `atoms`: of all objects; the known ones keep theirs for now.
  void extend_atoms(const std::vector<ObjectId>& atoms) {
    atoms_.insert(atoms_.end(), atoms.begin() + std::ssize(atoms_), atoms.end());
  }
  /// After a change, perhaps of the node hierarchy. `scene`: in which the trees hold.
  void set_atoms(std::vector<ObjectId> atoms, const GrowScene& scene);
  /// Tunnels of the image as it is now. Requires: the residency is watched.
  void offer_tunnels(std::shared_ptr<StoredTunnels> stored) { regions_.offer(std::move(stored), image_.trees.size()); }
  /// Requires: the trees hold in `scene`.
  void build_tunnels(const GrowScene& scene);

  /// Keeps the hits of a share of the samples (m_r of the paper's 4.1): of tiles with the deepest trees. The others
  /// stay without.
  void forget_hits(double share);
  /// Are the hits of a tile gone that are to be there? Requires: its ray trees are leased.
  [[nodiscard]] bool misses_hits(std::size_t tile) const {
    return !has_hits(image_.trees[tile]) && stays_without_hits_[tile] == 0;
  }
  /// A tile that misses its hits is about to be worked on at some leaves. If they have been, or will be, found again
  /// sample by sample as often as the tile has samples, all are found now, and kept. Tiles may be done at the same
  /// time. Requires: its ray trees are leased and hold in `scene`.
  GrowCounters bring_back_hits(std::size_t tile, const Leaves& leaves, const GrowScene& scene);
  /// Takes the hits and colours of a tile's new samples out of `fresh` and keeps them. Tiles may be done at the same
  /// time; the tile's paths are the old ones until keep_paths().
  void keep_hits(NewSamples& fresh);
  /// Takes over the paths of new samples whose hits have been kept, and keeps the regions equal to what would be built
  /// from the trees. `fresh`: by tile. `scene`: in which they hold. `lights_changed`: all samples have been packed
  /// anew, since the form of paths follows the light order.
  void keep_paths(std::span<const NewSamples> fresh, const GrowScene& scene, bool lights_changed);
  /// Builds tunnels of tiles that missed theirs, unless keep_paths() has, as it does where trees have changed. `scene`:
  /// in which trees hold.
  void bring_back_tunnels(std::span<const NewSamples> fresh, const GrowScene& scene);
  /// Tunnels that were worked out again since the last call: they had left memory, or paths were numbered afresh.
  [[nodiscard]] Moves take_rebuilt();
  /// The next two are for some samples of a tile, increasing; tiles may be done at the same time.
  void keep_colors(std::size_t tile, std::span<const std::uint32_t> samples, std::span<const Rgba> colors);
  /// Works their pixels out again, adds those that differ to `changed`. `shown`: colours to take in place of the stored
  /// ones, or null.
  void refresh_pixels(std::size_t tile, std::span<const std::uint32_t> samples, const SampleColors* shown,
                      TileMask& changed);

  /// Of the path integrator (stored_sums.cpp). Tiles may be done at the same time.
  void keep_sums(std::size_t tile, PackedSums sums);
  /// By tile: how often its sums have become others, and one.
  [[nodiscard]] const std::vector<std::uint32_t>& sum_versions() const { return sum_versions_; }
  /// Works the pixels of a tile out from its sums, adds those that differ to `changed`. `colors`: of all sums. Keeps the
  /// tile's layers from the second time on, if they are worth their room.
  void refresh_from_sums(std::size_t tile, std::span<const LightColor> colors, TileMask& changed);
  /// What is kept of a tile's rays; empty: nothing. Requires: PieceKind::kept_rays is leased.
  [[nodiscard]] const TileRays& kept_rays(std::size_t tile) const { return kept_rays_[tile]; }
  /// Empty: forgets them. Not while they are leased.
  void keep_rays(std::size_t tile, TileRays rays);
  /// Of the rays that are kept. Not while they are leased.
  void forget_weights(std::size_t tile);
  /// The same of where segments run; PieceKind::kept_segments.
  [[nodiscard]] const TileSegments& kept_segments(std::size_t tile) const { return kept_segments_[tile]; }
  void keep_segments(std::size_t tile, TileSegments segments);
  /// The same of terms for the next edit of parameters; PieceKind::kept_terms.
  [[nodiscard]] const TileTerms& kept_terms(std::size_t tile) const { return kept_terms_[tile]; }
  void keep_terms(std::size_t tile, TileTerms terms);
  /// The same of vertices for the next edit of lights; PieceKind::kept_vertices. Null: none.
  [[nodiscard]] const TileVertices* kept_vertices(std::size_t tile) const { return kept_vertices_[tile].get(); }
  void keep_vertices(std::size_t tile, TileVertices vertices);

 private:
  [[nodiscard]] PathLayout layout() const { return {lights_.size(), image_.view.shadow_bits}; }
  [[nodiscard]] ClassOf class_of() const {
    return [this](PathId path) { return classes_.of(path); };
  }
  void add_pieces();
  void add_derived();
  /// Is there room for what a tile is to keep of a kind, in place of what it kept?
  [[nodiscard]] bool may_keep(PieceKind kind, std::size_t tile, std::uint64_t bytes);
  template <class Piece>
  void keep_derived(PieceKind kind, std::size_t tile, std::vector<Piece>& pieces, Piece piece, std::size_t bytes,
                    double seconds);
  [[nodiscard]] TileLayers::Planes planes(std::size_t tile, std::span<const LightColor> colors, TileLayers& layers,
                                          TileLayers::Working& working);
  void note_layers(std::size_t tile);
  void put_pixels(std::size_t tile, const TileLayers::Planes& planes, TileMask& changed);
  void index_paths();
  void classify_paths(const GrowScene& scene);
  void count_segments(std::size_t tile);
  void drop_unused_paths(const GrowScene& scene);
  void update_regions(std::size_t tile, const Leaves& changed, const GrowScene& scene);
  void note_rebuilt_tunnels(std::size_t tile);
  void find_hits(std::size_t tile, const GrowScene& scene, GrowCounters& counters);
  [[nodiscard]] Leaves leaves_of(std::size_t tile, const std::vector<std::uint32_t>& samples) const;

  Image image_;
  struct LayerWork {
    TileLayers layers;  // of a tile whose layers are not kept
    TileLayers::Working working;
  };
  std::vector<TileLayers> layers_;              // by tile; of paths
  std::vector<std::uint8_t> has_been_composed_;  // by tile: from the sums as they are
  std::vector<std::uint32_t> sum_versions_;      // by tile, from 1 on: of the samples behind its sums
  Pool<LayerWork> layer_work_;
  std::atomic<std::uint64_t> derived_bytes_ = 0;  // of the four below, which have a limit of their own without --memory
  std::array<std::vector<std::uint64_t>, kPieceKinds> bytes_derived_;  // by kind and tile
  std::vector<TileRays> kept_rays_;              // by tile; of paths
  std::vector<TileSegments> kept_segments_;      // likewise
  std::vector<TileTerms> kept_terms_;            // likewise
  std::vector<std::shared_ptr<const TileVertices>> kept_vertices_;  // likewise
  Residency& residency_;
  std::vector<LightId> lights_;
  PathIndex index_;
  PathClasses classes_;
  std::vector<ObjectId> atoms_;
  ImageRegions regions_;
  std::vector<std::uint64_t> tile_segments_;
  std::vector<std::uint8_t> stays_without_hits_;   // by tile
  std::vector<std::uint32_t> found_again_;         // by tile: samples, since its hits have been missing
  std::atomic<double> hit_seconds_ = kHitSeconds;  // measured as hits are found again
  std::atomic<std::uint64_t> rebuilt_tunnels_ = 0, rebuilt_tunnel_bytes_ = 0;
  std::uint64_t segments_ = 0, samples_ = 0;
  std::size_t compact_paths_;  // size of the path table when it last held no unused paths
};

}  // namespace relook
