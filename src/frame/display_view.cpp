#include "frame/display_view.h"

#include <cstdlib>

#include "base/error.h"
#include "base/parallel.h"
#include "base/system/module.h"

namespace relook {

std::shared_ptr<const DisplayView> display_view_of_environment() {
  const char* config = std::getenv("OCIO");
  if (config == nullptr || *config == '\0') return nullptr;
  static auto* const open =
      reinterpret_cast<OpenDisplayView*>(module_function("librelook_views.so", "relook_open_view", "use $OCIO"));
  std::string error;
  std::shared_ptr<const DisplayView> view = open(config, error);
  set_float_mode();
  for (char& c : error)
    if (c == '\n' || c == '\t') c = ' ';
  if (!view) throw InputError(config, "", "$OCIO names no usable OpenColorIO config: " + error);
  return view;
}

}  // namespace relook
