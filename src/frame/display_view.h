// Display views of OpenColorIO configs, for previews. OpenColorIO stands in a module of its own (base/system/module.h),
// loaded when $OCIO is set.
#pragma once
#include <memory>
#include <string>

#include "base/math.h"

namespace relook {

/// A display and a view of a config. Threads may share it.
class DisplayView {
 public:
  virtual ~DisplayView() = default;
  /// Scene-linear Rec.709 to display values, 0..1 where they are codes.
  [[nodiscard]] virtual Rgba apply(const Rgba& linear) const = 0;
  /// Config, display and view in one text: equal ones show the same.
  [[nodiscard]] virtual std::string id() const = 0;
  /// For people: "Display, View".
  [[nodiscard]] virtual std::string name() const = 0;
};

/// How previews show frames.
struct PreviewStyle {
  std::shared_ptr<const DisplayView> view;  // null: sRGB
  double exposure = 0;                      // stops: linear colours times 2^exposure, before the view
};
/// Exposures are finite, and of this size at most.
inline constexpr double kMostExposure = 100;

/// What the module exports, as relook_open_view: the default view of the default display of a config file. Null:
/// `error` says why, in one or more lines.
using OpenDisplayView = std::shared_ptr<const DisplayView>(const char* config, std::string& error);

/// That of the config that $OCIO names; null when it is not set, or empty. Throws InputError when the config cannot be
/// used, Error without the module.
[[nodiscard]] std::shared_ptr<const DisplayView> display_view_of_environment();

}  // namespace relook
