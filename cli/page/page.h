// A web page of one file that works from disk, offline: scripts and styles are built into the program and stand in the
// page, admitted by their hashes (Content-Security-Policy); data stands in it as JSON, which nothing executes. Whatever
// comes from scenes and journals is data, and scripts show it as text only. Made by run_page.h and compare_page.h.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/files.h"
#include "base/json.h"

namespace relook {

struct Page {
  std::string title;                                      // any text
  std::vector<std::string_view> styles, scripts;          // names of files in assets/, in their order in the page
  std::string body;                                       // HTML; what it holds of data is escaped
  std::vector<std::pair<std::string, std::string>> data;  // JSON as script_json() writes it, by its element's id
  bool has_files_beside = false;                          // scripts may load data scripts from beside the page
};

[[nodiscard]] std::string page_text(const Page& page);
/// Writes the text to a file, piece by piece: a page may be larger than what one would want twice in memory. Throws
/// IoError, ResourceError.
void write_page(const std::filesystem::path& path, const Page& page);
/// Bytes of the page without its data.
[[nodiscard]] std::size_t frame_bytes(const Page& page);

/// The text of a file in assets/, such as the body of a page. Requires: it is built in.
[[nodiscard]] std::string_view asset_text(std::string_view name);

/// A body with the viewer of two frames, viewer.html, where it says {{viewer}}. Requires: it does.
[[nodiscard]] std::string with_viewer(std::string_view body);

/// Text as HTML shows it, in elements and in quoted attributes.
[[nodiscard]] std::string escaped_html(std::string_view text);
/// JSON that may stand in a script element: no "<", no ">", no "&".
[[nodiscard]] std::string script_json(const Json& value);

[[nodiscard]] std::string base64(BytesView bytes);
/// "data:image/png;base64,..."
[[nodiscard]] std::string png_url(BytesView png);

}  // namespace relook
