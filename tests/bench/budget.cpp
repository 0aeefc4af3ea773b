#include "budget.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "base/parallel.h"
#include "bench_cache.h"
#include "cache/residency/access_log.h"
#include "edit/apply.h"

namespace relook {
namespace {

constexpr std::array<double, 5> kBudgets{0.2, 0.4, 0.6, 0.8, 1.0};  // of what the pieces take without a limit
constexpr int kRounds = 3;                                          // of the journal

/// A replay from the opening of a cache, edit by edit. What the cache stores are pieces, its tunnels, too.
class Run {
 public:
  Run(const std::filesystem::path& cache, ResidencyOptions options)
      : Run(cache, std::make_unique<Residency>(std::move(options))) {}

  double step(const Edit& edit, const Journal& journal) {
    const double seconds = timed(replayer_, StepKind::step, edit, journal).seconds;
    const Resident resident = replayer_.resident();
    most_bytes_ = std::max(most_bytes_, resident.ray_trees + resident.sample_colors + resident.light_sums +
                                            resident.color_trees + resident.tunnels);
    return seconds;
  }
  /// One after the other.
  double all(const std::vector<Edit>& edits, const Journal& journal) {
    double seconds = 0;
    for (const Edit& edit : edits) seconds += step(edit, journal);
    return seconds;
  }
  [[nodiscard]] const Replayer& replayer() const { return replayer_; }
  /// Of pieces, after any edit so far.
  [[nodiscard]] std::uint64_t most_bytes() const { return most_bytes_; }

 private:
  Run(const std::filesystem::path& cache, std::unique_ptr<Residency> residency)
      : Run(open_bench_cache(cache, residency.get()), std::move(residency)) {}
  Run(OpenedCache opened, std::unique_ptr<Residency>&& residency)
      : replayer_(std::move(*opened.state), std::move(opened.image), {}, std::move(residency),
                  std::move(opened.tunnels)) {}

  Replayer replayer_;
  std::uint64_t most_bytes_ = 0;
};

/// Rounds of all edits of a journal, and then all of them taken back.
std::vector<Edit> there_and_back(const BenchOptions& options, const Journal& journal) {
  SceneState state = load_scene(options);
  std::vector<Edit> there, back;
  for (const JournalStep& step : journal.steps) {
    there.push_back(whole_edit(step));
    back.push_back(inverse_of(there.back(), state.document().look));
    apply_edit(state, there.back(), journal.file, journal.path.parent_path());
  }
  std::vector<Edit> all;
  for (int round = 0; round < kRounds; ++round) {
    all.insert(all.end(), there.begin(), there.end());
    all.insert(all.end(), back.rbegin(), back.rend());
  }
  return all;
}

/// What has left comes back from disk, or is worked out again.
enum class Tier : std::uint8_t { disk, rebuilt };

/// A limit on pieces alone, so that it means the same in every run.
ResidencyOptions limited(Tier tier, EvictionPolicy policy, std::uint64_t bytes) {
  ResidencyOptions residency;
  residency.process_bytes = nullptr;
  residency.policy = policy;
  residency.memory_bytes = bytes;
  if (tier == Tier::disk) residency.spill_folder = std::filesystem::temp_directory_path();
  return residency;
}

/// What pieces would take that never leave, and what was used when.
struct Demand {
  std::uint64_t bytes = 0;  // at most, after any edit
  AccessLog log;
};

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", share * 100);
  return text;
}

/// Seconds of all edits, and of what the access log says that returns take; without a line of the log on disk.
void print_curve(const std::filesystem::path& cache, const Journal& journal, const std::vector<Edit>& edits, Tier tier,
                 const Demand& demand) {
  const bool is_disk = tier == Tier::disk;
  std::printf("\n  ray trees and colours that have left are %s: seconds by memory for pieces, by policy%s\n",
              is_disk ? "read back" : "worked out again", is_disk ? "" : " (of this, returns, by the log)");
  std::printf("  %-14s", "policy");
  for (const double share : kBudgets) std::printf(" %17s", percent(share).c_str());
  std::printf("\n");
  const auto bytes_of = [&](double share) {
    return static_cast<std::uint64_t>(share * static_cast<double>(demand.bytes));
  };
  for (const EvictionPolicy policy : kEvictionPolicies) {
    std::printf("  %-14s", std::string(policy_name(policy)).c_str());
    for (const double share : kBudgets) {
      const std::uint64_t bytes = bytes_of(share);
      std::printf(" %8.2f", Run(cache, limited(tier, policy, bytes)).all(edits, journal));
      if (is_disk)
        std::printf(" %8s", "");
      else
        std::printf(" (%6.3f)", try_policy(demand.log, policy, bytes).seconds);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  if (is_disk) return;
  std::printf("  %-14s", "clairvoyant");
  for (const double share : kBudgets)
    std::printf(" %8s (%6.3f)", "", try_clairvoyant(demand.log, bytes_of(share)).seconds);
  std::printf("\n");
}

}  // namespace

void print_budgets(const BenchOptions& options) {
  const Journal journal = read_journal(options.journal);
  const ScratchFolder scratch;
  const std::filesystem::path cache = scratch / "cache";
  write_bench_cache(options, cache);
  ResidencyOptions logging;
  logging.logs_accesses = true;
  Run free_run(cache, logging);
  const std::vector<Edit> edits = there_and_back(options, journal);
  const double free_seconds = free_run.all(edits, journal);
  const Demand demand{free_run.most_bytes(),
                      parse_access_log(free_run.replayer().residency().access_log(), "the replay's own log")};
  std::printf(
      "relook_bench budget: %s at %ux%u, %u sample(s), %zu thread(s), from a cache with tunnels\n"
      "the journal %d times, there and back: %.2f s without a limit, at most %.0f MB in pieces. Tunnels that have left "
      "come from the cache as long as no edit changed them,\nafterwards as ray trees do. The scene and the cache are "
      "opened before the clock starts\n",
      options.scene.c_str(), options.width, options.height, options.view.samples, thread_count(), kRounds, free_seconds,
      static_cast<double>(demand.bytes) * 1e-6);
  for (const Tier tier : {Tier::disk, Tier::rebuilt}) print_curve(cache, journal, edits, tier, demand);
}

}  // namespace relook
