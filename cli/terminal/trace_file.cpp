#include "terminal/trace_file.h"

#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"

namespace relook {

TraceFile::TraceFile(std::string path) : path_(std::move(path)) {
  if (!path_.empty())
    events_.push_back({{"name", "process_name"}, {"ph", "M"}, {"pid", 1}, {"args", {{"name", "relook"}}}});
}

double TraceFile::microseconds(Clock::time_point time) const {
  return std::chrono::duration<double, std::micro>(time - start_).count();
}

void TraceFile::span(std::string name, Clock::time_point start, double seconds, Json arguments) {
  if (path_.empty()) return;
  constexpr double kMicro = 1e6;
  events_.push_back({{"name", printable(name)},
                     {"ph", "X"},
                     {"ts", microseconds(start)},
                     {"dur", std::max(0.0, seconds * kMicro)},
                     {"pid", 1},
                     {"tid", 1},
                     {"args", std::move(arguments)}});
}

void TraceFile::amounts(std::string name, Json values) {
  if (path_.empty()) return;
  events_.push_back({{"name", printable(name)},
                     {"ph", "C"},
                     {"ts", microseconds(Clock::now())},
                     {"pid", 1},
                     {"args", std::move(values)}});
}

void TraceFile::write() const {
  if (path_.empty()) return;
  const Uninterrupted to_the_end;
  const Json document{{"relook", "trace/1"}, {"displayTimeUnit", "ms"}, {"traceEvents", events_}};
  write_file(path_, json_text(document) + "\n");
}

}  // namespace relook
