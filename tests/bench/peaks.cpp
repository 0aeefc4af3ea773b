#include "peaks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "scratch.h"
#include "setup.h"

namespace relook {
namespace {

constexpr std::array<double, 5> kPlaces{0.05, 0.2, 0.4, 0.6, 0.8};  // between the floor and the peak without a limit
constexpr double kGoalPercent = 5;                                  // above the limit, at most

class Replays {
 public:
  Replays(std::string cache, std::string journal) : cache_(std::move(cache)), journal_(std::move(journal)) {}

  struct Run {
    ProgramRun program;
    double seconds = 0;
  };
  /// `megabytes`: none: no limit.
  [[nodiscard]] Run run(const char* name, std::optional<std::uint64_t> megabytes) const {
    std::vector<std::string> command{RELOOK_PROGRAM, "replay",     cache_,    journal_,
                                     "-o",           folder(name), "--quiet", "--fresh"};
    if (megabytes) command.insert(command.end(), {"--memory", std::to_string(*megabytes) + "M"});
    Run run;
    run.seconds = time_of([&] { run.program = try_program(command, scratch_ / "errors.txt"); });
    return run;
  }
  /// The smallest limit that is not refused: what the refusals name.
  [[nodiscard]] std::uint64_t floor_megabytes() const {
    for (std::uint64_t megabytes = 1;;) {
      const Run tried = run("limited", megabytes);
      if (tried.program.exit_code == 0) return megabytes;
      const std::string& said = tried.program.errors;
      const std::size_t named = said.find("needs at least ");
      const std::uint64_t next = named == std::string::npos ? 0 : std::stoull(said.substr(named + 15));
      if (next <= megabytes) throw IoError(cache_, said);
      megabytes = next;
    }
  }
  /// Frames of the two runs that are not the same bytes.
  [[nodiscard]] std::size_t different_frames() const {
    std::size_t different = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "free" / "frames")) {
      const std::filesystem::path other = scratch_ / "limited" / "frames" / entry.path().filename();
      if (read_file(entry.path()) != read_file(other)) ++different;
    }
    return different;
  }

 private:
  [[nodiscard]] std::string folder(const char* name) const { return (scratch_ / name).string(); }

  std::string cache_, journal_;
  ScratchFolder scratch_;
};

double megabytes_of(const Replays::Run& run) { return static_cast<double>(run.program.peak_bytes) / (1 << 20); }

}  // namespace

void print_peaks(const std::string& cache, const std::string& journal) {
  const Replays replays(cache, journal);
  const Replays::Run free_run = replays.run("free", std::nullopt);
  if (free_run.program.exit_code != 0) throw IoError(cache, free_run.program.errors);
  const double free_peak = megabytes_of(free_run);
  const std::uint64_t floor = replays.floor_megabytes();
  std::printf("relook_bench peaks: %s, %s: without a limit %.0f MB and %.2f s; the floor %llu MB\n", cache.c_str(),
              journal.c_str(), free_peak, free_run.seconds, static_cast<unsigned long long>(floor));
  std::printf("  --memory    peak    above (to reach: %.0f %%)    time / without a limit    other frames\n",
              kGoalPercent);
  for (const double place : kPlaces) {
    const auto limit = static_cast<std::uint64_t>(static_cast<double>(floor) +
                                                  place * std::max(0.0, free_peak - static_cast<double>(floor)));
    const Replays::Run run = replays.run("limited", limit);
    if (run.program.exit_code != 0) throw IoError(cache, run.program.errors);
    const double peak = megabytes_of(run);
    std::printf("  %7lluM %6.0fM %+8.1f %% %29.2f %23zu\n", static_cast<unsigned long long>(limit), peak,
                100 * (peak / static_cast<double>(limit) - 1), run.seconds / free_run.seconds,
                replays.different_frames());
  }
}

}  // namespace relook
