// What a process gives up before it reads anything that others have made, so that a fault in it gains nothing: other
// programs, the network, signals to other processes (base/system/system_calls.h), and by Landlock all files but those
// that the command line names. No program that it could start would have more rights (no_new_privs).
//
// What a kernel does not have is left out in silence; sandbox_text() says what there is. Builds with sanitizers have no
// sandbox: these start programs and trace themselves.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace relook {

/// Files, and folders with all that is below them. Links stand for what they lead to; what is not there is ignored.
struct Reach {
  std::vector<std::filesystem::path> readable, writable;  // what is writable is readable, too
};

/// Confines the process for the rest of its life. Requires: no other thread runs yet; later ones inherit the sandbox.
void enter_sandbox(const Reach& reach);

/// What this build and this kernel have: "no_new_privs, seccomp, landlock 7", "none (...)".
[[nodiscard]] std::string sandbox_text();

}  // namespace relook
