// `relook report`: pages of runs that are there: their own anew, an index over several, or one file to send.
#include <algorithm>
#include <array>

#include "input/run_input.h"
#include "page/index_page.h"
#include "page/run_page.h"
#include "report/own_file.h"
#include "report/progress_file.h"
#include "run/run_index.h"
#include "verbs.h"

namespace relook {
namespace {

/// "12.3 MB"
std::string size_text(std::size_t bytes) {
  constexpr std::array kUnits{"B", "kB", "MB", "GB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", value, kUnits[unit]);
  return text;
}

std::vector<std::filesystem::path> all_runs(const std::vector<std::string>& inputs) {
  std::vector<std::filesystem::path> runs;
  for (const std::string& input : inputs)
    for (std::filesystem::path& run : runs_at(input)) runs.push_back(std::move(run));
  return runs;
}

/// The page of one run. While a replay is at the run, the page is that command's.
void make_page(const std::filesystem::path& folder, Console& console) {
  const std::filesystem::path page = folder / "report.html";
  std::error_code error;
  if (std::filesystem::exists(page, error) && !is_own_file(page, OwnKind::page))
    throw UsageError(page.string(), "is there and not of relook: not replaced");
  if (std::filesystem::exists(folder / kProgressName, error) && is_being_written(folder))
    throw BusyError(folder.string(), "a replay is writing the run, and makes its page in the end");
  const RunInput run(folder);
  const ReportEntries entries = run.entries();
  const Journal journal = run.journal();
  write_run_page(
      {folder, run.head(), entries, journal, true, [&] { console.check_interrupt(); }, display_view_of_environment()});
  console.line(printable(page.string()) + ": " + std::to_string(entries.count) + " entries");
}

RunCard card_of(const RunInput& run) {
  return run_card(run.folder(), run.name(), run.head(), run.entries(), run.exposure());
}

Json sizes_json(const Arguments& arguments, const SinglePage& page) {
  return {{"page", printable(arguments.output)},
          {"scale", arguments.scale},
          {"frames", page.frames},
          {"previews_alone", page.previews},
          {"bytes",
           {{"previews", page.bytes.previews},
            {"pixels", page.bytes.pixels},
            {"data", page.bytes.data},
            {"viewer", page.bytes.viewer},
            {"total", page.bytes.total()}}}};
}

void write_single(const Arguments& arguments, const std::vector<std::filesystem::path>& runs, Console& console) {
  std::vector<SinglePage> pages;
  std::vector<RunCard> cards;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunInput run(runs[i]);
    const ReportEntries entries = run.entries();
    const Journal journal = run.journal();
    pages.push_back(single_run_page({runs[i], run.head(), entries, journal, true, [&] { console.check_interrupt(); }},
                                    arguments.scale));
    if (runs.size() == 1) continue;
    cards.push_back(card_of(run));
    cards.back().link = run_link(i);
  }
  const SinglePage page = pages.size() == 1 ? std::move(pages.front()) : joined_pages(std::move(pages), cards);
  const SinglePage::Bytes& bytes = page.bytes;
  console.note(arguments.output + ": previews " + size_text(bytes.previews) + ", pixels " + size_text(bytes.pixels) +
               ", data " + size_text(bytes.data) + ", viewer " + size_text(bytes.viewer) + "; " +
               size_text(bytes.total()) + " in all");
  if (page.previews > 0)
    console.warn({std::to_string(page.previews) + " frames are missing or damaged: the page has their previews"});
  console.json(sizes_json(arguments, page));
  write_page(arguments.output, page.page);
}

}  // namespace

ExitCode run_report(const Arguments& arguments, Console& console) {
  const std::vector<std::filesystem::path> runs = all_runs(arguments.inputs);
  if (arguments.single_file) {
    if (arguments.output.empty()) throw UsageError("report --single-file: -o PAGE.html says where it goes");
    write_single(arguments, runs, console);
    return ExitCode::ok;
  }
  if (!arguments.output.empty()) {
    write_index(arguments.output, runs);
    console.line(arguments.output + ": " + std::to_string(runs.size()) + " runs");
    console.json({{"page", printable(arguments.output)}, {"runs", runs.size()}});
    return ExitCode::ok;
  }
  Json pages = Json::array();
  for (const std::filesystem::path& run : runs) {
    make_page(run, console);
    pages.push_back(printable((run / "report.html").string()));
  }
  for (const std::string& input : arguments.inputs) {
    const std::filesystem::path folder(input);
    if (std::ranges::find(runs, folder) != runs.end()) continue;
    require_free_index(folder);
    write_index(folder / kIndexName, runs_at(folder));
    pages.push_back(printable((folder / kIndexName).string()));
  }
  console.json({{"pages", std::move(pages)}});
  return ExitCode::ok;
}

}  // namespace relook
