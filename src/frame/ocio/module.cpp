// The module behind frame/display_view.h. The only file that sees OpenColorIO.
#include <OpenColorIO/OpenColorIO.h>

#include <array>

#include "frame/display_view.h"

namespace ocio = OCIO_NAMESPACE;

namespace {

/// Names of scene-linear Rec.709 in the configs of the field: of the ACES and Blender configs, and aliases.
constexpr std::array kLinearRec709{"lin_rec709",    "Linear Rec.709 (sRGB)", "lin_rec709_scene",
                                   "lin_srgb",      "Linear Rec.709",        "Utility - Linear - sRGB",
                                   "Linear BT.709", "Linear sRGB",           "linrec709_d65"};

/// The name of the frames' colour space; where none has a known name, the config's own linear space.
std::string source_space(const ocio::Config& config) {
  for (const char* name : kLinearRec709)
    if (config.getColorSpace(name)) return name;
  if (config.hasRole(ocio::ROLE_SCENE_LINEAR)) return ocio::ROLE_SCENE_LINEAR;
  throw ocio::Exception("it has neither a linear Rec.709 color space nor a scene_linear role");
}

class OcioView final : public relook::DisplayView {
 public:
  explicit OcioView(const char* file) {
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file);
    const std::string display = config->getDefaultDisplay();
    const std::string view = display.empty() ? "" : config->getDefaultView(display.c_str());
    if (view.empty()) throw ocio::Exception("it has no display with a view");
    const std::string source = source_space(*config);
    const ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
    transform->setSrc(source.c_str());
    transform->setDisplay(display.c_str());
    transform->setView(view.c_str());
    const ocio::ConstProcessorRcPtr processor = config->getProcessor(transform);
    processor_ = processor->getDefaultCPUProcessor();
    name_ = display + ", " + view;
    id_ = std::string(processor_->getCacheID()) + " " + source + " " + display + " " + view;
  }
  [[nodiscard]] relook::Rgba apply(const relook::Rgba& linear) const override {
    relook::Rgba value = linear;
    processor_->applyRGBA(&value.r);
    return value;
  }
  [[nodiscard]] std::string id() const override { return id_; }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  ocio::ConstCPUProcessorRcPtr processor_;
  std::string id_, name_;
};

}  // namespace

extern "C" std::shared_ptr<const relook::DisplayView> relook_open_view(const char* config, std::string& error) {
  ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE);  // what is wrong is said once, by us
  try {
    return std::make_shared<const OcioView>(config);
  } catch (const std::exception& exception) {
    error = exception.what();
    return nullptr;
  }
}
