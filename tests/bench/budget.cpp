#include "budget.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "base/parallel.h"
#include "cache/access_log.h"
#include "edit/apply.h"
#include "engine/render.h"

namespace relook {
namespace {

constexpr std::array<double, 4> kShares{0, 0.01, 0.1, 1};           // of ray trees
constexpr std::array<double, 5> kBudgets{0.2, 0.4, 0.6, 0.8, 1.0};  // of what the pieces take without a limit
constexpr int kRounds = 3;                                          // of the journal

/// A replay from the start, edit by edit.
class Run {
 public:
  Run(const BenchOptions& options, const Image& image, const RegionOptions& regions, ResidencyOptions residency)
      : replayer_(load_scene(options), image, regions, std::make_unique<Residency>(std::move(residency))) {}

  double step(const Edit& edit, const Journal& journal) {
    const double seconds = timed(replayer_, StepKind::step, edit, journal).seconds;
    const Resident resident = replayer_.resident();
    most_bytes_ =
        std::max(most_bytes_, resident.ray_trees + resident.sample_colors + resident.color_trees + resident.tunnels);
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

void print_shares(const BenchOptions& options, const Image& image, const Journal& journal, double full_seconds) {
  std::printf("\nfull render / edit, first time, by share of ray trees kept (Table 3's columns)\n");
  std::printf("  %-34s %10s %10s %10s %10s\n", "edit", "paths only", "1 %", "10 %", "all");
  std::vector<Run> runs;
  runs.reserve(kShares.size());
  for (const double share : kShares) {
    RegionOptions regions;
    regions.ray_trees = share;
    runs.emplace_back(options, image, regions, ResidencyOptions());
  }
  for (const JournalStep& step : journal.steps) {
    std::printf("  %-34s", step.name.c_str());
    for (Run& run : runs) std::printf(" %10.1f", full_seconds / run.step(whole_edit(step), journal));
    std::printf("\n");
  }
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

void print_curve(const BenchOptions& options, const Image& image, const Journal& journal,
                 const std::vector<Edit>& edits, Tier tier, const Demand& demand) {
  const bool is_disk = tier == Tier::disk;
  std::printf("\n  what has left is %s: seconds by memory for pieces and by policy%s\n  %8s",
              is_disk ? "read back" : "worked out again", is_disk ? "" : " (of this, returns, by the log)", "memory");
  for (const EvictionPolicy policy : kEvictionPolicies) std::printf(" %18s", std::string(policy_name(policy)).c_str());
  std::printf(is_disk ? "\n" : " %12s\n", "clairvoyant");
  for (const double share : kBudgets) {
    const auto bytes = static_cast<std::uint64_t>(share * static_cast<double>(demand.bytes));
    std::printf("  %6.0f %%", share * 100);
    for (const EvictionPolicy policy : kEvictionPolicies) {
      std::printf(" %9.2f", Run(options, image, {}, limited(tier, policy, bytes)).all(edits, journal));
      if (is_disk)
        std::printf(" %8s", "");
      else
        std::printf(" (%6.3f)", try_policy(demand.log, policy, bytes).seconds);
      std::fflush(stdout);
    }
    if (!is_disk) std::printf("     (%6.3f)", try_clairvoyant(demand.log, bytes).seconds);
    std::printf("\n");
  }
}

void print_curves(const BenchOptions& options, const Image& image, const Journal& journal) {
  ResidencyOptions logging;
  logging.logs_accesses = true;
  Run free_run(options, image, {}, logging);
  const std::vector<Edit> edits = there_and_back(options, journal);
  const double free_seconds = free_run.all(edits, journal);
  const Demand demand{free_run.most_bytes(),
                      parse_access_log(free_run.replayer().residency().access_log(), "the replay's own log")};
  std::printf("\nthe journal %d times, there and back: %.2f s without a limit, at most %.0f MB in pieces\n", kRounds,
              free_seconds, static_cast<double>(demand.bytes) * 1e-6);
  for (const Tier tier : {Tier::disk, Tier::rebuilt}) print_curve(options, image, journal, edits, tier, demand);
}

}  // namespace

void print_budgets(const BenchOptions& options) {
  SceneState state = load_scene(options);
  RenderStats stats;
  const Image image = preprocess(state.scene(), options.view, stats);
  RenderStats full;
  static_cast<void>(render(state.scene(), options.view, full));
  const double full_seconds = full.build_seconds + full.render_seconds;
  const Journal journal = read_journal(options.journal);
  std::printf("relook_bench budget: %s at %ux%u, %u sample(s), %zu thread(s); full render %.2f s\n",
              options.scene.c_str(), options.width, options.height, options.view.samples, thread_count(), full_seconds);
  print_shares(options, image, journal, full_seconds);
  print_curves(options, image, journal);
}

}  // namespace relook
