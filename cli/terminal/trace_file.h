// --trace FILE: what a verb spent its time on, as Chrome's trace events (JSON, "traceEvents"), which Perfetto and
// chrome://tracing open. Microseconds since the start of the program's work.
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "base/json.h"

namespace relook {

class TraceFile {
 public:
  using Clock = std::chrono::steady_clock;

  /// "": nothing is noted.
  explicit TraceFile(std::string path);

  /// Something that took from `start` for `seconds`; what lies within it is drawn below it.
  void span(std::string name, Clock::time_point start, double seconds, Json arguments = Json::object());
  /// Amounts from now on, drawn as a chart.
  void amounts(std::string name, Json values);
  /// Throws IoError, ResourceError.
  void write() const;

 private:
  [[nodiscard]] double microseconds(Clock::time_point time) const;

  std::string path_;
  Clock::time_point start_ = Clock::now();
  std::vector<Json> events_;
};

/// A span from here to the end of the scope.
class TraceScope {
 public:
  TraceScope(TraceFile& file, std::string name) : file_(file), name_(std::move(name)) {}
  ~TraceScope() {
    file_.span(std::move(name_), start_, std::chrono::duration<double>(TraceFile::Clock::now() - start_).count());
  }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

 private:
  TraceFile& file_;
  std::string name_;
  TraceFile::Clock::time_point start_ = TraceFile::Clock::now();
};

}  // namespace relook
