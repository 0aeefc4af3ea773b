#include "load_cache.h"

namespace relook {

ExitCode exit_code(CacheFault fault) {
  switch (fault) {
    case CacheFault::none:
      return ExitCode::ok;
    case CacheFault::missing:
    case CacheFault::not_a_cache:
      return ExitCode::bad_input;
    case CacheFault::other_version:
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
  std::string what(sentence(answer.fault));
  if (!answer.detail.empty()) what += " (" + answer.detail + ")";
  throw Error(exit_code(answer.fault), cache, answer.file, what);
}

CacheContent load_cache(const std::string& cache) {
  CacheContent content;
  require_sound(read_cache(cache, content), cache);
  return content;
}

}  // namespace relook
