// Several wrong places of one input, found in one go.
#pragma once
#include <string>

#include "base/error.h"

namespace relook {

/// what() is what() of an InputError a line, with "\n" between them.
class InputErrors : public Error {
 public:
  explicit InputErrors(std::string lines) : Error(ExitCode::bad_input, "", "", lines), lines_(std::move(lines)) {}
  [[nodiscard]] const char* what() const noexcept override { return lines_.c_str(); }

 private:
  std::string lines_;
};

}  // namespace relook
