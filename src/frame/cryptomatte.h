// Cryptomatte (Friedman and Jones, "Fully automatic ID mattes with support for motion blur and transparency", SIGGRAPH
// 2015 posters, and the specification 1.2 that goes with it): which things a pixel shows, by hash of their names, and
// how much of it each covers.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frame/exr_tiles.h"

namespace relook {

/// MurmurHash3_x86_32 (Austin Appleby, public domain) with seed 0.
[[nodiscard]] std::uint32_t murmur3(std::string_view text);
/// The bits of the float that stands for a name: its hash, an exponent bit flipped where it would be no normal number.
[[nodiscard]] std::uint32_t cryptomatte_id(std::string_view name);

/// One of a file's Cryptomatte layers ("CryptoObject").
class Cryptomatte {
 public:
  /// `samples`: of a pixel; as many ranks, six at most, two a numbered layer.
  Cryptomatte(std::string layer, std::uint32_t samples);

  void add_name(const std::string& name) { ids_.emplace(name, cryptomatte_id(name)); }
  /// CryptoObject00.R, .G, .B, .A, CryptoObject01.R, ...: id and coverage of rank 0, of rank 1, ...
  [[nodiscard]] std::vector<ExrChannel> channels() const;
  [[nodiscard]] std::size_t channel_count() const { return 4 * layers_; }
  /// cryptomatte/KEY/name, hash, conversion and manifest.
  [[nodiscard]] ExrAttributes attributes() const;
  /// The values of channels() for a pixel, from the ids that its samples show, none for samples that show nothing: by
  /// coverage, equal ones by id.
  void rank(std::span<const std::uint32_t> ids, std::span<float> out) const;

 private:
  std::string layer_;
  std::uint32_t samples_;
  std::size_t layers_;
  std::map<std::string, std::uint32_t> ids_;
};

}  // namespace relook
