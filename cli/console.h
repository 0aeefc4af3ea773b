// What the user sees: results on stdout, progress and warnings on stderr.
#pragma once
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.h"
#include "base/json.h"
#include "engine/render.h"
#include "interrupt.h"

namespace relook {

class Console {
 public:
  Console(const Arguments& arguments, const Interrupt& interrupt);
  ~Console() { end_stage(); }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Progress of one stage ("tracing"). The function returned also throws Interrupted once a signal has come, and must
  /// not outlive the console.
  [[nodiscard]] Progress stage(std::string name);
  /// Ends the line of a progress bar.
  void end_stage();
  /// Throws Interrupted once a signal has come.
  void check_interrupt() const { interrupt_.check(); }

  /// A line of a result; nothing with --quiet or --json.
  void line(std::string_view text) const;
  /// The result as JSON; nothing without --json.
  void json(const Json& result) const;
  void warn(const std::vector<std::string>& warnings);

 private:
  void show(const std::string& stage, double done);

  const Interrupt& interrupt_;
  ProgressStyle style_;
  bool is_bar_ = false;  // automatic style on a terminal
  bool quiet_, json_;
  std::mutex mutex_;
  int shown_percent_ = -1;
  bool bar_is_open_ = false;
};

}  // namespace relook
