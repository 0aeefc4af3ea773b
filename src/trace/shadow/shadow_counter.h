// Shadow counters (paper 4.2): how many distinct opaque objects block a segment, in b bits and an overflow flag.
// Invariant: equal numbers of blockers give equal counters, whatever edits led there, so that paths after any journal
// equal those built afresh. This is stricter than the paper, whose overflow flag stays set until a recount.
#pragma once
#include <cstdint>
#include <optional>

namespace relook {

class ShadowCounter {
 public:
  static constexpr std::uint32_t kMostBits = 4;

  /// Blockers that `bits` bits can tell apart: 2^b - 1. b = 0 leaves the overflow flag alone: blocked or not.
  [[nodiscard]] static constexpr std::uint32_t most(std::uint32_t bits) { return (1U << bits) - 1U; }
  [[nodiscard]] static ShadowCounter of(std::uint64_t blockers, std::uint32_t bits) {
    return {blockers > most(bits) ? overflow_flag(bits) : static_cast<std::uint32_t>(blockers), bits};
  }

  /// As kept in ray paths, on disk too: the number in the lowest b bits, 0 if the overflow flag, bit b, is set.
  [[nodiscard]] static constexpr bool is_sound(std::uint32_t word, std::uint32_t bits) {
    return word <= overflow_flag(bits);
  }
  /// Requires: is_sound(word, bits).
  [[nodiscard]] static ShadowCounter from_word(std::uint32_t word, std::uint32_t bits) { return {word, bits}; }
  [[nodiscard]] std::uint32_t word() const { return word_; }

  [[nodiscard]] bool is_blocked() const { return word_ != 0; }
  [[nodiscard]] bool overflows() const { return word_ == overflow_flag(bits_); }

  /// After k more blockers.
  [[nodiscard]] ShadowCounter added(std::uint32_t k) const {
    return overflows() ? *this : of(std::uint64_t{word_} + k, bits_);
  }
  /// After k fewer; no value: the segment must be counted again, also where fewer than k were counted (a cache that
  /// does not tell the truth).
  [[nodiscard]] std::optional<ShadowCounter> removed(std::uint32_t k) const {
    if (k == 0) return *this;
    if (overflows() || k > word_) return std::nullopt;
    return of(word_ - k, bits_);
  }

  bool operator==(const ShadowCounter&) const = default;

 private:
  ShadowCounter(std::uint32_t word, std::uint32_t bits) : word_(word), bits_(bits) {}
  [[nodiscard]] static constexpr std::uint32_t overflow_flag(std::uint32_t bits) { return 1U << bits; }

  std::uint32_t word_, bits_;
};

}  // namespace relook
