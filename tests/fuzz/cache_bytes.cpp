#include "cache_bytes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "base/hash.h"
#include "cache/cache.h"
#include "cache/container.h"
#include "mutate_json.h"

namespace relook {
namespace {

// FORMAT.md
constexpr std::size_t kHeaderBytes = 80, kEntryBytes = 64, kNameBytes = 24, kHashDigits = 32;
constexpr std::string_view kExtension = ".rlk", kTunnels = "tunnels/", kBoundTo = "bound_to";

std::uint32_t word_at(BytesView bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

std::vector<CacheBytes::Section> sections_of(const Bytes& file, const CacheIdentity& identity) {
  const ContainerReader reader(file, identity);
  std::vector<CacheBytes::Section> sections;
  for (std::size_t i = 0; i < word_at(file, 12); ++i) {
    const std::size_t at = kHeaderBytes + i * kEntryBytes;
    const std::string_view padded = text_of(BytesView(file).subspan(at, kNameBytes));
    CacheBytes::Section section{std::string(padded.substr(0, padded.find('\0'))), word_at(file, at + 28), {}};
    section.raw = reader.column<std::byte>(section.name, reader.raw_bytes(section.name));
    sections.push_back(std::move(section));
  }
  return sections;
}

Bytes copy_of(std::string_view text) {
  const BytesView bytes = bytes_of(text);
  return {bytes.begin(), bytes.end()};
}

void change_json(Bytes& raw, Choices& choices) {
  Json document = Json::parse(text_of(raw), nullptr, false);
  if (document.is_discarded()) return;
  mutate_json(document, choices);
  raw = copy_of(json_text(document));
}

void put(Bytes& raw, std::size_t at, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes && at + i < raw.size(); ++i)
    raw[at + i] = static_cast<std::byte>(value >> (8 * i) & 0xFFU);
}

void change_values(CacheBytes::Section& section, Choices& choices) {
  constexpr std::array<std::uint32_t, 10> kWords{0,          1,          0xFFFFFFFF, 0x7FFFFFFF, 0x80000000,
                                                 0x7F800000, 0x7FC00000, 0x7F7FFFFF, 0x00000001, 0x3F800000};
  Bytes& raw = section.raw;
  const std::size_t kind = choices.below(8);
  const std::size_t at = raw.empty() ? 0 : static_cast<std::size_t>(choices.number(2)) % raw.size();
  const std::size_t word = at / 4 * 4;
  switch (kind) {
    case 0:
      return put(raw, at, choices.number(1), 1);
    case 1:
      return put(raw, word, kWords[choices.below(kWords.size())], 4);
    case 2:
      return put(raw, word, choices.number(4), 4);
    case 3:
      return put(raw, word, word_at(raw.size() >= word + 4 ? BytesView(raw).subspan(word) : BytesView(Bytes(4)), 0) + 1,
                 4);
    case 4:
      raw.resize(raw.size() - std::min<std::size_t>(raw.size(), section.stride * (choices.number(1) + 1)));
      return;
    case 5:
      raw.resize(raw.size() + section.stride * (choices.number(1) + 1));
      return;
    case 6: {  // values from elsewhere
      const std::size_t from = raw.empty() ? 0 : static_cast<std::size_t>(choices.number(2)) % raw.size() / 4 * 4;
      const std::size_t bytes = std::min({std::size_t{16}, raw.size() - from, raw.size() - word});
      if (bytes == 0) return;
      std::memmove(raw.data() + word, raw.data() + from, bytes);
      return;
    }
    default:
      return put(raw, at / 8 * 8, choices.number(8), 8);
  }
}

}  // namespace

CacheBytes CacheBytes::of(const std::filesystem::path& cache) {
  Json manifest;
  const CacheAnswer answer = read_manifest(cache, manifest);
  expect(answer.fault == CacheFault::none, "the cache to begin with is sound");
  CacheBytes bytes;
  bytes.content = manifest["content"];
  const CacheIdentity identity{bytes.content["scene"], bytes.content["options"]};
  for (const Json& entry : bytes.content["files"]) {
    const auto name = entry["name"].get<std::string>();
    const Bytes file = read_file(cache / name);
    if (!name.ends_with(kExtension))
      bytes.look = Json::parse(text_of(file));
    else
      bytes.files.push_back(
          {name.substr(0, name.size() - kExtension.size() - kHashDigits), sections_of(file, identity)});
  }
  std::ranges::stable_partition(bytes.files, [](const File& file) { return !file.stem.starts_with(kTunnels); });
  return bytes;
}

void CacheBytes::change(Choices& choices) {
  const std::size_t which = choices.below(files.size() + 2);
  if (which == files.size()) return mutate_json(look, choices);
  if (which > files.size()) return mutate_json(content, choices);
  File& file = files[which];
  const std::size_t kind = choices.below(16);
  if (kind == 0) {
    file.is_there = false;
    return;
  }
  if (file.sections.empty()) return;
  const std::size_t index = choices.below(file.sections.size());
  Section& section = file.sections[index];
  if (kind == 1)
    file.sections.erase(file.sections.begin() + static_cast<std::ptrdiff_t>(index));
  else if (section.name == "names" && kind < 14)
    change_json(section.raw, choices);
  else
    change_values(section, choices);
}

void CacheBytes::write(const std::filesystem::path& cache) {
  CacheIdentity identity{std::string(kHashDigits, 'a'), ""};
  if (content.is_object()) {
    if (const Json scene = content.value("scene", Json()); scene.is_string() && scene.get<std::string>().size() == 32)
      identity.scene_hash = scene;
    Json options = Json::object();
    for (const char* key : {"camera", "samples", "max_depth", "shadow_bits", "integrator"})
      options[key] = content.value(key, Json());
    for (const char* key : {"diffuse_depth", "glossy_depth", "transmission_depth", "lens"})
      if (content.contains(key)) options[key] = content[key];
    content["options"] = hash128(bytes_of(json_text(options)));
    identity.options_hash = content["options"];
  } else {
    identity.options_hash = identity.scene_hash;
  }
  std::vector<Json> entries;
  const auto add = [&](const std::string& name, BytesView bytes, bool is_there) {
    std::filesystem::create_directories((cache / name).parent_path());
    if (is_there) overwrite_file(cache / name, bytes);
    entries.push_back({{"name", name}, {"bytes", bytes.size()}, {"hash", hash128(bytes)}});
  };
  add("look.json", bytes_of(json_text(look)), true);
  std::vector<std::pair<std::string, std::string>> hashes;
  const auto hash_of = [&](const std::string& stem) {
    for (const auto& [name, hash] : hashes)
      if (name == stem) return hash;
    return std::string(kHashDigits, '0');
  };
  for (File& file : files) {
    ContainerWriter writer;
    for (Section& section : file.sections) {
      if (section.name == kBoundTo)
        section.raw = copy_of(hash_of("trees/" + file.stem.substr(kTunnels.size())) + hash_of("paths-"));
      writer.add(section.name, section.raw, section.raw.size() % section.stride == 0 ? section.stride : 1);
    }
    const Bytes bytes = writer.finish(identity);
    hashes.emplace_back(file.stem, hash128(bytes));
    add(file.stem + hashes.back().second + std::string(kExtension), bytes, file.is_there);
  }
  std::ranges::sort(entries, {}, [](const Json& entry) { return entry["name"].get<std::string>(); });
  if (content.is_object()) content["files"] = entries;
  const std::string hash = hash128(bytes_of(json_text(content)));
  const Json document{{"relook", "cache/" + std::to_string(kCacheFormat)}, {"hash", hash}, {"content", content}};
  overwrite_file(cache / "MANIFEST.json", bytes_of(document.dump(1) + "\n"));
}

}  // namespace relook
