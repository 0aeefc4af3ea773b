#include "cache/manifest.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/hash.h"
#include "build_hash.h"
#include "trace/shadow_counter.h"

namespace relook {
namespace {

constexpr std::string_view kFormatPrefix = "cache/";
constexpr std::size_t kLargestManifestBytes = std::size_t{64} << 20;
constexpr std::size_t kMostFiles = 100000;
constexpr std::int64_t kLargestSide = 16384, kMostSamples = 1024, kMostDepth = 32;
constexpr std::int64_t kMostEntities = 0xFFFFFFFE;

Json vector_json(const Imath::V3f& v) { return Json::array({v.x, v.y, v.z}); }

Imath::V3f read_vector(const JsonView& view) {
  std::array<float, 3> values{};
  view.reals(values);
  return {values[0], values[1], values[2]};
}

Camera read_camera(const JsonView& view) {
  Camera camera;
  camera.name = view.at("name").text();
  camera.node = view.at("node").text();
  camera.orthographic = view.at("orthographic").boolean();
  camera.eye = read_vector(view.at("eye"));
  camera.right = read_vector(view.at("right"));
  camera.up = read_vector(view.at("up"));
  camera.forward = read_vector(view.at("forward"));
  camera.half_width = view.at("half_width").real();
  camera.half_height = view.at("half_height").real();
  camera.near = view.at("near").real();
  camera.width = static_cast<std::uint32_t>(view.at("width").integer(1, kLargestSide));
  camera.height = static_cast<std::uint32_t>(view.at("height").integer(1, kLargestSide));
  return camera;
}

bool is_hash(std::string_view text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Names that write_cache() can have written: nothing that leaves the directory.
bool is_file_name(std::string_view name) {
  if (name == "look.json") return true;
  constexpr std::string_view kSuffix = ".rlk";
  if (!name.ends_with(kSuffix)) return false;
  name.remove_suffix(kSuffix.size());
  const std::size_t dash = name.rfind('-');
  if (dash == std::string_view::npos || !is_hash(name.substr(dash + 1))) return false;
  const std::string_view stem = name.substr(0, dash);
  constexpr std::string_view kTrees = "trees/";
  if (stem.starts_with(kTrees))
    return stem.size() > kTrees.size() && stem.find_first_not_of("0123456789", kTrees.size()) == std::string_view::npos;
  return stem == "geometry" || stem == "textures" || stem == "frame" || stem == "paths";
}

/// The build, and the processor's instruction set as far as Embree's arithmetic follows it.
std::string arithmetic() {
  const char* instructions = "generic";
#if defined(__x86_64__)
  instructions = __builtin_cpu_supports("avx2") ? "avx2" : __builtin_cpu_supports("avx") ? "avx" : "sse";
#endif
  return std::string(RELOOK_BUILD) + "-" + instructions;
}

Json content_json(const Manifest& manifest) {
  Json files = Json::array();
  for (const CacheFile& file : manifest.files)
    files.push_back({{"name", file.name}, {"bytes", file.bytes}, {"hash", file.hash}});
  return {{"build", arithmetic()},
          {"scene", manifest.identity.scene_hash},
          {"options", manifest.identity.options_hash},
          {"camera", camera_json(manifest.camera)},
          {"samples", manifest.samples},
          {"max_depth", manifest.max_depth},
          {"shadow_bits", manifest.shadow_bits},
          {"objects", manifest.objects},
          {"lights", manifest.lights},
          {"files", std::move(files)}};
}

Manifest read_content(const JsonView& view) {
  // Stored hits and colours are the bits of one build's arithmetic: another build would mix them with its own.
  if (view.at("build").text() != arithmetic())
    throw CacheDamage(CacheFault::other_version,
                      "another build of the program, or another kind of processor, wrote it");
  Manifest manifest;
  manifest.identity = {view.at("scene").text(), view.at("options").text()};
  if (!is_hash(manifest.identity.scene_hash)) view.at("scene").fail("not a hash");
  if (!is_hash(manifest.identity.options_hash)) view.at("options").fail("not a hash");
  manifest.camera = read_camera(view.at("camera"));
  manifest.samples = static_cast<std::uint32_t>(view.at("samples").integer(1, kMostSamples));
  manifest.max_depth = static_cast<std::uint32_t>(view.at("max_depth").integer(1, kMostDepth));
  manifest.shadow_bits = static_cast<std::uint32_t>(view.at("shadow_bits").integer(0, ShadowCounter::kMostBits));
  manifest.objects = static_cast<std::uint32_t>(view.at("objects").integer(0, kMostEntities));
  manifest.lights = static_cast<std::uint32_t>(view.at("lights").integer(0, kMostEntities));
  const JsonView files = view.at("files");
  files.require_array();
  if (files.size() > kMostFiles) files.fail("too many files");
  for (std::size_t i = 0; i < files.size(); ++i) {
    const JsonView entry = files.at(i);
    CacheFile file{entry.at("name").text(),
                   static_cast<std::uint64_t>(entry.at("bytes").integer(0, std::int64_t{1} << 50)),
                   entry.at("hash").text()};
    if (!is_file_name(file.name)) entry.at("name").fail("not a file of a cache");
    manifest.files.push_back(std::move(file));
  }
  return manifest;
}

bool is_complete_json(std::string_view text) { return text.ends_with("}\n"); }

/// The format number of a manifest, from its own key. Throws CacheDamage.
void check_format(const Json& document) {
  if (!document.is_object() || !document.contains("relook") || !document["relook"].is_string())
    throw CacheDamage(CacheFault::not_a_cache, "MANIFEST.json is not of relook");
  const auto& format = document["relook"].get_ref<const std::string&>();
  if (!format.starts_with(kFormatPrefix)) throw CacheDamage(CacheFault::not_a_cache, "MANIFEST.json is not of a cache");
  const std::string expected = std::string(kFormatPrefix) + std::to_string(kCacheFormat);
  if (format != expected)
    throw CacheDamage(CacheFault::other_version,
                      "its format is " + printable(format) + ", this program reads " + expected);
}

}  // namespace

Json camera_json(const Camera& camera) {
  return {{"name", camera.name},
          {"node", camera.node},
          {"orthographic", camera.orthographic},
          {"eye", vector_json(camera.eye)},
          {"right", vector_json(camera.right)},
          {"up", vector_json(camera.up)},
          {"forward", vector_json(camera.forward)},
          {"half_width", camera.half_width},
          {"half_height", camera.half_height},
          {"near", camera.near},
          {"width", camera.width},
          {"height", camera.height}};
}

std::string manifest_text(const Manifest& manifest) {
  Json content = content_json(manifest);
  const std::string hash = hash128(bytes_of(content.dump()));
  const Json document{{"relook", std::string(kFormatPrefix) + std::to_string(kCacheFormat)},
                      {"hash", hash},
                      {"content", std::move(content)}};
  return document.dump(1) + "\n";
}

Manifest load_manifest(const std::filesystem::path& cache, Json* out) {
  std::error_code error;
  const auto kind = std::filesystem::status(cache, error).type();
  if (kind == std::filesystem::file_type::not_found) throw CacheDamage(CacheFault::missing, "");
  const std::filesystem::path path = cache / kManifestName;
  if (kind != std::filesystem::file_type::directory || !std::filesystem::exists(path, error))
    throw CacheDamage(CacheFault::not_a_cache, "");
  try {
    const Bytes bytes = read_file(path, kLargestManifestBytes);
    const std::string_view text = text_of(bytes);
    if (!is_complete_json(text)) throw CacheDamage(CacheFault::truncated, "the manifest does not end");
    Json document = parse_json(text, path.string());
    check_format(document);
    const JsonView view(document, "");
    const JsonView content = view.at("content");
    check_sound(view.at("hash").text() == hash128(bytes_of(content.value().dump())), "manifest hash mismatch");
    Manifest manifest = read_content(content);
    check_sound(manifest_text(manifest) == text, "the manifest is not as it was written");
    if (out != nullptr) *out = std::move(document);
    return manifest;
  } catch (const InputError& fault) {
    throw CacheDamage(CacheFault::damaged, fault.what());
  }
}

Bytes load_file(const std::filesystem::path& cache, const CacheFile& file) {
  try {
    const std::filesystem::path path = contained_path(cache, file.name, file.name, "");
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error) throw CacheDamage(CacheFault::damaged, "the file is missing");
    const std::string sizes =
        std::to_string(size) + " bytes, not the " + std::to_string(file.bytes) + " of the manifest";
    if (size < file.bytes) throw CacheDamage(CacheFault::truncated, sizes);
    check_sound(size == file.bytes, sizes);
    return read_file(path, file.bytes);
  } catch (const InputError& fault) {
    throw CacheDamage(CacheFault::damaged, fault.what());
  }
}

bool looks_like_cache(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path manifest = path / kManifestName;
  if (!std::filesystem::is_regular_file(manifest, error)) return false;
  try {
    const Bytes bytes = read_file(manifest, kLargestManifestBytes);
    return text_of(bytes).find("\"relook\"") != std::string_view::npos;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace relook
