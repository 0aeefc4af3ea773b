#include "page/cut.h"

namespace relook {
namespace {

constexpr std::size_t kMostParts = 64;  // of an array or object
constexpr int kDeepest = 8;

}  // namespace

std::string cut_text(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "…";
}

Json cut_json(const Json& value, std::size_t longest, int depth) {
  if (value.is_string()) return cut_text(value.get_ref<const std::string&>(), longest);
  if (!value.is_structured()) return value;
  if (depth == kDeepest) return "…";
  Json shorter = value.is_array() ? Json::array() : Json::object();
  std::size_t count = 0;
  for (const auto& [key, part] : value.items()) {
    if (++count > kMostParts) break;
    if (value.is_array())
      shorter.push_back(cut_json(part, longest, depth + 1));
    else
      shorter[cut_text(key, longest)] = cut_json(part, longest, depth + 1);
  }
  if (count > kMostParts) {
    const std::string more = "… " + std::to_string(value.size() - kMostParts) + " more";
    if (value.is_array())
      shorter.push_back(more);
    else
      shorter["…"] = more;
  }
  return shorter;
}

std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace relook
