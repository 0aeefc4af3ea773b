// `relook check`: reads every file of a cache, its tunnels against its ray trees, and prints what is wrong.
#include "cache/cache_names.h"
#include "image/cached_image.h"
#include "image/cached_tunnels.h"
#include "input/load_cache.h"
#include "verbs.h"

namespace relook {

namespace {

std::size_t wrong_tunnels(const OpenedCache& opened) {
  return opened.tunnels ? count_wrong_tunnels(*opened.state, opened.image, *opened.tunnels) : 0;
}

}  // namespace

ExitCode run_check(const Arguments& arguments, Console& console) {
  const std::string& cache = arguments.inputs[0];
  CacheReport report = check_cache(cache);
  if (report.worst.fault == CacheFault::none) {
    OpenedCache opened;
    const CacheAnswer answer = open_cache(cache, false, opened);
    if (answer.fault != CacheFault::none) {
      report.worst = answer;
      report.findings.push_back(answer.file + ": " + answer.detail);
    } else if (const std::size_t wrong = wrong_tunnels(opened); wrong > 0) {
      const std::string detail =
          std::string("tunnels of ") + std::to_string(wrong) + " tile(s) are not around the ray trees";
      report.worst = {CacheFault::damaged, std::string(kTunnelsFolder), detail};
      report.findings.push_back(std::string(kTunnelsFolder) + ": " + detail);
    }
  }
  for (const std::string& finding : report.findings) console.line(finding);
  for (const std::string& note : report.notes) console.line("note: " + note);
  console.line(cache + ": " + std::string(sentence(report.worst.fault)) + "; " + std::to_string(report.files) +
               " files, " + std::to_string(report.bytes) + " bytes");
  console.json({{"cache", cache},
                {"sound", report.worst.fault == CacheFault::none},
                {"files", report.files},
                {"bytes", report.bytes},
                {"findings", report.findings},
                {"notes", report.notes}});
  require_sound(report.worst, cache);
  return ExitCode::ok;
}

}  // namespace relook
