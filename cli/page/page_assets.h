// The styles, scripts and bodies of pages that are built into the program: embed.cmake writes page_assets() from the
// files in assets/. Seen by page.cpp alone.
#pragma once
#include <cstddef>
#include <span>
#include <string_view>

namespace relook {

struct PageAsset {
  std::string_view name;  // of the file: "report.js"
  const unsigned char* bytes = nullptr;
  std::size_t size = 0;
  std::string_view sha256;  // 64 hexadecimal digits
  [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(bytes), size}; }
};

[[nodiscard]] std::span<const PageAsset> page_assets();

}  // namespace relook
