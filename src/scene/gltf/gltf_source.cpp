#include "scene/gltf/gltf_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>

#include "base/error.h"
#include "base/import_memory.h"
#include "scene/gltf/gltf_json.h"
#include "scene/gltf/import_rules.h"

namespace relook {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kGlbHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t little_endian_32(BytesView bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

[[noreturn]] void fail_at(const std::string& file, std::size_t offset, std::string_view what) {
  throw InputError(file, "byte " + std::to_string(offset), what);
}

void read_json(std::string_view text, GltfSource& source) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    tolerate(source.file, "byte 0", "starts with a byte order mark", source.warnings);
    text.remove_prefix(kByteOrderMark.size());
  }
  source.json = parse_json(text, source.file);
  JsonView(source.json, source.file).require_object();
}

/// The bytes that the header counts: bytes behind them are ignored.
BytesView glb_content(BytesView bytes, GltfSource& source) {
  const std::string& file = source.file;
  if (bytes.size() < kGlbHeaderBytes) fail_at(file, bytes.size(), "the GLB header is cut short");
  if (little_endian_32(bytes, 0) != kGlbMagic) fail_at(file, 0, "is not a GLB file");
  if (const auto version = little_endian_32(bytes, 4); version != 2)
    fail_at(file, 4, "GLB version " + std::to_string(version) + " is not supported");
  const std::size_t length = little_endian_32(bytes, 8);
  if (length == bytes.size()) return bytes;
  const std::string fault =
      "the GLB header says " + std::to_string(length) + " bytes, the file has " + std::to_string(bytes.size());
  if (length > bytes.size() || length < kGlbHeaderBytes) fail_at(file, 8, fault);
  tolerate(file, "byte 8", fault, source.warnings);
  return bytes.first(length);
}

/// Chunks must fill the counted bytes exactly: JSON first, at most one BIN, second; chunks of unknown types are
/// skipped.
void read_glb(BytesView file, GltfSource& source) {
  const BytesView bytes = glb_content(file, source);
  std::size_t offset = kGlbHeaderBytes;
  for (std::size_t index = 0; offset < bytes.size(); ++index) {
    if (bytes.size() - offset < kChunkHeaderBytes) {
      if (index == 0) fail_at(source.file, offset, "a chunk header is cut short");
      tolerate(source.file, "byte " + std::to_string(offset), "a chunk header is cut short", source.warnings);
      break;
    }
    const std::size_t length = little_endian_32(bytes, offset);
    const std::uint32_t type = little_endian_32(bytes, offset + 4);
    if (length % 4 != 0) fail_at(source.file, offset, "the chunk's length is not a multiple of 4");
    if (length > bytes.size() - offset - kChunkHeaderBytes)
      fail_at(source.file, offset, "the chunk is longer than the rest of the file");
    const BytesView content = bytes.subspan(offset + kChunkHeaderBytes, length);
    if ((index == 0) != (type == kJsonChunk)) fail_at(source.file, offset, "the first chunk, and no other, is JSON");
    if (type == kJsonChunk) {
      read_json(text_of(content), source);
    } else if (type == kBinaryChunk) {
      if (index != 1) fail_at(source.file, offset, "the binary chunk is not the second chunk");
      source.has_binary_chunk = true;
      source.binary_chunk.assign(content.begin(), content.end());
    }
    offset += kChunkHeaderBytes + length;
  }
  if (source.json.is_null()) fail_at(source.file, offset, "the GLB file has no JSON chunk");
}

std::array<std::int8_t, 256> base64_digits() {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> digits;
  digits.fill(-1);
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
  return digits;
}

bool is_white_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// RFC 4648; the padding may be left out, lines may be broken, anything else is an error.
Bytes base64_decoded(std::string text, const JsonView& place) {
  std::erase_if(text, is_white_space);
  while (!text.empty() && text.back() == '=') text.pop_back();
  if (text.size() % 4 == 1) place.fail("the base64 data is cut short");
  const auto digits = base64_digits();
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int digit = digits[static_cast<unsigned char>(text[i])];
    if (digit < 0) place.fail("base64 data with a character that is not base64, at " + std::to_string(i));
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xFFU));
  }
  return bytes;
}

/// Whether two texts are equal but for the case of ASCII letters; `lower` has none in upper case.
bool is_same_word(std::string_view text, std::string_view lower) {
  return std::ranges::equal(text, lower, [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return is_same_word(uri.substr(0, kScheme.size()), kScheme);
}

Bytes data_uri_content(std::string_view uri, const JsonView& place) {
  const auto comma = uri.find(',');
  if (comma == std::string_view::npos) place.fail("a data URI without a comma");
  const std::string_view header = uri.substr(0, comma), content = uri.substr(comma + 1);
  if (header.find(";;") != std::string_view::npos) place.fail("a data URI with an empty parameter");
  constexpr std::string_view kBase64 = ";base64";
  const std::string plain = percent_decoded(content, place.file(), place.pointer());
  if (header.size() >= kBase64.size() && is_same_word(header.substr(header.size() - kBase64.size()), kBase64))
    return base64_decoded(plain, place);
  const BytesView bytes = bytes_of(plain);
  return {bytes.begin(), bytes.end()};
}

std::filesystem::path external_path(const GltfSource& source, const JsonView& place, const std::string& uri) {
  const std::string name = percent_decoded(uri, source.file, place.pointer());
  return allowed_path(source.folder, name, source.file, place.pointer());
}

Bytes read_external(const std::filesystem::path& path, const JsonView& place) {
  std::error_code is_no_file;
  const std::uintmax_t size = std::filesystem::file_size(path, is_no_file);
  require_import_memory(is_no_file ? 0 : size, place.file(), place.pointer() + ": the file");
  try {
    return read_file(path);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
}

/// Empty for a placeholder: a buffer without a uri, which only extensions give a meaning.
std::vector<unsigned char> load_buffer(GltfSource& source, const JsonView& buffer, std::size_t index) {
  const auto length = static_cast<std::size_t>(buffer.at("byteLength").integer(1, INT64_MAX));
  Bytes bytes;
  if (const auto uri = member(buffer, "uri")) {
    const std::string text = uri->text();
    bytes = is_data_uri(text) ? data_uri_content(text, *uri) : read_external(external_path(source, *uri, text), *uri);
  } else if (index == 0 && source.has_binary_chunk) {
    bytes = std::move(source.binary_chunk);
    source.has_binary_chunk = false;
  } else if (index == 0 && source.is_glb) {
    buffer.fail("has no uri, and the GLB file has no binary chunk");
  } else {
    return {};
  }
  if (bytes.size() < length)
    buffer.at("byteLength")
        .fail("says " + std::to_string(length) + " bytes, the data has " + std::to_string(bytes.size()));
  std::vector<unsigned char> result(length);
  std::memcpy(result.data(), bytes.data(), length);
  return result;
}

/// Reads images one by one; what several images name is read and kept once.
class ImageLoader {
 public:
  ImageLoader(const GltfSource& source, const std::vector<std::vector<unsigned char>>& buffers)
      : source_(source), buffers_(buffers) {
    for (const auto& buffer : buffers) copyable_bytes_ += buffer.size();
  }

  /// None for an image that has neither a buffer view nor a uri.
  std::shared_ptr<const Bytes> load(const JsonView& image) {
    if (const auto view = member(image, "bufferView")) return load_view(*view);
    const auto uri = member(image, "uri");
    if (!uri) return nullptr;
    const std::string text = uri->text();
    auto bytes = is_data_uri(text) ? kept(data_uri_content(text, *uri), *uri) : load_file(*uri);
    if (bytes->empty()) throw MissingFileError(uri->file(), uri->pointer(), "the image is empty");
    return bytes;
  }

 private:
  std::shared_ptr<const Bytes> load_view(const JsonView& place) {
    const auto index = static_cast<std::size_t>(place.integer(0, INT64_MAX));
    auto& bytes = by_view_[index];
    if (bytes) return bytes;
    const Json& view = source_.json["bufferViews"][index];
    const std::span<const unsigned char> buffer(buffers_[view["buffer"].get<std::size_t>()]);
    if (buffer.empty()) place.fail("the buffer of this buffer view has no data");
    const auto length = view["byteLength"].get<std::size_t>();
    if (length > copyable_bytes_) place.fail("the buffer views of the images overlap");
    copyable_bytes_ -= length;
    const BytesView part = std::as_bytes(buffer.subspan(view.value("byteOffset", std::size_t{0}), length));
    bytes = kept(Bytes(part.begin(), part.end()), place);
    return bytes;
  }
  std::shared_ptr<const Bytes> load_file(const JsonView& place) {
    const auto path = external_path(source_, place, place.text());
    auto& bytes = by_path_[path];
    if (!bytes) bytes = kept(read_external(path, place), place);
    return bytes;
  }
  static std::shared_ptr<const Bytes> kept(Bytes bytes, const JsonView& place) {
    ImportShare share(bytes.size(), place.file(), place.pointer() + ": the image");
    return kept_with(std::move(share), std::move(bytes));
  }

  const GltfSource& source_;
  const std::vector<std::vector<unsigned char>>& buffers_;
  std::map<std::size_t, std::shared_ptr<const Bytes>> by_view_;
  std::map<std::filesystem::path, std::shared_ptr<const Bytes>> by_path_;
  std::size_t copyable_bytes_ = 0;  // images that do not overlap need no more than all buffers hold
};

int hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

GltfSource read_gltf_source(const std::filesystem::path& path) {
  GltfSource source;
  source.file = path.string();
  source.folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const Bytes bytes = read_file(path);
  const bool has_magic = bytes.size() >= 4 && little_endian_32(bytes, 0) == kGlbMagic;
  source.is_glb = has_magic || path.extension() == ".glb";
  if (source.is_glb)
    read_glb(bytes, source);
  else
    read_json(text_of(bytes), source);
  return source;
}

std::vector<std::vector<unsigned char>> load_buffers(GltfSource& source, ImportShare& share) {
  std::vector<std::vector<unsigned char>> buffers;
  const JsonView root(source.json, source.file);
  std::vector<bool> has_views(array_size(root, "buffers"));
  for_each_object(root, "bufferViews", [&](const JsonView& view, std::size_t) {
    has_views[reference(view.at("buffer"), has_views.size(), "buffer")] = true;
  });
  for_each_object(root, "buffers", [&](const JsonView& buffer, std::size_t index) {
    try {
      buffers.push_back(load_buffer(source, buffer, index));
    } catch (const MissingFileError&) {
      if (has_views[index]) throw;
      tolerate(source.file, buffer.pointer() + "/uri", "no such file; no buffer view names it: ignored", source.warnings);
      buffers.emplace_back();
    }
    share.add(ImportShare(buffers.back().size(), source.file, buffer.pointer() + ": the buffer"));
  });
  return buffers;
}

std::vector<EncodedImage> load_images(const GltfSource& source, const std::vector<std::vector<unsigned char>>& buffers,
                                      const std::vector<bool>& used, std::vector<std::string>& warnings) {
  std::vector<EncodedImage> images;
  ImageLoader loader(source, buffers);
  for_each_object(JsonView(source.json, source.file), "images", [&](const JsonView& image, std::size_t i) {
    images.emplace_back();
    const auto uri = member(image, "uri");
    if (!uri && image.has("bufferView") && !image.has("mimeType"))
      tolerate(source.file, image.pointer(), "\"mimeType\" is missing", warnings);
    try {
      images.back().bytes = loader.load(image);
    } catch (const InputError& error) {
      const bool is_just_useless =
          dynamic_cast<const MissingFileError*>(&error) != nullptr || (uri && is_data_uri(uri->text()));
      if (used[i] || !is_just_useless) throw;
      tolerate(source.file, image.pointer() + "/uri", "there is no image; the scene can do without: ignored", warnings);
    }
  });
  return images;
}

std::vector<std::filesystem::path> external_files(const GltfSource& source) {
  std::vector<std::filesystem::path> paths;
  for (const char* section : {"buffers", "images"}) {
    if (!source.json.contains(section) || !source.json[section].is_array()) continue;
    for (const Json& entry : source.json[section]) {
      const bool has_uri = entry.is_object() && entry.contains("uri") && entry["uri"].is_string();
      if (!has_uri || is_data_uri(entry["uri"].get_ref<const std::string&>())) continue;
      try {
        paths.push_back(external_path(source, JsonView(entry, source.file), entry["uri"].get<std::string>()));
      } catch (const InputError&) {  // who reads the scene says so
      }
    }
  }
  return paths;
}

std::string percent_decoded(std::string_view uri, std::string_view file, std::string_view where) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      decoded += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hexadecimal_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hexadecimal_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) throw InputError(file, where, "\"%\" must be followed by two hexadecimal digits");
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return decoded;
}

}  // namespace relook
