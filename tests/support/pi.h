// Pi, once for all tests and oracles.
#pragma once
#include <numbers>

namespace relook {

inline constexpr double kPi = std::numbers::pi;

}  // namespace relook
