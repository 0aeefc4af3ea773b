#include "input/load_cache.h"

namespace relook {

ExitCode exit_code(CacheFault fault) {
  switch (fault) {
    case CacheFault::none:
      return ExitCode::ok;
    case CacheFault::missing:
    case CacheFault::not_a_cache:
      return ExitCode::bad_input;
    case CacheFault::unreadable:
      return ExitCode::io;
    case CacheFault::other_version:
    case CacheFault::other_arithmetic:
    case CacheFault::other_scene:
    case CacheFault::other_options:
      return ExitCode::cache_mismatch;
    case CacheFault::truncated:
    case CacheFault::damaged:
      return ExitCode::damaged_cache;
  }
  return ExitCode::damaged_cache;
}

void require_sound(const CacheAnswer& answer, const std::string& cache) {
  if (answer.fault == CacheFault::none) return;
  throw Error(exit_code(answer.fault), cache, answer.file, explanation(answer));
}

CacheContent load_cache(const std::string& cache) {
  CacheContent content;
  require_sound(read_cache(cache, content), cache);
  return content;
}

Integrator integrator_of(const Json& manifest) {
  return manifest["content"]["integrator"] == integrator_word(Integrator::path) ? Integrator::path
                                                                                : Integrator::whitted;
}

std::optional<double> noise_of(const Json& manifest) {
  const auto found = manifest["content"].find("noise");
  return found == manifest["content"].end() ? std::nullopt : std::optional(found->get<double>());
}

CacheSizes cache_sizes(const Json& manifest) {
  CacheSizes sizes;
  const Json& content = manifest["content"];
  for (const Json& file : content["files"]) {
    const auto& name = file["name"].get_ref<const std::string&>();
    const auto bytes = file["bytes"].get<std::uint64_t>();
    sizes.bytes_by_part[name.substr(0, name.find_first_of("-/."))] += bytes;
    sizes.total_bytes += bytes;
  }
  sizes.samples = content["camera"]["width"].get<std::uint64_t>() * content["camera"]["height"].get<std::uint64_t>() *
                  content["samples"].get<std::uint64_t>();
  return sizes;
}

CacheContent load_mended_cache(const std::string& cache) {
  CacheContent content;
  CacheLosses losses;
  require_sound(read_cache(cache, content, &losses), cache);
  require_sound(make_good(content, losses), cache);
  return content;
}

OpenedCache open_cache(const std::string& cache, bool mends, Residency* residency) {
  OpenedCache opened;
  require_sound(open_cache(cache, mends, opened, residency), cache);
  return opened;
}

std::vector<std::string> sentences(const CacheLosses& losses) {
  std::vector<std::string> sentences;
  for (const CacheAnswer& fault : losses.faults) sentences.push_back(fault.file + ": " + fault.detail);
  return sentences;
}

}  // namespace relook
