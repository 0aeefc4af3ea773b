// Standard input, output and error as the program finds them: closed, read by `head`, named as an input. Nobody else
// writes to stdout.
#pragma once
#include <string_view>

#include "options/arguments.h"

namespace relook {

/// Opens /dev/null on those of the descriptors 0, 1 and 2 that are closed: the next file opened would get their number
/// and, with it, what is printed. To be called first of all.
void open_closed_descriptors();

/// Throws UsageError when "-", standard input, stands for two inputs.
void require_one_standard_input(const Arguments& arguments);

class StandardOutput {
 public:
  /// Nothing once the reader of a pipe has gone: what it did not wait for is no error.
  void print(std::string_view text);
  void flush();
  /// Throws IoError if something could not be written for another reason.
  void finish();
  /// Forgets what has not been written yet.
  void drop();
  [[nodiscard]] static bool is_pipe();  // or a socket

 private:
  void note(int error);

  bool has_reader_ = true, has_failed_ = false;
};

}  // namespace relook
