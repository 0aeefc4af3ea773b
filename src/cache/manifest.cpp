// The manifest as JSON, both ways; and of cache.h options_hash() and read_manifest().
#include "cache/manifest.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/hash.h"
#include "region/path_groups.h"
#include "trace/shadow/shadow_counter.h"

namespace relook {
namespace {

constexpr std::string_view kFormatPrefix = "cache/";
constexpr std::size_t kLargestManifestBytes = std::size_t{64} << 20;
constexpr std::size_t kMostFiles = 200000;
constexpr std::int64_t kLargestSide = 16384, kMostSamples = 4096, kMostDepth = 32;
constexpr std::int64_t kMostEntities = 0xFFFFFFFE, kMostTunnels = 255, kMostAtoms = 1 << 20;

Json vector_json(const Imath::V3f& v) { return Json::array({v.x, v.y, v.z}); }

Imath::V3f read_vector(const JsonView& view) {
  std::array<float, 3> values{};
  view.reals(values);
  return {values[0], values[1], values[2]};
}

WidePoint read_wide_point(const JsonView& view) {
  WidePoint point(0, 0, 0);
  const std::size_t count = view.size();
  if (count != 3) view.fail("expected 3 numbers");
  for (int axis = 0; axis < 3; ++axis) point[axis] = view.at(static_cast<std::size_t>(axis)).number(-1e300, 1e300);
  return point;
}

Camera read_camera(const JsonView& view) {
  Camera camera;
  camera.name = view.at("name").text();
  camera.node = view.at("node").text();
  camera.orthographic = view.at("orthographic").boolean();
  camera.eye = read_wide_point(view.at("eye"));
  camera.right = read_vector(view.at("right"));
  camera.up = read_vector(view.at("up"));
  camera.forward = read_vector(view.at("forward"));
  camera.half_width = view.at("half_width").real();
  camera.half_height = view.at("half_height").real();
  camera.near = view.at("near").real();
  if (view.has("far")) camera.far = view.at("far").real();
  camera.width = static_cast<std::uint32_t>(view.at("width").integer(1, kLargestSide));
  camera.height = static_cast<std::uint32_t>(view.at("height").integer(1, kLargestSide));
  return camera;
}

Json camera_json(const Camera& camera) {
  Json json{{"name", camera.name},
            {"node", camera.node},
            {"orthographic", camera.orthographic},
            {"eye", {camera.eye.x, camera.eye.y, camera.eye.z}},
            {"right", vector_json(camera.right)},
            {"up", vector_json(camera.up)},
            {"forward", vector_json(camera.forward)},
            {"half_width", camera.half_width},
            {"half_height", camera.half_height},
            {"near", camera.near},
            {"width", camera.width},
            {"height", camera.height}};
  if (std::isfinite(camera.far)) json["far"] = camera.far;
  return json;
}

Json storage_json(const StorageOptions& storage) {
  return {{"ray_trees_percent", storage.ray_trees_percent},
          {"disk_bytes", storage.disk_bytes ? Json(*storage.disk_bytes) : Json()},
          {"tunnels", storage.tunnels.of_region},
          {"tunnel_levels", storage.tunnels.dropped_levels},
          {"most_tunnels", storage.tunnels.of_image ? Json(*storage.tunnels.of_image) : Json()},
          {"atoms", storage.atoms},
          {"groups", storage.groups},
          {"color_trees_percent", storage.color_trees_percent}};
}

std::optional<std::uint64_t> number_or_null(const JsonView& view) {
  if (view.value().is_null()) return std::nullopt;
  return static_cast<std::uint64_t>(view.integer(0, INT64_MAX));
}

StorageOptions read_storage(const JsonView& view) {
  StorageOptions storage;
  storage.ray_trees_percent = view.at("ray_trees_percent").number(0, 100);
  storage.disk_bytes = number_or_null(view.at("disk_bytes"));
  storage.tunnels.of_region = static_cast<std::size_t>(view.at("tunnels").integer(0, kMostTunnels));
  storage.tunnels.dropped_levels = static_cast<std::uint32_t>(view.at("tunnel_levels").integer(0, kTileLevel));
  storage.tunnels.of_image = number_or_null(view.at("most_tunnels"));
  storage.atoms = static_cast<std::uint32_t>(view.at("atoms").integer(0, kMostAtoms));
  storage.groups = static_cast<std::uint32_t>(view.at("groups").integer(0, kMostGroupPaths));
  storage.color_trees_percent = view.at("color_trees_percent").number(0, 100);
  return storage;
}

Json pieces_json(const PieceNumbers& pieces) {
  return {{"ray_paths", pieces.ray_paths},
          {"groups", pieces.groups},
          {"ray_trees", pieces.ray_trees},
          {"tunnels", pieces.tunnels}};
}

PieceNumbers read_pieces(const JsonView& view) {
  const auto number = [&](const char* key) { return static_cast<std::uint64_t>(view.at(key).integer(0, INT64_MAX)); };
  return {number("ray_paths"), number("groups"), number("ray_trees"), number("tunnels")};
}

/// The options that say which definition a picture has: of paths their depths as well.
void add_integrator(Json& json, const ViewOptions& view) {
  json["integrator"] = integrator_word(view.integrator);
  if (view.integrator != Integrator::path) return;
  json["diffuse_depth"] = view.diffuse_depth;
  json["glossy_depth"] = view.glossy_depth;
  json["transmission_depth"] = view.transmission_depth;
  if (view.lens.radius > 0) json["lens"] = {view.lens.radius, view.lens.focus};
}

Lens read_lens(const JsonView& view) {
  view.require_array();
  if (view.size() != 2) view.fail("not a lens");
  const auto metres = [&](std::size_t i) { return static_cast<float>(view.at(i).number(0, 2 * kMostLens)); };
  const Lens lens{metres(0), metres(1)};
  if (!is_lens(lens)) view.fail("not a lens");
  return lens;
}

void read_integrator(const JsonView& content, ViewOptions& view) {
  const JsonView word = content.at("integrator");
  const auto found = std::ranges::find(kIntegratorWords, word.text());
  if (found == kIntegratorWords.end()) word.fail("not an integrator");
  view.integrator = static_cast<Integrator>(found - kIntegratorWords.begin());
  if (view.integrator != Integrator::path) return;
  view.diffuse_depth = static_cast<std::uint32_t>(content.at("diffuse_depth").integer(0, kMostDepth));
  view.glossy_depth = static_cast<std::uint32_t>(content.at("glossy_depth").integer(0, kMostDepth));
  view.transmission_depth = static_cast<std::uint32_t>(content.at("transmission_depth").integer(0, kMostDepth));
  if (content.has("lens")) view.lens = read_lens(content.at("lens"));
}

Json content_json(const Manifest& manifest) {
  Json files = Json::array();
  for (const CacheFile& file : manifest.files)
    files.push_back({{"name", file.name}, {"bytes", file.bytes}, {"hash", file.hash}});
  Json content{{"arithmetic", arithmetic_json(manifest.arithmetic)},
               {"storage", storage_json(manifest.storage)},
               {"pieces", pieces_json(manifest.pieces)},
               {"scene", manifest.identity.scene_hash},
               {"options", manifest.identity.options_hash},
               {"camera", camera_json(manifest.camera)},
               {"samples", manifest.view.samples},
               {"max_depth", manifest.view.max_depth},
               {"shadow_bits", manifest.view.shadow_bits},
               {"objects", manifest.objects},
               {"lights", manifest.lights},
               {"files", std::move(files)}};
  add_integrator(content, manifest.view);
  if (manifest.shared > 0) content["shared"] = manifest.shared;
  if (manifest.noise) content["noise"] = *manifest.noise;
  return content;
}

Manifest read_content(const JsonView& view) {
  Manifest manifest;
  manifest.arithmetic = read_arithmetic(view.at("arithmetic"));
  const std::string difference = arithmetic_difference(manifest.arithmetic);
  if (!difference.empty()) throw CacheDamage(CacheFault::other_arithmetic, difference);
  manifest.storage = read_storage(view.at("storage"));
  manifest.pieces = read_pieces(view.at("pieces"));
  manifest.identity = {view.at("scene").text(), view.at("options").text()};
  if (!is_hash(manifest.identity.scene_hash)) view.at("scene").fail("not a hash");
  if (!is_hash(manifest.identity.options_hash)) view.at("options").fail("not a hash");
  manifest.camera = read_camera(view.at("camera"));
  manifest.view.samples = static_cast<std::uint32_t>(view.at("samples").integer(1, kMostSamples));
  manifest.view.max_depth = static_cast<std::uint32_t>(view.at("max_depth").integer(1, kMostDepth));
  manifest.view.shadow_bits = static_cast<std::uint32_t>(view.at("shadow_bits").integer(0, ShadowCounter::kMostBits));
  read_integrator(view, manifest.view);
  manifest.objects = static_cast<std::uint32_t>(view.at("objects").integer(0, kMostEntities));
  manifest.lights = static_cast<std::uint32_t>(view.at("lights").integer(0, kMostEntities));
  if (view.has("shared"))
    manifest.shared = static_cast<std::uint32_t>(view.at("shared").integer(1, std::int64_t{manifest.lights} - 1));
  if (view.has("noise")) manifest.noise = view.at("noise").number(0, std::numeric_limits<double>::max());
  const JsonView files = view.at("files");
  files.require_array();
  if (files.size() > kMostFiles) files.fail("too many files");
  for (std::size_t i = 0; i < files.size(); ++i) {
    const JsonView entry = files.at(i);
    CacheFile file{entry.at("name").text(),
                   static_cast<std::uint64_t>(entry.at("bytes").integer(0, std::int64_t{1} << 50)),
                   entry.at("hash").text()};
    if (!is_content_name(file.name)) entry.at("name").fail("not a file of a cache");
    manifest.files.push_back(std::move(file));
  }
  return manifest;
}

/// Throws CacheDamage{unreadable} when a file is there and may not be opened.
void require_permitted(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  const int error = errno;
  if (file >= 0) ::close(file);
  if (file < 0 && is_refusal(error)) throw CacheDamage(CacheFault::unreadable, refusal_text(error));
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

std::string manifest_text(const Manifest& manifest) {
  Json content = content_json(manifest);
  const std::string hash = hash128(bytes_of(content.dump()));
  const Json document{{"relook", std::string(kFormatPrefix) + std::to_string(kCacheFormat)},
                      {"hash", hash},
                      {"content", std::move(content)}};
  return document.dump(1) + "\n";
}

bool is_refusal(int error) {
  return error == EACCES || error == EPERM || error == EMFILE || error == ENFILE || error == ENOMEM;
}

std::string refusal_text(int error) { return std::string("cannot open: ") + std::strerror(error); }

Manifest load_manifest(const std::filesystem::path& cache, Json* out) {
  std::error_code error;
  const auto kind = std::filesystem::status(cache, error).type();
  if (kind == std::filesystem::file_type::not_found) throw CacheDamage(CacheFault::missing, "");
  const std::filesystem::path path = cache / kManifestName;
  require_permitted(path);
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

bool is_manifest_of_cache(const std::filesystem::path& path) {
  try {
    const Bytes bytes = read_file(path, kLargestManifestBytes);
    const Json document = parse_json(text_of(bytes), path.string());
    return document.is_object() && document.contains("relook") && document["relook"].is_string() &&
           document["relook"].get_ref<const std::string&>().starts_with(kFormatPrefix);
  } catch (const InputError&) {
    return false;
  }
}

Bytes load_file(const std::filesystem::path& cache, const CacheFile& file) {
  try {
    const std::filesystem::path path = contained_path(cache, {}, file.name, file.name, "");
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error) throw CacheDamage(CacheFault::damaged, "the file is missing");
    const std::string sizes =
        std::to_string(size) + " bytes, not the " + std::to_string(file.bytes) + " of the manifest";
    if (size < file.bytes) throw CacheDamage(CacheFault::truncated, sizes);
    check_sound(size == file.bytes, sizes);
    return read_file(path, file.bytes);
  } catch (const InputError& fault) {
    require_permitted(cache / file.name);
    throw CacheDamage(CacheFault::damaged, fault.what());
  }
}

Manifest manifest_of(const CacheContent& content) {
  Manifest manifest;
  manifest.storage = content.storage;
  manifest.identity = {content.scene_hash, options_hash(content)};
  manifest.camera = content.camera;
  manifest.view = content.image.view;
  manifest.objects = content.objects;
  manifest.lights = content.lights;
  manifest.shared = content.shared;
  manifest.noise = content.noise;
  manifest.pieces = content.pieces;
  return manifest;
}

std::string options_hash(const CacheContent& content) {
  Json options{{"camera", camera_json(content.camera)},
               {"samples", content.image.view.samples},
               {"max_depth", content.image.view.max_depth},
               {"shadow_bits", content.image.view.shadow_bits}};
  add_integrator(options, content.image.view);
  return hash128(bytes_of(options.dump()));
}

CacheAnswer read_manifest(const std::filesystem::path& path, Json& manifest) {
  try {
    Json document;
    static_cast<void>(load_manifest(path, &document));
    manifest = std::move(document);
    return {};
  } catch (const CacheDamage& damage) {
    return {damage.fault, damage.what()[0] == '\0' ? "" : std::string(kManifestName), damage.what()};
  }
}

}  // namespace relook
