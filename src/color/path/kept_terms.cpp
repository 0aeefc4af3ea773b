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

/// As PathShader has it: what does not come to the eye at all is none.
Color term(const Color& weight, const Color& unit, const Color& color) {
  return weight == Color(0, 0, 0) ? Color(0, 0, 0) : weight * unit * color;
}

template <class T>
bool is_same(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

class Exchange {
 public:
  Exchange(const KeptTerms& kept, const Scene& before, const Scene& after, const SumPlaces& places, TermMemory& memory,
           TileSums& sums)
      : kept_(kept), scenes_{&before, &after}, places_(places), memory_(memory), sums_(sums) {}

  void run() {
    for (const std::size_t k : {0, 1}) {
      yield_factors(k);
      find_weights(k);
      find_shares(k);
    }
    exchange_units();
    exchange_products();
    exchange_coverage();
  }

 private:
  void yield_factors(std::size_t k) {
    std::vector<Color>& factors = memory_.factors[k];
    std::size_t count = 0;
    for (const KeptTerms::Batch& batch : kept_.batches) count += batch.lanes * batch.width();
    factors.resize(count);
    Color* out = factors.data();
    for (const KeptTerms::Batch& batch : kept_.batches) {
      run_batch(batch, *scenes_[k], out);
      out += batch.lanes * batch.width();
    }
  }
  /// `out`: [lanes * width].
  void run_batch(const KeptTerms::Batch& batch, const Scene& scene, Color* out) {
    const KeptColumns source{batch.columns};
    const Parameters parameters{scene, batch.material};
    KernelRun<KeptColumns> run(batch.program->residual, parameters, source, batch.lanes, memory_.scratch);
    const std::size_t width = batch.width();
    for (std::size_t first = 0; first < batch.lanes; first += kLanes) {
      const std::size_t lanes = std::min(kLanes, batch.lanes - first);
      run.run(first, lanes);
      for (std::size_t column = 0; column < width; ++column)
        for (std::size_t lane = 0; lane < lanes; ++lane)
          out[(first + lane) * width + column] = from_lanes(run, column, lane);
    }
    for (std::size_t lane = 0; lane < batch.scales.size(); ++lane)
      for (std::size_t column = 0; column < width; ++column)
        out[lane * width + column] = out[lane * width + column] * batch.scales[lane];
  }
  void find_weights(std::size_t k) {
    std::vector<Color>& weights = memory_.weights[k];
    weights.resize(kept_.nodes.size());
    for (std::size_t n = 0; n < weights.size(); ++n) {
      const KeptTerms::Node& node = kept_.nodes[n];
      const Color& own = factor(node.weight, k);
      weights[n] = node.parent == kNoNode ? own : weights[node.parent] * own;
    }
  }
  void find_shares(std::size_t k) {
    std::vector<float>& shares = memory_.shares[k];
    shares.resize(kept_.openings.size());
    for (std::size_t n = 0; n < shares.size(); ++n) {
      const KeptTerms::Opening& opening = kept_.openings[n];
      const std::uint32_t parent = opening.parent;
      shares[n] =
          parent == kNoNode ? opening.share : shares[parent] * (1.0F - factor(kept_.openings[parent].coverage, k).x);
    }
  }
  [[nodiscard]] const Color& factor(FactorId id, std::size_t k) const {
    return id.is_constant() ? kept_.constants[id.place()] : memory_.factors[k][id.place()];
  }

  void exchange_units() {
    std::size_t first = 0;
    for (std::size_t n = 0; n < kept_.nodes.size(); ++n) {
      const std::size_t last = first + kept_.nodes[n].terms;
      if (!is_same(memory_.weights[0][n], memory_.weights[1][n]))
        for (std::size_t t = first; t < last; ++t) exchange(n, kept_.sources[t], kept_.units[t], kept_.units[t]);
      first = last;
    }
  }
  void exchange_products() {
    const FactorId* more = kept_.more_factors.data();
    for (const KeptTerms::Product& product : kept_.products) {
      Color before = factor(product.first, 0), after = factor(product.first, 1);
      for (const FactorId* const last = more + product.more; more != last; ++more) {
        before = before * factor(*more, 0);
        after = after * factor(*more, 1);
      }
      exchange(product.node, product.source, before, after);
    }
  }
  void exchange(std::size_t node, std::size_t source, const Color& unit_before, const Color& unit_after) {
    const Color before = term(memory_.weights[0][node], unit_before, places_.colors[source]);
    const Color after = term(memory_.weights[1][node], unit_after, places_.colors[source]);
    if (is_same(before, after)) return;
    const std::size_t sum = places_.sum_of[source], pixel = kept_.nodes[node].pixel;
    sums_.subtract(sum, pixel, before);
    sums_.add(sum, pixel, after);
  }
  void exchange_coverage() {
    for (std::size_t n = 0; n < kept_.openings.size(); ++n) {
      const KeptTerms::Opening& opening = kept_.openings[n];
      const float before = memory_.shares[0][n] * factor(opening.coverage, 0).x;
      const float after = memory_.shares[1][n] * factor(opening.coverage, 1).x;
      if (is_same(before, after)) continue;
      sums_.subtract_coverage(opening.pixel, before);
      sums_.add_coverage(opening.pixel, after);
    }
  }

  const KeptTerms& kept_;
  std::array<const Scene*, 2> scenes_;
  const SumPlaces& places_;
  TermMemory& memory_;
  TileSums& sums_;
};

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

}  // namespace

std::size_t KeptTerms::bytes() const {
  std::size_t sum = bytes_of(constants) + bytes_of(nodes) + bytes_of(units) + bytes_of(sources) + bytes_of(products) +
                    bytes_of(more_factors) + bytes_of(openings) + bytes_of(batches);
  for (const Batch& batch : batches) sum += batch.columns.bytes() + bytes_of(batch.scales);
  return sum;
}

std::size_t TileTerms::bytes() const {
  std::size_t sum = 0;
  for (const KeptTerms& block : blocks) sum += block.bytes();
  return sum;
}

void exchange_terms(const KeptTerms& kept, const Scene& before, const Scene& after, const SumPlaces& places,
                    TermMemory& memory, TileSums& sums) {
  Exchange(kept, before, after, places, memory, sums).run();
}

}  // namespace relook
