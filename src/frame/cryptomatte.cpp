#include "frame/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cstdio>

#include "base/json.h"

namespace relook {
namespace {

constexpr std::uint32_t kMostRanks = 6;

std::string hexadecimal(std::uint32_t value) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "%08x", value);
  return digits;
}

/// Up to four bytes, the first the least significant.
std::uint32_t word_at(std::string_view text, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = std::min(text.size(), at + 4); i-- > at;) word = word << 8 | static_cast<unsigned char>(text[i]);
  return word;
}

}  // namespace

std::uint32_t murmur3(std::string_view text) {
  const auto scrambled = [](std::uint32_t word) { return std::rotl(word * 0xCC9E2D51U, 15) * 0x1B873593U; };
  std::uint32_t hash = 0;
  const std::size_t whole = text.size() / 4 * 4;
  for (std::size_t at = 0; at < whole; at += 4)
    hash = std::rotl(hash ^ scrambled(word_at(text, at)), 13) * 5 + 0xE6546B64U;
  if (whole < text.size()) hash ^= scrambled(word_at(text, whole));
  hash ^= static_cast<std::uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85EBCA6BU;
  hash = (hash ^ hash >> 13) * 0xC2B2AE35U;
  return hash ^ hash >> 16;
}

std::uint32_t cryptomatte_id(std::string_view name) {
  const std::uint32_t hash = murmur3(name);
  const std::uint32_t exponent = hash >> 23 & 0xFFU;
  return exponent == 0 || exponent == 0xFF ? hash ^ 1U << 23 : hash;
}

Cryptomatte::Cryptomatte(std::string layer, std::uint32_t samples)
    : layer_(std::move(layer)), samples_(samples), layers_((std::min(samples, kMostRanks) + 1) / 2) {}

std::vector<ExrChannel> Cryptomatte::channels() const {
  std::vector<ExrChannel> channels;
  for (std::size_t i = 0; i < layers_; ++i)
    for (const char* name : {".R", ".G", ".B", ".A"})
      channels.push_back({layer_ + "0" + std::to_string(i) + name, PixelFormat::float32});
  return channels;
}

ExrAttributes Cryptomatte::attributes() const {
  Json manifest = Json::object();
  for (const auto& [name, id] : ids_) manifest[name] = hexadecimal(id);
  const std::string key = "cryptomatte/" + hexadecimal(murmur3(layer_)).substr(0, 7) + "/";
  return {{key + "name", layer_},
          {key + "hash", "MurmurHash3_32"},
          {key + "conversion", "uint32_to_float32"},
          {key + "manifest", manifest.dump()}};
}

void Cryptomatte::rank(std::span<const std::uint32_t> ids, std::span<float> out) const {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  // samples, id
  for (const std::uint32_t id : ids) {
    const auto found = std::ranges::find(counts, id, [](const auto& entry) { return entry.second; });
    if (found == counts.end())
      counts.emplace_back(1, id);
    else
      ++found->first;
  }
  std::ranges::sort(counts, [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::ranges::fill(out, 0.0F);
  for (std::size_t rank = 0; rank < std::min(counts.size(), 2 * layers_); ++rank) {
    out[2 * rank] = std::bit_cast<float>(counts[rank].second);
    out[2 * rank + 1] = static_cast<float>(counts[rank].first) / static_cast<float>(samples_);
  }
}

}  // namespace relook
