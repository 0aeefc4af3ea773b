#include "options/version_text.h"

#include "base/system/sandbox.h"
#include "cache/arithmetic.h"
#include "cache/container.h"
#include "report/report.h"

namespace relook {

std::string version_text() {
  return "relook " + std::string(program_version()) + "\n" + arithmetic_text(own_arithmetic()) + "\ncache format " +
         std::to_string(kCacheFormat) + "\nsandbox: " + sandbox_text();
}

}  // namespace relook
