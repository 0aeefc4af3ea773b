#include "terminal/console.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "base/error.h"

namespace relook {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Whether a terminal can go back to the start of a line.
bool is_dumb_terminal() { return environment("TERM").empty() || environment("TERM") == "dumb"; }

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  lines.push_back(text);
  return lines;
}

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
      has_escapes_(environment("NO_COLOR").empty()),
      quiet_(arguments.quiet),
      json_(arguments.json),
      logs_json_(arguments.log_json),
      trace_(arguments.trace) {
  is_bar_ = style_ == ProgressStyle::automatic && !logs_json_ && isatty(STDERR_FILENO) != 0 && !is_dumb_terminal();
  if (style_ == ProgressStyle::automatic && !is_bar_) style_ = ProgressStyle::plain;
  if (style_ == ProgressStyle::plain && logs_json_) style_ = ProgressStyle::json;
}

/// Whether a descriptor takes something without making the program wait for its reader: until a signal has come, that
/// is waited for; after it, what nobody reads is dropped.
bool Console::has_room(int descriptor) const {
  constexpr int kPauseMilliseconds = 100;
  for (;;) {
    pollfd asked{descriptor, POLLOUT, 0};
    if (poll(&asked, 1, interrupt_.has_come() ? 0 : kPauseMilliseconds) > 0) return true;
    if (interrupt_.has_come()) return false;
  }
}

void Console::print(std::string_view text) {
  if (has_room(STDOUT_FILENO)) output_.print(text);
}

void Console::print_error(std::string_view text) const {
  if (has_room(STDERR_FILENO)) std::fwrite(text.data(), 1, text.size(), stderr);
}

void Console::finish() {
  if (!has_room(STDOUT_FILENO)) return output_.drop();
  output_.finish();
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
  if (bar_width_ == 0) return;
  print_error(has_escapes_ ? "\r\x1b[K" : "\r" + std::string(bar_width_, ' ') + "\r");
  bar_width_ = 0;
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
    show_bar(bar(percent) + " " + share + " % " + stage);
  } else if (style_ == ProgressStyle::json) {
    show_json("stage", stage, percent);
  } else {
    print_error(stage + ": " + share + " %\n");
  }
}

void Console::show_bar(const std::string& text) {
  const std::size_t rest = bar_width_ > text.size() ? bar_width_ - text.size() : 0;
  print_error("\r" + text + (has_escapes_ ? "\x1b[K" : std::string(rest, ' ')));
  bar_width_ = text.size() + (has_escapes_ ? 0 : rest);
}

void Console::show_json(const char* key, std::string_view what, int percent) const {
  Json progress{{key, printable(what)}, {"percent", percent}};
  if (logs_json_)
    log("info", std::move(progress));
  else
    print_error(progress.dump() + "\n");
}

void Console::line(std::string_view text) {
  if (!quiet_ && !json_) print(std::string(text) + "\n");
}

void Console::log_line(std::string_view text) {
  if (quiet_ || (json_ && style_ == ProgressStyle::none)) return;
  end_stage();
  if (logs_json_)
    log("info", {{"message", printable(text)}});
  else if (json_ || StandardOutput::is_pipe())
    print_error(std::string(text) + "\n");
  else
    print(std::string(text) + "\n");
}

void Console::note(std::string_view text) {
  if (quiet_) return;
  end_stage();
  if (logs_json_)
    log("info", {{"message", printable(text)}});
  else
    print_error("relook: " + printable(text) + "\n");
}

void Console::json(const Json& result) {
  if (json_) print(json_text(result, 2) + "\n");
}

void Console::warn(const std::vector<std::string>& warnings) {
  if (quiet_) return;
  end_stage();
  for (const std::string& warning : warnings) {
    if (logs_json_)
      log("warning", {{"message", printable(warning)}});
    else
      print_error("relook: warning: " + printable(warning) + "\n");
  }
}

void Console::error(ExitCode code, std::string_view what) {
  end_stage();
  const std::vector<std::string_view> lines = lines_of(what);
  const std::size_t more = lines.size() - 1;
  const std::string others = more == 0 ? "" : "; " + std::to_string(more) + (more == 1 ? " more line" : " more lines");
  if (style_ == ProgressStyle::openjd) say("openjd_fail", std::string(lines.front()) + others);
  for (const std::string_view line : lines) {
    if (logs_json_)
      log("error", {{"message", printable(line)}, {"exit_code", static_cast<int>(code)}});
    else
      print_error("relook: " + std::string(line) + "\n");
  }
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
  const std::string line = std::string(key) + ": " + printable(value) + "\n";
  if (json_) return print_error(line);
  print(line);
  if (has_room(STDOUT_FILENO)) output_.flush();
}

void Console::log(std::string_view level, Json members) const {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char time[32];
  std::strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%SZ", &utc);
  members["time"] = time;
  members["level"] = level;
  print_error(members.dump() + "\n");
}

}  // namespace relook
