// WebP images through libwebp, for module.cpp: OpenImageIO 2.4 gives their colours multiplied by alpha, whatever it is
// asked for.
#pragma once
#include "scene/texture/image_library.h"

namespace relook {

/// As OpenImageReader, for the format "webp". Reads the header alone; the image is decoded as a whole when its first
/// rows are asked for.
[[nodiscard]] std::unique_ptr<ImageReader> open_webp(std::span<const std::byte> bytes, std::string& error);

}  // namespace relook
