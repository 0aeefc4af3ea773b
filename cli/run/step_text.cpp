#include "run/step_text.h"

#include <utility>

#include "base/error.h"

namespace relook {

std::string label_of(const StepReport& entry) {
  return entry.is_whole_step ? std::to_string(entry.place.step) : step_label(entry.place);
}

std::string line_of(const StepReport& entry) {
  const Counters& counters = entry.counters;
  std::string line = label_of(entry) + " " + std::string(change_class_name(entry.change)) + " \"" +
                     printable(entry.name) + "\": " + std::to_string(counters.pixels_changed) + " pixels changed, " +
                     std::to_string(counters.ray_updates) + " ray updates, " + std::to_string(counters.shadow_updates) +
                     " shadow updates, " + std::to_string(entry.seconds.total) + " s";
  if (entry.verify)
    line += ", verified: " + std::to_string(entry.verify->pixels_different) + " of " +
            std::to_string(entry.verify->pixels_compared) + " pixels differ";
  return line;
}

std::string noise_text(const std::optional<double>& noise) {
  if (!noise) return "";
  char text[48];
  std::snprintf(text, sizeof text, ", noise %.2g %%", 100 * *noise);
  return text;
}

void trace_step(const StepReport& step, std::chrono::steady_clock::time_point start, TraceFile& trace) {
  const Seconds& seconds = step.seconds;
  const Counters& counters = step.counters;
  trace.span(label_of(step) + " " + step.name, start, seconds.total,
             {{"class", change_class_name(step.change)},
              {"pixels_changed", counters.pixels_changed},
              {"samples_affected", counters.samples_affected},
              {"ray_tests", counters.ray_tests},
              {"ray_updates", counters.ray_updates},
              {"shadow_updates", counters.shadow_updates}});
  for (const auto& [name, duration] : {std::pair{"classify", seconds.classify},
                                       {"select", seconds.select},
                                       {"test", seconds.test},
                                       {"update", seconds.update},
                                       {"evaluate", seconds.evaluate},
                                       {"write", seconds.write}}) {
    if (duration > 0) trace.span(name, start, duration);
    start += std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(duration));
  }
  const Resident& resident = step.resident;
  trace.amounts("resident bytes", {{"ray_paths", resident.ray_paths},
                                   {"ray_trees", resident.ray_trees},
                                   {"sample_colors", resident.sample_colors},
                                   {"light_sums", resident.light_sums},
                                   {"kept_rays", resident.kept_rays},
                                   {"kept_segments", resident.kept_segments},
                                   {"kept_terms", resident.kept_terms},
                                   {"kept_vertices", resident.kept_vertices},
                                   {"color_trees", resident.color_trees},
                                   {"groups", resident.groups},
                                   {"tunnels", resident.tunnels}});
}

}  // namespace relook
