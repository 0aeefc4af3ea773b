#include "page/index_page.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"
#include "frame/display_view.h"
#include "frame/frame_file.h"
#include "frame/sheet/contact_sheet.h"
#include "page/cut.h"
#include "page/page.h"

namespace relook {
namespace {

constexpr std::uint32_t kPictureWidth = 360;
constexpr std::size_t kLongestName = 160, kLongestNote = 600;  // bytes

std::string shown(std::string_view text) { return escaped_html(printable(text)); }

std::string count_text(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

bool is_number(const Json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_number();
}

/// The URL of a frame's picture; "" where the frame cannot be read.
std::string picture_url(const std::filesystem::path& frame, const PreviewStyle& style) {
  try {
    return png_url(encode_displayed(scaled_down(as_displayed(decode_exr(frame), style), kPictureWidth), style));
  } catch (const Error&) {
    return "";
  }
}

std::string facts_of(const Json& head) {
  const Json scene = head.value("scene", Json()), size = head.value("resolution", Json());
  std::string facts = std::filesystem::path(text_at(scene, "file")).filename().string();
  facts += ", camera " + text_at(head, "camera");
  if (size.is_array() && size.size() == 2) facts += ", " + size[0].dump() + " \u00d7 " + size[1].dump();
  return facts;
}

std::string verdict_html(const RunCard& card) {
  if (card.is_interrupted) return "<p class=\"bad\">interrupted: frames are missing</p>";
  if (card.verified_frames == 0) return "<p class=\"soft\">not verified</p>";
  if (card.pixels_different > 0)
    return "<p class=\"bad\">" + count_text(card.pixels_different, "pixel") + " differ from full renders</p>";
  const bool is_all = card.verified_frames == card.frames;
  return "<p class=\"good\">verified: " + std::string(is_all ? "all" : std::to_string(card.verified_frames)) +
         " frames equal full renders</p>";
}

std::string card_html(const RunCard& card) {
  std::string html = "<li>\n<a class=\"pictures\" href=\"" + escaped_html(card.link) + "\">";
  for (const RunCard::Picture& picture : card.pictures)
    html += "<img alt=\"" + shown(picture.text) + "\" src=\"" + escaped_html(picture.url) + "\">";
  html += "</a>\n<h2><a href=\"" + escaped_html(card.link) + "\">" + shown(cut_text(card.name, kLongestName)) +
          "</a></h2>\n";
  if (!card.note.empty()) html += "<p>" + shown(cut_text(card.note, kLongestNote)) + "</p>\n";
  html += "<p>" + count_text(card.steps, "step") + ", " + count_text(card.frames, "frame") + "</p>\n";
  html += "<p class=\"classes\">";
  for (const auto& [name, count] : card.classes)
    html += "<span>" + shown(name) + " " + std::to_string(count) + "</span> ";
  html += "</p>\n" + verdict_html(card) + "\n<p class=\"soft\">" + shown(card.facts) + "</p>\n";
  if (!card.report.empty()) html += "<p><a href=\"" + escaped_html(card.report) + "\" download>report.json</a></p>\n";
  return html + "</li>\n";
}

}  // namespace

RunCard run_card(const std::filesystem::path& run, const std::string& name, const Json& head,
                 const ReportEntries& entries, double exposure) {
  RunCard card;
  card.name = name;
  card.facts = facts_of(head);
  card.note = text_at(head.value("journal", Json()), "note");
  card.is_interrupted = head.value("interrupted", Json()) == true;
  std::string first, last;
  for (std::size_t i = 0; i < entries.count; ++i) {
    const Json entry = entries.at(i);
    const bool is_numbered = is_number(entry, "drag_frame") || is_number(entry, "wedge_frame");
    const std::string frame = text_at(entry, "frame");
    if (frame != last) ++card.frames;  // a drag or wedge as a whole names its last frame
    if (first.empty()) first = frame;
    const bool is_new = frame != last;
    last = frame;
    if (!is_numbered && is_number(entry, "step") && entry.at("step") > 0) {
      ++card.steps;
      ++card.classes[text_at(entry, "class")];
    }
    const auto verify = entry.find("verify");
    if (!is_new || verify == entry.end() || !verify->is_object()) continue;
    ++card.verified_frames;
    if (is_number(*verify, "pixels_different"))
      card.pixels_different += verify->at("pixels_different").get<std::uint64_t>();
  }
  const PreviewStyle style{display_view_of_environment(), exposure};
  for (const auto& [frame, what] : {std::pair(first, "first"), std::pair(last, "last")}) {
    if (frame.empty() || (frame == first && what == std::string_view("last"))) continue;
    const std::string url = picture_url(run / frame, style);
    if (!url.empty()) card.pictures.push_back({url, name + ", " + what + " frame"});
  }
  return card;
}

std::string relative_url(const std::filesystem::path& page, const std::filesystem::path& file) {
  std::error_code error;
  const auto full = [&](const std::filesystem::path& some) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(some, error), error);
  };
  const std::string path = full(file).lexically_relative(full(page).parent_path()).generic_string();
  std::string url;
  for (const char c : path) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                          std::string_view("-._~/").find(c) != std::string_view::npos;
    char escaped[8];
    std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
    url += is_plain ? std::string(1, c) : std::string(escaped);
  }
  return url;
}

std::string cards_html(const std::vector<RunCard>& cards) {
  std::string html = "<ul class=\"runs\">\n";
  for (const RunCard& card : cards) html += card_html(card);
  return html + "</ul>\n";
}

std::string index_text(const std::string& title, const std::vector<RunCard>& cards) {
  Page page;
  page.title = "relook: " + title;
  page.styles = {"index.css"};
  page.body = "<main>\n<h1>" + shown(title) + "</h1>\n<p class=\"soft\">" + count_text(cards.size(), "run") + "</p>\n" +
              cards_html(cards) + "</main>\n";
  return page_text(page);
}

}  // namespace relook
