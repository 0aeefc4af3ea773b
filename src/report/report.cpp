#include "report/report.h"

#include <sys/resource.h>

#include <cstdio>
#include <fstream>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::int64_t kReportVersion = 1;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

Json seconds_json(const Seconds& seconds) {
  return {
      {"classify", seconds.classify}, {"select", seconds.select}, {"test", seconds.test},   {"update", seconds.update},
      {"evaluate", seconds.evaluate}, {"write", seconds.write},   {"total", seconds.total}, {"cpu", seconds.cpu}};
}

Json resident_json(const Resident& resident) {
  return {{"ray_paths", resident.ray_paths},
          {"ray_trees", resident.ray_trees},
          {"sample_colors", resident.sample_colors},
          {"light_sums", resident.light_sums},
          {"kept_rays", resident.kept_rays},
          {"kept_segments", resident.kept_segments},
          {"kept_terms", resident.kept_terms},
          {"kept_vertices", resident.kept_vertices},
          {"color_trees", resident.color_trees},
          {"groups", resident.groups},
          {"tunnels", resident.tunnels},
          {"total", resident.total}};
}

Json moves_json(const Moves& moves) {
  return {{"ray_trees", moves.ray_trees},   {"sample_colors", moves.sample_colors},
          {"light_sums", moves.light_sums}, {"color_trees", moves.color_trees},
          {"tunnels", moves.tunnels},       {"total", moves.bytes}};
}

Json verify_json(const std::optional<VerifyResult>& verify) {
  if (!verify) return nullptr;
  return {{"pixels_compared", verify->pixels_compared}, {"pixels_different", verify->pixels_different}};
}

Json full_render_json(const std::optional<FullRender>& full) {
  if (!full) return nullptr;
  return {{"seconds", full->seconds},
          {"cpu_seconds", full->cpu_seconds},
          {"rays", full->rays},
          {"measured", full->is_measured}};
}

Json range_json(const std::optional<StepRange>& range) {
  if (!range) return nullptr;
  return std::to_string(range->first) + "-" + (range->last ? std::to_string(*range->last) : "");
}

Json regions_json(const RegionCounters& regions) { return {{"visited", regions.visited}, {"culled", regions.culled}}; }

Json files_json(const std::map<std::string, FileStamp>& files) {
  Json json = Json::object();
  for (const auto& [name, stamp] : files)
    json[name] = {{"hash", stamp.hash}, {"bytes", stamp.bytes}, {"modified", stamp.modified}};
  return json;
}

/// The number of a frame in a drag, or in a wedge.
Json number_json(const StepReport& step, bool of_drag) {
  const bool has_number = step.place.number && !step.is_whole_step && step.is_drag == of_drag;
  return has_number ? Json(*step.place.number) : Json(nullptr);
}

Json options_json(const RunReport& report) {
  const StructureOptions& structures = report.structures;
  const bool is_path = report.view.integrator == Integrator::path;
  const Lens& lens = report.view.lens;
  return {{"integrator", integrator_word(report.view.integrator)},
          {"max_depth", report.view.max_depth},
          {"diffuse_depth", is_path ? Json(report.view.diffuse_depth) : Json(nullptr)},
          {"glossy_depth", is_path ? Json(report.view.glossy_depth) : Json(nullptr)},
          {"transmission_depth", is_path ? Json(report.view.transmission_depth) : Json(nullptr)},
          {"lens", lens.radius > 0 ? Json{lens.radius, lens.focus} : Json(nullptr)},
          {"memory", or_null(structures.memory_bytes)},
          {"policy", structures.policy},
          {"disk", or_null(structures.disk_bytes)},
          {"ray_trees", structures.ray_trees_percent},
          {"color_trees", structures.color_trees_percent},
          {"tunnels", structures.tunnels},
          {"tunnel_levels", structures.tunnel_levels},
          {"most_tunnels", or_null(structures.most_tunnels)},
          {"groups", structures.groups},
          {"atoms", structures.atoms},
          {"params", structures.params},
          {"shadow_bits", report.view.shadow_bits},
          {"float", report.float_frames},
          {"aovs", report.layers},
          {"relight", report.relight},
          {"exposure", report.exposure},
          {"verify", or_null(report.verify_percent)},
          {"steps", range_json(report.step_range)}};
}

}  // namespace

Json step_json(const StepReport& step) {
  const Counters& counters = step.counters;
  const auto frame = step.files.find(step.frame);
  Json json{{"step", step.place.step},
            {"class", change_class_name(step.change)},
            {"reasons", step.reasons},
            {"drag_frame", number_json(step, true)},
            {"wedge_frame", number_json(step, false)},
            {"frame", step.frame},
            {"frame_hash", frame == step.files.end() ? "" : frame->second.hash},
            {"preview", step.preview},
            {"edits", step.edits_hash},
            {"source", step.source_hash},
            {"files", files_json(step.files)},
            {"command", step.command},
            {"samples_total", counters.samples_total},
            {"samples_affected", counters.samples_affected},
            {"pixels_changed", counters.pixels_changed},
            {"regions_visited", counters.by_groups.visited + counters.by_tunnels.visited},
            {"regions_culled", counters.by_groups.culled + counters.by_tunnels.culled},
            {"regions", {{"groups", regions_json(counters.by_groups)}, {"tunnels", regions_json(counters.by_tunnels)}}},
            {"ray_tests", counters.ray_tests},
            {"ray_tests_culled", counters.ray_tests_culled},
            {"ray_tests_culled_by",
             {{"tunnels", counters.culled.tunnels},
              {"boxes", counters.culled.boxes},
              {"dropped", counters.culled.dropped},
              {"class", counters.culled.by_class}}},
            {"ray_updates", counters.ray_updates},
            {"shadow_updates", counters.shadow_updates},
            {"object_rays", counters.object_rays},
            {"color_trees_evaluated", counters.color_trees_evaluated},
            {"color_trees_reused", counters.color_trees_reused},
            {"tunnels_read", counters.tunnels_read},
            {"seconds", seconds_json(step.seconds)},
            {"resident", resident_json(step.resident)},
            {"evicted", moves_json(counters.evicted)},
            {"rebuilt", moves_json(counters.rebuilt)},
            {"reloaded", moves_json(counters.reloaded)},
            {"peak_rss", step.peak_rss_bytes},
            {"resumed", false},
            {"exposure", step.exposure},
            {"overlays", step.has_overlays},
            {"relight", step.has_relight},
            {"verify_percent", or_null(step.verify_percent)},
            {"verify", verify_json(step.verify)},
            {"full_render", full_render_json(step.full_render)}};
  json.update(step.words);
  return json;
}

std::string_view program_version() { return RELOOK_VERSION; }

ChangeClass change_class_of(std::string_view name) {
  for (const ChangeClass change : {ChangeClass::optical, ChangeClass::geometric, ChangeClass::mixed})
    if (change_class_name(change) == name) return change;
  return ChangeClass::color;
}

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::map<std::string, double> CacheSizes::per_sample() const {
  const auto share = [&](std::uint64_t bytes) { return static_cast<double>(bytes) / static_cast<double>(samples); };
  std::map<std::string, double> shares{{"total", share(total_bytes)}};
  for (const auto& [part, bytes] : bytes_by_part) shares[part] = share(bytes);
  return shares;
}

Json report_head_json(const RunReport& report) {
  Json cache_bytes = report.cache.bytes_by_part;
  cache_bytes["total"] = report.cache.total_bytes;
  return {{"relook", "report/" + std::to_string(kReportVersion)},
          {"version", kReportVersion},
          {"program", program_version()},
          {"scene", {{"file", printable(report.scene)}, {"hash", report.scene_hash}}},
          {"cache", printable(report.cache_folder)},
          {"journal",
           {{"file", printable(report.journal)},
            {"hash", report.journal_hash},
            {"note", text_or_null(report.said.note)},
            {"author", text_or_null(report.said.author)},
            {"extras", report.said.extras}}},
          {"source", report.source},
          {"places", report.places},
          {"camera", report.camera.name},
          {"resolution", {report.camera.width, report.camera.height}},
          {"samples", report.view.samples},
          {"noise", or_null(report.noise)},
          {"options", options_json(report)},
          {"machine", {{"threads", report.threads}, {"cpu", cpu_model()}}},
          {"full_render_seconds", or_null(report.full_render_seconds)},
          {"cache_bytes", std::move(cache_bytes)},
          {"cache_bytes_per_sample", report.cache.per_sample()},
          {"cache_damage", report.cache_damage},
          {"interrupted", report.interrupted},
          {"parts", report.parts},
          {"resumed", {{"frames", report.resumed_frames}, {"seconds", report.resume_seconds}}}};
}

}  // namespace relook
