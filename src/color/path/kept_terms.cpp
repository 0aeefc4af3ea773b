#include "color/path/kept_terms.h"

#include <cstring>

#include "color/path/path_runner.h"

namespace relook {
namespace {

/// Stored columns as what a residual program reads.
struct KeptColumns {
  const StoredColumns& columns;

  void load(const Kernel::Step& step, std::size_t first, std::size_t lanes, const Parameters&, Scratch& scratch) const {
    columns.load(step.payload.number(), step.out, first, lanes, scratch);
  }
};

/// Calls done(run, first lane, lanes) for the lanes of a batch.
template <class Done>
void run_residual(const PathSplit& program, const StoredColumns& columns, std::size_t count,
                  const Parameters& parameters, Scratch& scratch, const Done& done) {
  const KeptColumns source{columns};
  KernelRun<KeptColumns> run(program.residual, parameters, source, count, scratch);
  for (std::size_t first = 0; first < count; first += kLanes) {
    const std::size_t lanes = std::min(kLanes, count - first);
    run.run(first, lanes);
    done(run, first, lanes);
  }
}

/// As PathShader has it: what does not come to the eye at all is none.
Color term(const Color& weight, const Color& unit) { return weight == Color(0, 0, 0) ? Color(0, 0, 0) : weight * unit; }

bool is_same(const Color& a, const Color& b) { return std::memcmp(&a, &b, sizeof(Color)) == 0; }

class Exchange {
 public:
  Exchange(const KeptTerms& kept, const Scene& before, const Scene& after, TermMemory& memory, TileSums& sums)
      : kept_(kept), scenes_{&before, &after}, memory_(memory), sums_(sums) {}

  void run() {
    for (const std::size_t k : {0, 1}) find_weights(k);
    for (const KeptTerms::Term& term : kept_.terms) put(term.place, term.unit, term.unit);
    for (const KeptTerms::OwnTerm& term : kept_.own_terms) {
      const std::size_t at = term.lane * kOwnColumns + term.column;
      put(term.place, memory_.own[0][term.hits][at] * term.factor, memory_.own[1][term.hits][at] * term.factor);
    }
    for (const KeptTerms::LitHits& lit : kept_.lit_hits) {
      for (const std::size_t k : {0, 1}) light(lit, k);
      for (std::size_t lane = 0; lane < lit.places.size(); ++lane)
        put(lit.places[lane], memory_.lit[0][lane], memory_.lit[1][lane]);
    }
  }

 private:
  void find_weights(std::size_t k) {
    std::vector<Color>& weights = memory_.weights[k];
    weights.resize(kept_.nodes.size());
    for (std::size_t n = 0; n < weights.size(); ++n) weights[n] = kept_.nodes[n].weight;
    memory_.own[k].resize(kept_.hits.size());
    for (std::size_t batch = 0; batch < kept_.hits.size(); ++batch) {
      const KeptTerms::Hits& hits = kept_.hits[batch];
      std::vector<Color>& own = memory_.own[k][batch];
      own.resize(hits.lanes * kOwnColumns);
      run_residual(*hits.program, hits.columns, hits.lanes, {*scenes_[k], hits.material}, memory_.scratch,
                   [&](const auto& run, std::size_t first, std::size_t lanes) {
                     for (std::size_t b = 0; b < hits.branches; ++b)
                       for (std::size_t lane = 0; lane < lanes; ++lane)
                         weights[hits.children[(first + lane) * hits.branches + b]] = from_lanes(run, b, lane);
                     for (std::size_t c = 0; c < kOwnColumns; ++c)
                       for (std::size_t lane = 0; lane < lanes; ++lane)
                         own[(first + lane) * kOwnColumns + c] = from_lanes(run, hits.branches + c, lane);
                   });
    }
    for (std::size_t n = 0; n < weights.size(); ++n)
      if (kept_.nodes[n].parent != kNoNode) weights[n] = weights[kept_.nodes[n].parent] * weights[n];
  }

  void light(const KeptTerms::LitHits& lit, std::size_t k) {
    std::vector<Color>& values = memory_.lit[k];
    values.resize(lit.places.size());
    run_residual(*lit.program, lit.columns, values.size(), {*scenes_[k], lit.material}, memory_.scratch,
                 [&](const auto& run, std::size_t first, std::size_t lanes) {
                   for (std::size_t lane = 0; lane < lanes; ++lane) {
                     Color value = from_lanes(run, 0, lane);
                     for (std::uint32_t t = lit.first_tint[first + lane]; t < lit.first_tint[first + lane + 1]; ++t)
                       value = value * lit.tints[t];
                     values[first + lane] = value;
                   }
                 });
  }

  void put(const TermPlace& place, const Color& unit_before, const Color& unit_after) {
    const Color before = term(memory_.weights[0][place.node], unit_before);
    const Color after = term(memory_.weights[1][place.node], unit_after);
    if (is_same(before, after)) return;
    sums_.subtract(place.sum, place.pixel, before);
    sums_.add(place.sum, place.pixel, after);
  }

  const KeptTerms& kept_;
  std::array<const Scene*, 2> scenes_;
  TermMemory& memory_;
  TileSums& sums_;
};

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

}  // namespace

std::size_t KeptTerms::bytes() const {
  std::size_t sum = bytes_of(nodes) + bytes_of(terms) + bytes_of(own_terms);
  for (const Hits& batch : hits) sum += bytes_of(batch.children) + batch.columns.bytes();
  for (const LitHits& batch : lit_hits)
    sum += bytes_of(batch.places) + bytes_of(batch.first_tint) + bytes_of(batch.tints) + batch.columns.bytes();
  return sum;
}

std::size_t TileTerms::bytes() const {
  std::size_t sum = 0;
  for (const KeptTerms& block : blocks) sum += block.bytes();
  return sum;
}

void exchange_terms(const KeptTerms& kept, const Scene& before, const Scene& after, TermMemory& memory,
                    TileSums& sums) {
  Exchange(kept, before, after, memory, sums).run();
}

}  // namespace relook
