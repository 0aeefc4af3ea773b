// The system calls that a process gives up when it enters the sandbox (base/system/sandbox.h), as a program for
// seccomp.
//
// A list of what is refused, not of what is allowed: the program loads some 260 libraries beside its own, and what they
// and the C library call differs from one version to the next. What such a list forgets are calls that come with later
// kernels; numbers above the last one that was looked at are therefore unknown here, as on an older kernel, and
// libraries do without. Refused calls fail with EPERM, so that a library that tries one goes on; only calls of another
// architecture, which no library makes, end the process.
#pragma once

#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__)) && \
    __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ &&                           \
    __has_include(<linux/filter.h>) && __has_include(<linux/seccomp.h>) && __has_include(<linux/landlock.h>)
#define RELOOK_HAS_SANDBOX 1
#include <linux/filter.h>
#include <sys/types.h>

#include <vector>

namespace relook {

/// `own`: the process, which may send signals to itself alone.
[[nodiscard]] std::vector<sock_filter> system_call_filter(pid_t own);

}  // namespace relook
#endif
