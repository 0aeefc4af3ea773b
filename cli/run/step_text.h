// What is said of a frame, or of a drag or wedge as a whole, once it is done: a line for the terminal, and a span with
// its phases for --trace.
#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "report/report.h"
#include "terminal/trace_file.h"

namespace relook {

/// "3_01" of a frame, "3" of a drag or wedge as a whole.
[[nodiscard]] std::string label_of(const StepReport& entry);
[[nodiscard]] std::string line_of(const StepReport& entry);
/// ", noise 1.2 %" of a frame whose noise is known, else "".
[[nodiscard]] std::string noise_text(const std::optional<double>& noise);
/// The step and, one after the other, the phases that its report times.
void trace_step(const StepReport& step, std::chrono::steady_clock::time_point start, TraceFile& trace);

}  // namespace relook
