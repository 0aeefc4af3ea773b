#include "console.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

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
      json_(arguments.json) {
  is_bar_ = style_ == ProgressStyle::automatic && isatty(STDERR_FILENO) != 0;
  if (style_ == ProgressStyle::automatic && !is_bar_) style_ = ProgressStyle::plain;
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
    print(stderr, Json{{"stage", stage}, {"percent", percent}}.dump() + "\n");
  } else {
    print(stderr, stage + ": " + share + " %\n");
  }
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
  for (const std::string& warning : warnings) print(stderr, "relook: warning: " + printable(warning) + "\n");
}

}  // namespace relook
