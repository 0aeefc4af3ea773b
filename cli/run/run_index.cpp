#include "run/run_index.h"

#include <limits>

#include "base/error.h"
#include "input/run_input.h"
#include "page/index_page.h"
#include "report/own_file.h"
#include "report/progress_file.h"
#include "report/report_file.h"
#include "run/run_files.h"

namespace relook {

void write_index(const std::filesystem::path& page, const std::vector<std::filesystem::path>& runs) {
  std::vector<RunCard> cards;
  for (const std::filesystem::path& folder : runs) {
    const RunInput run(folder);
    RunCard card = run_card(folder, run.name(), run.head(), run.entries(), run.exposure());
    card.link = relative_url(page, folder / "report.html");
    card.report = relative_url(page, folder / kReportName);
    cards.push_back(std::move(card));
  }
  const std::filesystem::path full = std::filesystem::weakly_canonical(std::filesystem::absolute(page));
  const std::string title = full.parent_path().filename().string();
  write_file(page, index_text(title.empty() ? "runs" : title, cards));
}

void require_free_index(const std::filesystem::path& folder) {
  const std::filesystem::path page = folder / kIndexName;
  if (is_there(page) && !is_own_file(page, OwnKind::page))
    throw UsageError(page.string(), "is there and not of relook: not replaced");
}

bool is_being_written(const std::filesystem::path& run) {
  try {
    constexpr std::uint32_t kNoStep = std::numeric_limits<std::uint32_t>::max() - 1;  // that no journal has
    return ProgressFile(run, kNoStep, kNoStep).is_being_done(0, kNoStep - 1);
  } catch (const BusyError&) {
    return true;
  }
}

}  // namespace relook
