// What earlier commands left: an access log, as `tune` reads it, or the report and progress of a run, as one that is
// taken up again does. The first line says which: "access", or "run"; the lines of a run after one of "progress" get
// their hashes here.
#include "base/hash.h"
#include "cache/residency/access_log.h"
#include "frame/frame_file.h"
#include "frame/preview.h"
#include "fuzz_case.h"
#include "fuzz_targets.h"
#include "page/run_page.h"
#include "report/places.h"
#include "report/progress_file.h"
#include "report/report_file.h"
#include "report/run_ledger.h"
#include "report/run_source.h"
#include "report/run_table.h"

namespace relook {
namespace {

constexpr std::string_view kAccess = "access\n", kRun = "run\n", kProgress = "progress\n";
constexpr std::size_t kMostAccesses = 2000, kMostEntries = 40;

void use_access_log(std::string_view text) {
  const AccessLog log = parse_access_log(text, "log");
  if (log.accesses.size() > kMostAccesses) return;
  for (const std::uint64_t memory : {std::uint64_t{0}, log.largest_bytes(), log.total_bytes() / 2}) {
    for (const EvictionPolicy policy : kEvictionPolicies) (void)try_policy(log, policy, memory);
    (void)try_clairvoyant(log, memory);
  }
}

std::string with_hashes(std::string_view lines) {
  std::string text;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    text += hash128(bytes_of(line)) + " ";
    text.append(line) += '\n';
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
  }
  return text;
}

/// A run's folder with one frame and its preview.
const std::filesystem::path& run_folder() {
  static const FuzzFolder folder("notes");
  static const bool is_filled = [] {
    Frame frame{2, 1, std::vector<Rgba>(2, Rgba(0.5F, 0.25F, 0, 1))};
    for (const char* name : {"frames", "previews"}) std::filesystem::create_directory(folder.path() / name);
    overwrite_file(folder.path() / "frames/0000.exr", encode_exr(frame, {}, PixelFormat::half));
    overwrite_file(folder.path() / "previews/0000.png", encode_png(frame));
    return true;
  }();
  static_cast<void>(is_filled);
  return folder.path();
}

void use_run(std::string_view text) {
  const std::filesystem::path& folder = run_folder();
  const std::size_t at = text.starts_with(kProgress) ? 0 : std::min(text.find("\nprogress\n"), text.size() - 1) + 1;
  overwrite_file(folder / kReportName, bytes_of(text.substr(0, at)));
  const std::string_view rest = text.substr(std::min(text.size(), at + kProgress.size()));
  overwrite_file(folder / kProgressName, bytes_of(with_hashes(rest)));
  const std::initializer_list<ExitCode> codes{ExitCode::bad_input};
  is_answered(codes, [&] {
    if (const auto steps = read_run_steps(folder)) (void)run_table_json(run_table({*steps, *steps}));
  });
  const RunLedger ledger(folder);
  std::vector<Json> entries;
  for (const auto& [key, note] : ledger.notes())
    if (entries.size() < kMostEntries) entries.push_back(ledger.entry(note));
  (void)difference_of_sources(ledger.source(), Json::object());
  (void)difference_of_sources(ledger.source(), ledger.head());
  if (ledger.head().is_object()) (void)find_place(folder, ledger.head().value("places", Json()));
  Journal journal;
  journal.steps.resize(2);
  const ReportEntries list{entries.size(), [&](std::size_t i) { return entries[i]; }};
  const Json head{{"camera", "Main"}, {"resolution", {2, 1}}, {"samples", 1}, {"cache_damage", Json::array()}};
  for (const bool reads_pixels : {false, true})
    is_answered(codes, [&] { write_run_page({folder, head, list, journal, reads_pixels, {}}); });
}

}  // namespace

int fuzz_notes(const std::uint8_t* data, std::size_t size) {
  begin_fuzz_case();
  std::string_view text = text_of(fuzz_bytes(data, size));
  is_answered({ExitCode::bad_input, ExitCode::out_of_resources}, [&] {
    if (text.starts_with(kAccess)) return use_access_log(text.substr(kAccess.size()));
    if (text.starts_with(kRun) && text.size() > kRun.size()) return use_run(text.substr(kRun.size()));
  });
  return 0;
}

}  // namespace relook
