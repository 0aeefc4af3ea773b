#include "page/page.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "page/page_assets.h"

namespace relook {
namespace {

const PageAsset& asset(std::string_view name) {
  const auto assets = page_assets();
  const auto found = std::ranges::find(assets, name, &PageAsset::name);
  require(found != assets.end(), "a page names assets that are built in");
  return *found;
}

/// " 'sha256-...'", as a Content-Security-Policy names a script or style.
std::string hash_source(const PageAsset& asset) {
  Bytes digest;
  for (std::size_t i = 0; i + 1 < asset.sha256.size(); i += 2)
    digest.push_back(static_cast<std::byte>(std::stoi(std::string(asset.sha256.substr(i, 2)), nullptr, 16)));
  return " 'sha256-" + base64(digest) + "'";
}

std::string policy(const Page& page) {
  std::string scripts, styles;
  for (const std::string_view name : page.scripts) scripts += hash_source(asset(name));
  for (const std::string_view name : page.styles) styles += hash_source(asset(name));
  // What a script of the page adds itself is admitted with it; nothing else is.
  if (page.has_files_beside) scripts += " 'strict-dynamic'";
  if (scripts.empty()) scripts = " 'none'";
  return "default-src 'none'; script-src" + scripts + "; style-src" + styles +
         "; img-src data: 'self' file:; base-uri 'none'; form-action 'none'";
}

}  // namespace

namespace {

/// Hands the text of the page over in pieces.
template <class Take>
void give_text(const Page& page, const Take& take) {
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  text += "<meta name=\"generator\" content=\"relook\">\n";
  text += "<meta http-equiv=\"Content-Security-Policy\" content=\"" + policy(page) + "\">\n";
  text += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  text += "<meta name=\"referrer\" content=\"no-referrer\">\n<link rel=\"icon\" href=\"data:,\">\n";
  text += "<title>" + escaped_html(page.title) + "</title>\n";
  for (const std::string_view name : page.styles)
    text.append("<style>").append(asset(name).text()).append("</style>\n");
  text.append("</head>\n<body>\n").append(page.body);
  take(text);
  for (const auto& [id, value] : page.data) {
    take("<script type=\"application/json\" id=\"" + escaped_html(id) + "\">");
    take(value);
    take("</script>\n");
  }
  for (const std::string_view name : page.scripts) {
    take("<script>");
    take(asset(name).text());
    take("</script>\n");
  }
  take("</body>\n</html>\n");
}

}  // namespace

std::string page_text(const Page& page) {
  std::string text;
  give_text(page, [&](std::string_view piece) { text += piece; });
  return text;
}

void write_page(const std::filesystem::path& path, const Page& page) {
  FileWriter file(path);
  give_text(page, [&](std::string_view piece) { file.append(piece); });
  file.publish();
}

std::size_t frame_bytes(const Page& page) {
  std::size_t bytes = 0, data = 0;
  give_text(page, [&](std::string_view piece) { bytes += piece.size(); });
  for (const auto& [id, value] : page.data) data += value.size();
  return bytes - data;
}

std::string_view asset_text(std::string_view name) { return asset(name).text(); }

std::string with_viewer(std::string_view body) {
  constexpr std::string_view kPlace = "{{viewer}}";
  const std::size_t place = body.find(kPlace);
  require(place != body.npos, "a body with a viewer has a place for it");
  std::string text(body);
  return text.replace(place, kPlace.size(), asset_text("viewer.html"));
}

std::string escaped_html(std::string_view text) {
  std::string escaped;
  for (const char c : without_reordering(text)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string script_json(const Json& value) {
  const std::string text = without_reordering(json_text(value));
  std::string escaped;
  escaped.reserve(text.size() + text.size() / 64);
  for (const char c : text) {
    if (c == '<')
      escaped += "\\u003c";
    else if (c == '>')
      escaped += "\\u003e";
    else if (c == '&')
      escaped += "\\u0026";
    else
      escaped += c;
  }
  return escaped;
}

std::string base64(BytesView bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < here ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= here ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string png_url(BytesView png) { return "data:image/png;base64," + base64(png); }

}  // namespace relook
