// Tells the frames that relook has written from other people's, by their headers.
#include <openexr.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "base/tiles.h"
#include "frame/frame_file.h"

namespace relook {
namespace {

constexpr std::array<std::string_view, 11> kPlainAttributes{
    "type",  "channels",         "compression",        "dataWindow",        "displayWindow", "lineOrder",
    "tiles", "pixelAspectRatio", "screenWindowCenter", "screenWindowWidth", "chromaticities"};

void say_nothing(exr_const_context_t, exr_result_t, const char*) {}

struct FinishFile {
  void operator()(exr_context_t context) const { exr_finish(&context); }
};

bool is_our_attribute(std::string_view name) {
  return name.starts_with("relook:") || name.starts_with("cryptomatte/") ||
         std::ranges::find(kPlainAttributes, name) != kPlainAttributes.end();
}

/// What the attributes say; none if there is one that relook does not write.
std::optional<FrameMeta> meta_of(exr_const_context_t file) {
  std::int32_t count = 0;
  if (exr_get_attribute_count(file, 0, &count) != EXR_ERR_SUCCESS) return std::nullopt;
  FrameMeta meta;
  bool names_scene = false;
  for (std::int32_t i = 0; i < count; ++i) {
    const exr_attribute_t* attribute = nullptr;
    if (exr_get_attribute_by_index(file, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) != EXR_ERR_SUCCESS ||
        !is_our_attribute(attribute->name))
      return std::nullopt;
    const std::string_view name = attribute->name;
    names_scene = names_scene || name == "relook:scene";
    const auto text = std::ranges::find(kFrameAttributes, name, [](const auto& known) { return known.first; });
    if (text != kFrameAttributes.end() && attribute->type == EXR_ATTR_STRING && attribute->string->length > 0)
      (meta.*text->second).assign(attribute->string->str, static_cast<std::size_t>(attribute->string->length));
  }
  return names_scene ? std::optional(std::move(meta)) : std::nullopt;
}

}  // namespace

std::optional<FrameMeta> own_frame_meta(const std::filesystem::path& path) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = say_nothing;
  exr_context_t opened = nullptr;
  if (exr_start_read(&opened, path.c_str(), &setup) != EXR_ERR_SUCCESS) {
    if (opened != nullptr) exr_finish(&opened);
    return std::nullopt;
  }
  const std::unique_ptr<std::remove_pointer_t<exr_context_t>, FinishFile> context(opened);
  int parts = 0;
  exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
  exr_compression_t compression = EXR_COMPRESSION_NONE;
  const bool has_our_form = exr_get_count(opened, &parts) == EXR_ERR_SUCCESS && parts == 1 &&
                            exr_get_storage(opened, 0, &storage) == EXR_ERR_SUCCESS && storage == EXR_STORAGE_TILED &&
                            exr_get_compression(opened, 0, &compression) == EXR_ERR_SUCCESS &&
                            compression == EXR_COMPRESSION_ZIP;
  return has_our_form ? meta_of(opened) : std::nullopt;
}

bool is_own_frame(const std::filesystem::path& path) { return own_frame_meta(path).has_value(); }

}  // namespace relook
