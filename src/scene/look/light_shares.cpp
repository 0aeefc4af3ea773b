#include "scene/look/light_shares.h"

#include <map>

#include "scene/compile/compile_material.h"
#include "scene/look/look_check.h"

namespace relook {
namespace {

/// By light: how many nodes place it; no entry: none does.
std::map<std::string, std::size_t> placements_of(const LookDocument& document) {
  std::map<std::string, std::size_t> placements;
  for (const Json& node : document.look.at("nodes"))
    if (const Json* light = light_name_of(node)) ++placements[light->get_ref<const std::string&>()];
  return placements;
}

bool has_member(const Json& light, std::string_view key) {
  return member_at(light, {"extras", "relook", key}) != nullptr;
}

/// Lights that nodes place and that have a sum of their own.
std::size_t lights_alone(const LookDocument& document, const std::map<std::string, std::size_t>& placements) {
  std::size_t alone = 0;
  for (const auto& [name, count] : placements) {
    const Json* sum = member_at(document.look.at("lights").at(name), {"extras", "relook", "sum"});
    if (sum == nullptr || sum->get_ref<const std::string&>().empty()) alone += count;
  }
  return alone;
}

/// The largest power of two with which so many lights have kLightsAlone samples at most, but not below kLeastRate.
double rate_of(std::size_t lights) {
  double rate = 1;
  while (static_cast<double>(lights) * rate > static_cast<double>(kLightsAlone) && rate > kLeastRate) rate /= 2;
  return rate;
}

}  // namespace

void write_light_shares(LookDocument& document, std::span<const std::string> names) {
  const std::map<std::string, std::size_t> placements = placements_of(document);
  const auto count_of = [&](const std::string& name) {
    const auto found = placements.find(name);
    return found == placements.end() ? std::size_t{0} : found->second;
  };
  std::size_t all = 0;
  for (const auto& [name, count] : placements) all += count;
  if (all <= kLightsAlone) return;
  Json& lights = document.look.at("lights");
  std::size_t alone = lights_alone(document, placements);
  for (const std::string& name : names)
    if (lights.contains(name) && !has_member(lights[name], "sum")) alone -= count_of(name);
  for (const std::string& name : names) {
    if (!lights.contains(name)) continue;
    Json& light = lights[name];
    const bool is_named = has_member(light, "sum"), is_rated = has_member(light, "rate");
    if (!is_named && alone + count_of(name) > kLightsAlone) set_relook_extra(light, "sum", kSumOfOthers);
    if (!is_named && !has_member(light, "sum")) alone += count_of(name);
    if (!is_rated) set_relook_extra(light, "rate", rate_of(all));
  }
}

}  // namespace relook
