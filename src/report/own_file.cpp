#include "report/own_file.h"

#include <algorithm>
#include <array>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "edit/draft/journal_draft.h"
#include "frame/frame_file.h"
#include "frame/preview.h"
#include "report/line_reader.h"
#include "scene/export/export_gltf.h"

namespace relook {
namespace {

/// The first bytes of a file, as many as there are.
std::string start_of(const std::filesystem::path& path, std::size_t bytes) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) return "";
  return LineReader(path).read_at(0, std::min<std::uintmax_t>(size, bytes));
}

bool starts_with(const std::filesystem::path& path, std::string_view start) {
  return start_of(path, start.size()) == start;
}

/// The member `relook` of a JSON file: "report/1".
std::string format_of(const std::filesystem::path& path) {
  const Bytes bytes = read_file(path);
  const Json document = parse_json(text_of(bytes), path.string());
  if (!document.is_object() || !document.contains("relook") || !document["relook"].is_string()) return "";
  return document["relook"].get<std::string>();
}

bool has_format(const std::filesystem::path& path, std::string_view prefix) {
  return format_of(path).starts_with(prefix);
}

/// Whether the file begins like a line of progress.jsonl, of which the first may have been cut short anywhere.
bool starts_like_progress(std::string_view start) {
  constexpr std::size_t kHashDigits = 32;
  constexpr std::string_view kHead = " {\"relook\":\"progress/";
  const std::string_view hash = start.substr(0, kHashDigits);
  if (hash.find_first_not_of("0123456789abcdef") != std::string_view::npos) return false;
  const std::string_view rest = start.substr(hash.size());
  return rest.substr(0, kHead.size()) == kHead.substr(0, rest.size());
}

bool is_of_kind(const std::filesystem::path& path, OwnKind kind) {
  switch (kind) {
    case OwnKind::frame:
      return is_own_frame(path);
    case OwnKind::preview:
      return is_own_preview(start_of(path, 64));
    case OwnKind::page:
      return start_of(path, 512).find("<meta name=\"generator\" content=\"relook\">") != std::string::npos;
    case OwnKind::page_data:
      return starts_with(path, "relook_");
    case OwnKind::report:
      return starts_with(path, "{\n  \"relook\": \"report/") || has_format(path, "report/");
    case OwnKind::progress:
      return starts_like_progress(start_of(path, 64));
    case OwnKind::comparison:
      return has_format(path, "compare/");
    case OwnKind::plan:
      return has_format(path, "plan/");
    case OwnKind::trace:
      return has_format(path, "trace/");
    case OwnKind::access_log:
      return starts_with(path, "relook-access/");
    case OwnKind::journal:
      return is_generated_journal(text_of(read_file(path)));
    case OwnKind::scene:
      return is_exported_scene(read_file(path));
  }
  return false;
}

}  // namespace

std::string_view own_kind_name(OwnKind kind) {
  constexpr std::array<std::string_view, 12> kNames{
      "a frame",      "a preview", "a page",  "a page's data", "the report of a run", "the notes of a run",
      "a comparison", "a plan",    "a trace", "an access log", "a journal",           "an export"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool is_own_file(const std::filesystem::path& path, OwnKind kind) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    return is_of_kind(path, kind);
  } catch (const Error&) {
    return false;
  } catch (const Json::exception&) {
    return false;
  }
}

}  // namespace relook
