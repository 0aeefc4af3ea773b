#include "physics/sheen.h"

#include <algorithm>
#include <cmath>

namespace relook {
namespace {

constexpr int kSteps = 10;
// Midpoint integration over 40 x 40 directions; rows: roughness 0 .. 1, columns: sqrt(cosine) 0 .. 1.
constexpr float kAlbedo[kSteps][kSteps] = {
    {1.0000F, 1.0000F, 1.0000F, 0.5879F, 0.1041F, 0.0076F, 0.0001F, 0.0000F, 0.0000F, 0.0000F},
    {1.0000F, 1.0000F, 1.0000F, 0.8173F, 0.2928F, 0.0696F, 0.0088F, 0.0004F, 0.0000F, 0.0000F},
    {1.0000F, 1.0000F, 1.0000F, 0.8307F, 0.5033F, 0.2629F, 0.1114F, 0.0338F, 0.0053F, 0.0000F},
    {1.0000F, 1.0000F, 0.9557F, 0.7310F, 0.5222F, 0.3430F, 0.2007F, 0.0982F, 0.0341F, 0.0034F},
    {1.0000F, 0.9437F, 0.8024F, 0.6508F, 0.5038F, 0.3688F, 0.2503F, 0.1513F, 0.0738F, 0.0191F},
    {0.8704F, 0.8118F, 0.7069F, 0.5934F, 0.4813F, 0.3749F, 0.2767F, 0.1882F, 0.1106F, 0.0449F},
    {0.7755F, 0.7283F, 0.6439F, 0.5525F, 0.4616F, 0.3741F, 0.2912F, 0.2133F, 0.1407F, 0.0734F},
    {0.7123F, 0.6721F, 0.6004F, 0.5229F, 0.4458F, 0.3712F, 0.2995F, 0.2307F, 0.1643F, 0.0998F},
    {0.6683F, 0.6326F, 0.5692F, 0.5011F, 0.4335F, 0.3678F, 0.3045F, 0.2431F, 0.1828F, 0.1226F},
    {0.6364F, 0.6039F, 0.5463F, 0.4847F, 0.4237F, 0.3647F, 0.3077F, 0.2521F, 0.1972F, 0.1416F},
};

}  // namespace

float sheen_albedo(float cosine, float roughness) {
  const float x = std::sqrt(std::clamp(cosine, 0.0F, 1.0F)) * (kSteps - 1);
  const float y = std::clamp(roughness, 0.0F, 1.0F) * (kSteps - 1);
  const int column = std::min(static_cast<int>(x), kSteps - 2), row = std::min(static_cast<int>(y), kSteps - 2);
  const float u = x - static_cast<float>(column), v = y - static_cast<float>(row);
  const auto along = [&](int r) { return kAlbedo[r][column] * (1.0F - u) + kAlbedo[r][column + 1] * u; };
  return along(row) * (1.0F - v) + along(row + 1) * v;
}

}  // namespace relook
