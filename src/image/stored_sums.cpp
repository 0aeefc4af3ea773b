// What a stored image keeps of the path integrator beside trees, tile by tile: sums of light, the pixels that they
// give, rays, segments and terms.
#include <memory>
#include <utility>

#include "color/path/tile_vertices.h"
#include "image/stored_image.h"

namespace relook {

namespace {

template <class Piece>
PieceHandler handler_of_derived(std::vector<Piece>& pieces) {
  PieceHandler handler;
  handler.drop = [tiles = pieces.data()](std::size_t tile) { tiles[tile] = Piece(); };
  handler.may_be_missing = handler.is_derived = true;
  return handler;
}

}  // namespace

void StoredImage::add_derived() {
  residency_.add_kind(PieceKind::light_layers, layers_.size(), handler_of_derived(layers_));
  residency_.add_kind(PieceKind::kept_rays, kept_rays_.size(), handler_of_derived(kept_rays_));
  residency_.add_kind(PieceKind::kept_segments, kept_segments_.size(), handler_of_derived(kept_segments_));
  residency_.add_kind(PieceKind::kept_terms, kept_terms_.size(), handler_of_derived(kept_terms_));
  residency_.add_kind(PieceKind::kept_vertices, kept_vertices_.size(), handler_of_derived(kept_vertices_));
}

bool StoredImage::may_keep(PieceKind kind, std::size_t tile, std::uint64_t bytes) {
  if (residency_.is_limited()) return residency_.is_worth_room(kind, tile, bytes);
  std::uint64_t& here = bytes_derived_[static_cast<std::size_t>(kind)][tile];
  derived_bytes_ -= std::exchange(here, 0);
  if (derived_bytes_ + bytes > residency_.most_derived_bytes()) return false;
  derived_bytes_ += here = bytes;
  return true;
}

template <class Piece>
void StoredImage::keep_derived(PieceKind kind, std::size_t tile, std::vector<Piece>& pieces, Piece piece,
                               std::size_t bytes, double seconds) {
  if (residency_.is_watched())
    residency_.forget(kind, tile);
  else
    pieces[tile] = Piece();
  if (!may_keep(kind, tile, bytes) || bytes == 0) return;
  pieces[tile] = std::move(piece);
  residency_.set(kind, tile, bytes, seconds);
}

void StoredImage::keep_rays(std::size_t tile, TileRays rays) {
  constexpr double kSecondsPerRay = 1e-6;  // to expand it again
  const double seconds = static_cast<double>(rays.rays.size()) * kSecondsPerRay;
  const std::size_t bytes = rays.empty() ? 0 : rays.bytes();
  keep_derived(PieceKind::kept_rays, tile, kept_rays_, std::move(rays), bytes, seconds);
}

void StoredImage::keep_segments(std::size_t tile, TileSegments segments) {
  constexpr double kSecondsPerByte = 1e-8;  // to look at trees again instead
  const double seconds = static_cast<double>(segments.bytes()) * kSecondsPerByte;
  const std::size_t bytes = segments.empty() ? 0 : segments.bytes();
  keep_derived(PieceKind::kept_segments, tile, kept_segments_, std::move(segments), bytes, seconds);
}

void StoredImage::forget_weights(std::size_t tile) {
  TileRays rays;
  {
    const auto lease = residency_.use(PieceKind::kept_rays, tile);
    if (kept_rays_[tile].weights.empty()) return;
    rays = std::exchange(kept_rays_[tile], TileRays());
  }
  rays.weights = {};
  keep_rays(tile, std::move(rays));
}

void StoredImage::keep_terms(std::size_t tile, TileTerms terms) {
  constexpr double kSecondsPerSample = 1e-5;  // to expand and shade it again
  const double seconds = static_cast<double>(terms.samples) * kSecondsPerSample;
  const std::size_t bytes = terms.empty() ? 0 : terms.bytes();
  keep_derived(PieceKind::kept_terms, tile, kept_terms_, std::move(terms), bytes, seconds);
}

void StoredImage::keep_vertices(std::size_t tile, TileVertices vertices) {
  constexpr double kSecondsPerHit = 1e-6;  // to restore it along kept rays
  const double seconds = vertices.hits * kSecondsPerHit;
  const std::size_t bytes = vertices.empty() ? 0 : sizeof(TileVertices) + vertices.bytes();
  auto kept = bytes > 0 ? std::make_shared<const TileVertices>(std::move(vertices)) : nullptr;
  keep_derived(PieceKind::kept_vertices, tile, kept_vertices_, std::move(kept), bytes, seconds);
}

void StoredImage::keep_sums(std::size_t tile, PackedSums sums) {
  const auto lease = residency_.use(PieceKind::light_sums, tile);
  image_.light_sums[tile] = std::move(sums);
  ++sum_versions_[tile];
  note_sums(residency_, tile, image_.light_sums[tile]);
  has_been_composed_[tile] = 0;
  if (residency_.is_watched())
    residency_.forget(PieceKind::light_layers, tile);
  else
    layers_[tile] = TileLayers();
}

TileLayers::Planes StoredImage::planes(std::size_t tile, std::span<const LightColor> colors, TileLayers& layers,
                                       TileLayers::Working& working) {
  const auto lease = residency_.use(PieceKind::light_sums, tile);
  return layers.compose(image_.light_sums[tile], colors, image_.view.samples, working);
}

void StoredImage::refresh_from_sums(std::size_t tile, std::span<const LightColor> colors, TileMask& changed) {
  const auto lease = residency_.use(PieceKind::light_layers, tile);
  TileLayers& kept = layers_[tile];
  if (kept.shows(colors)) return;
  const auto work = layer_work_.take([] { return std::make_unique<LayerWork>(); });
  if (!kept.empty()) {
    const std::size_t bytes = kept.bytes();
    put_pixels(tile, planes(tile, colors, kept, work->working), changed);
    if (kept.bytes() != bytes) note_layers(tile);
    return;
  }
  work->layers.forget();
  put_pixels(tile, planes(tile, colors, work->layers, work->working), changed);
  // Memory that is new takes longer than to work all layers out once.
  if (std::exchange(has_been_composed_[tile], std::uint8_t{1}) == 0) return;
  if (!residency_.is_worth_room(PieceKind::light_layers, tile, work->layers.bytes())) return;
  kept = std::exchange(work->layers, TileLayers());
  note_layers(tile);
}

void StoredImage::note_layers(std::size_t tile) {
  const std::size_t bytes = layers_[tile].bytes();
  residency_.set(PieceKind::light_layers, tile, bytes, static_cast<double>(bytes) * kLayerSecondsPerByte);
}

void StoredImage::put_pixels(std::size_t tile, const TileLayers::Planes& planes, TileMask& changed) {
  const TileRect rect = tile_rect(tile, image_.frame.width, image_.frame.height);
  const auto [red, green, blue, alpha] = planes;
  std::size_t pixel = 0;
  for (std::uint32_t y = 0; y < rect.height(); ++y) {
    Rgba* row = &image_.frame.pixels[std::size_t{rect.y0 + y} * image_.frame.width + rect.x0];
    std::uint64_t differs = 0;
    for (std::uint32_t x = 0; x < rect.width(); ++x, ++pixel) {
      const Rgba color(red[pixel], green[pixel], blue[pixel], alpha[pixel]);
      differs |= std::uint64_t{same_bits(color, row[x]) ? 0U : 1U} << x;
      row[x] = color;
    }
    changed[y] |= differs;
  }
}

}  // namespace relook
