// What the user sees: results on stdout, progress and warnings on stderr, the log on stdout unless that is a pipe; with
// --log-json log and stderr are one JSON object a line. --progress openjd prints what Open Job Description's
// specification ("How Jobs Are Run", Stdout/Stderr Messages) asks for, on stdout, or on stderr when stdout is for
// --json.
#pragma once
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "image/render.h"
#include "options/arguments.h"
#include "terminal/interrupt.h"
#include "terminal/standard_streams.h"
#include "terminal/trace_file.h"

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
  [[nodiscard]] const Interrupt& interrupt() const { return interrupt_; }

  /// A line of a result; nothing with --quiet or --json.
  void line(std::string_view text);
  /// A line that says how the work goes, one step done; nothing with --quiet, nor with --json beside --progress none.
  /// On stdout, or on stderr where stdout is a pipe, a socket, or for --json; with --log-json an object on stderr.
  void log_line(std::string_view text);
  /// A line on stderr for people, like sizes of what is about to be written; nothing with --quiet; with --log-json an
  /// object of level info.
  void note(std::string_view text);
  /// The result as JSON; nothing without --json.
  void json(const Json& result);
  /// Text that was asked for as it is, whatever --quiet and --json say.
  void print(std::string_view text);
  /// To be called after the work: throws IoError when not all could be written to stdout.
  void finish();
  void warn(const std::vector<std::string>& warnings);
  /// The lines on stderr for what ended the program; with --progress openjd the first is also said to the render
  /// manager.
  void error(ExitCode code, std::string_view what);

  /// The part of the whole work that stages and part_done() are shares of from here on, 0..1, and what it is: for
  /// --progress openjd, which shows one percentage for the whole, and json.
  void part(double begin, double end, std::string_view what);
  void part_done();

  /// A span of --trace from here to the end of the scope.
  [[nodiscard]] TraceScope span(std::string name) { return {trace_, std::move(name)}; }
  [[nodiscard]] TraceFile& trace() { return trace_; }

 private:
  [[nodiscard]] bool has_room(int descriptor) const;
  void print_error(std::string_view text) const;
  void show(const std::string& stage, double done);
  void show_whole(double done);
  void show_json(const char* key, std::string_view what, int percent) const;
  void show_bar(const std::string& text);
  void say(std::string_view key, std::string_view value);
  void log(std::string_view level, Json members) const;

  const Interrupt& interrupt_;
  StandardOutput output_;
  ProgressStyle style_;
  bool is_bar_ = false;  // automatic style on a terminal
  bool has_escapes_;     // to clear the rest of a line; without them spaces do
  bool quiet_, json_, logs_json_;
  double part_begin_ = 0, part_end_ = 1, shown_whole_ = -1;
  std::string shown_stage_;
  TraceFile trace_;
  std::mutex mutex_;
  int shown_percent_ = -1;
  std::size_t bar_width_ = 0;  // of the bar that is shown; 0: none
};

}  // namespace relook
