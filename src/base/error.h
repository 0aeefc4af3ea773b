// How things fail. Wrong input throws and is caught once, in cli/, which prints one line and picks the exit code.
// Our own bugs go through require().
#pragma once
#include <source_location>
#include <stdexcept>
#include <string>
#include <string_view>

namespace relook {

/// Exit codes of the program; scripts rely on them.
enum class ExitCode {
  ok = 0,
  usage = 1,
  bad_input = 2,
  cache_mismatch = 3,
  out_of_resources = 4,
  damaged_cache = 5,
  io = 6,
  difference = 10,
  busy = 75,  // somebody else holds a lock: try again later (sysexits.h, EX_TEMPFAIL)
};

/// Every error a user can cause or meet. what() is "FILE: WHERE: WHAT" (empty parts left out), control bytes stripped.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, std::string_view file, std::string_view where, std::string_view what);
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// A scene, journal, image or look patch that is wrong. `where` is a JSON pointer or a byte offset.
struct InputError : Error {
  InputError(std::string_view file, std::string_view where, std::string_view what)
      : Error(ExitCode::bad_input, file, where, what) {}
};
struct UsageError : Error {
  explicit UsageError(std::string_view what) : Error(ExitCode::usage, "", "", what) {}
  /// `file`: something that is where an output is to go, or is an input itself.
  UsageError(std::string_view file, std::string_view what) : Error(ExitCode::usage, file, "", what) {}
};
struct IoError : Error {
  IoError(std::string_view file, std::string_view what) : Error(ExitCode::io, file, "", what) {}
};
/// Another process is writing here.
struct BusyError : Error {
  BusyError(std::string_view file, std::string_view what) : Error(ExitCode::busy, file, "", what) {}
};
/// Disk full, or memory short.
struct ResourceError : Error {
  ResourceError(std::string_view file, std::string_view what) : Error(ExitCode::out_of_resources, file, "", what) {}
};

/// Aborts with the place when `condition` is false: a bug of ours, never an input error.
void require(bool condition, const char* message, std::source_location place = std::source_location::current());

/// `text` without control bytes and invalid UTF-8, and with marks in place of characters that would reorder or break
/// the line (Unicode's bidirectional controls, its line and paragraph separators), so that names may go into logs and
/// HTML.
[[nodiscard]] std::string printable(std::string_view text);

/// Well-formed UTF-8 with U+FFFD in place of these characters, for text that is made of more than one line.
[[nodiscard]] std::string without_reordering(std::string_view text);

/// The candidate nearest to `word` by edit distance, or "" if none is near enough to be meant.
template <class Range>
[[nodiscard]] std::string nearest_name(std::string_view word, const Range& candidates);
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

template <class Range>
std::string nearest_name(std::string_view word, const Range& candidates) {
  std::string best;
  std::size_t best_distance = word.size() / 3 + 2;
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace relook
