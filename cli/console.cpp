#include "console.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>

#include "base/error.h"

namespace relook {
namespace {

void print(std::FILE* stream, std::string_view text) { std::fwrite(text.data(), 1, text.size(), stream); }

std::string bar(int percent) {
  constexpr int kCells = 30;
  const auto filled = static_cast<std::size_t>(percent * kCells / 100);
  std::string cells(kCells, '.');
  std::fill_n(cells.begin(), filled, '#');
  return std::string("[").append(cells).append("]");
}

}  // namespace

Console::Console(const Arguments& arguments, const Interrupt& interrupt)
    : interrupt_(interrupt),
      style_(arguments.quiet ? ProgressStyle::none : arguments.progress),
      quiet_(arguments.quiet),
      json_(arguments.json),
      logs_json_(arguments.log_json),
      trace_(arguments.trace) {
  is_bar_ = style_ == ProgressStyle::automatic && !logs_json_ && isatty(STDERR_FILENO) != 0;
  if (style_ == ProgressStyle::automatic && !is_bar_) style_ = ProgressStyle::plain;
  if (style_ == ProgressStyle::plain && logs_json_) style_ = ProgressStyle::json;
}

Progress Console::stage(std::string name) {
  shown_percent_ = -1;
  return [this, name = std::move(name)](double done) {
    interrupt_.check();
    show(name, done);
  };
}

void Console::end_stage() {
  const std::lock_guard lock(mutex_);
  if (bar_is_open_) print(stderr, "\r\x1b[K");
  bar_is_open_ = false;
}

void Console::show(const std::string& stage, double done) {
  if (style_ == ProgressStyle::none) return;
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::openjd) {
    if (part_end_ - part_begin_ == 1 && shown_stage_ != stage) say("openjd_status", stage);
    shown_stage_ = stage;
    show_whole(done);
    return;
  }
  constexpr int kPlainStep = 10;
  int percent = std::clamp(static_cast<int>(done * 100), 0, 100);
  if (!is_bar_) percent -= percent % kPlainStep;
  if (percent <= shown_percent_) return;
  shown_percent_ = percent;
  const std::string share = std::to_string(percent);
  if (is_bar_) {
    bar_is_open_ = true;
    print(stderr, std::string("\r").append(bar(percent)).append(" " + share + " % " + stage + "\x1b[K"));
  } else if (style_ == ProgressStyle::json) {
    show_json("stage", stage, percent);
  } else {
    print(stderr, stage + ": " + share + " %\n");
  }
}

void Console::show_json(const char* key, std::string_view what, int percent) const {
  Json progress{{key, printable(what)}, {"percent", percent}};
  if (logs_json_)
    log("info", std::move(progress));
  else
    print(stderr, progress.dump() + "\n");
}

void Console::line(std::string_view text) const {
  if (!quiet_ && !json_) print(stdout, std::string(text) + "\n");
}

void Console::json(const Json& result) const {
  if (json_) print(stdout, result.dump(2) + "\n");
}

void Console::warn(const std::vector<std::string>& warnings) {
  if (quiet_) return;
  end_stage();
  for (const std::string& warning : warnings) {
    if (logs_json_)
      log("warning", {{"message", printable(warning)}});
    else
      print(stderr, "relook: warning: " + printable(warning) + "\n");
  }
}

void Console::error(ExitCode code, std::string_view what) {
  end_stage();
  if (style_ == ProgressStyle::openjd) say("openjd_fail", what);
  if (logs_json_)
    log("error", {{"message", printable(what)}, {"exit_code", static_cast<int>(code)}});
  else
    print(stderr, "relook: " + std::string(what) + "\n");
}

void Console::part(double begin, double end, std::string_view what) {
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::json) show_json("part", what, static_cast<int>(begin * 100));
  if (style_ != ProgressStyle::openjd) return;
  part_begin_ = begin;
  part_end_ = end;
  say("openjd_status", what);
  show_whole(0);
}

void Console::part_done() {
  if (style_ != ProgressStyle::openjd) return;
  const std::lock_guard lock(mutex_);
  show_whole(1);
}

/// A line for every whole percent, and the last; never a smaller one.
void Console::show_whole(double done) {
  constexpr double kHundred = 100;
  const double percent = kHundred * (part_begin_ + std::clamp(done, 0.0, 1.0) * (part_end_ - part_begin_));
  if (percent <= shown_whole_ || (percent < shown_whole_ + 1 && percent < kHundred)) return;
  shown_whole_ = percent;
  char number[32];
  std::snprintf(number, sizeof number, "%.1f", percent);
  say("openjd_progress", number);
}

/// One line, at once: who reads it may be a pipe.
void Console::say(std::string_view key, std::string_view value) {
  std::FILE* const stream = json_ ? stderr : stdout;
  print(stream, std::string(key) + ": " + printable(value) + "\n");
  std::fflush(stream);
}

void Console::log(std::string_view level, Json members) const {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char time[32];
  std::strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%SZ", &utc);
  members["time"] = time;
  members["level"] = level;
  print(stderr, members.dump() + "\n");
}

}  // namespace relook
