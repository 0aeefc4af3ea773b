// What a fault in the program would be used for: each call as the kernel sees it, whatever the C library makes of it.
#pragma once
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <string>
#include <utility>
#include <vector>

namespace relook {

struct HostileCall {
  const char* name;
  int error;  // errno; 0: the call was made
};

/// Of a call that is refused -1, and errno.
inline int error_of(long result) { return result < 0 ? errno : 0; }

/// All that the filter of system calls must refuse.
inline std::vector<HostileCall> hostile_calls() {
  const char* const arguments[] = {"true", nullptr};
  char* const* const words = const_cast<char* const*>(arguments);
  std::vector<HostileCall> calls;
  const auto attempt = [&](const char* name, auto... call) { calls.push_back({name, error_of(syscall(call...))}); };
  const auto child = [&](const char* name, auto... call) {
    const long result = syscall(call...);
    if (result == 0) _exit(0);
    calls.push_back({name, error_of(result)});
  };
  attempt("execveat", SYS_execveat, AT_FDCWD, "/bin/true-that-is-not-there", words, words + 1, 0);
  attempt("execve", SYS_execve, "/bin/true-that-is-not-there", words, words + 1);
#ifdef SYS_fork
  child("fork", SYS_fork);
#endif
  child("clone", SYS_clone, SIGCHLD, 0, 0, 0, 0);
  attempt("socket", SYS_socket, AF_INET, SOCK_STREAM, 0);
  attempt("unix socket", SYS_socket, AF_UNIX, SOCK_STREAM, 0);
  int pair[2];
  attempt("socketpair", SYS_socketpair, AF_UNIX, SOCK_STREAM, 0, pair);
  attempt("ptrace", SYS_ptrace, PTRACE_CONT, getpid(), 0, 0);
  attempt("process_vm_readv", SYS_process_vm_readv, getppid(), nullptr, 0, nullptr, 0, 0);
  attempt("kill", SYS_kill, getppid(), 0);
  attempt("pidfd_open", SYS_pidfd_open, getppid(), 0);
  attempt("unshare", SYS_unshare, CLONE_NEWUSER);
  attempt("setns", SYS_setns, -1, 0);
  attempt("chroot", SYS_chroot, "/");
  attempt("mount", SYS_mount, "none", "/nowhere", "tmpfs", 0, nullptr);
  attempt("bpf", SYS_bpf, 0, nullptr, 0);
  attempt("perf_event_open", SYS_perf_event_open, nullptr, 0, -1, -1, 0);
  attempt("keyctl", SYS_keyctl, 0, -3, 0);
  attempt("userfaultfd", SYS_userfaultfd, 0);
  attempt("io_uring_setup", SYS_io_uring_setup, 1, nullptr);
  attempt("kexec_load", SYS_kexec_load, 0, 0, nullptr, 0);
  attempt("init_module", SYS_init_module, nullptr, 0, "");
  attempt("personality", SYS_personality, 0xFFFFFFFF);
  attempt("setuid", SYS_setuid, getuid());
  attempt("chmod", SYS_fchmodat, AT_FDCWD, "/nowhere", 0777);
  attempt("fchmod", SYS_fchmod, STDIN_FILENO, 0600);
  attempt("fchown", SYS_fchown, STDIN_FILENO, getuid(), getgid());
  attempt("times of a file", SYS_utimensat, AT_FDCWD, "/nowhere", nullptr, 0);
  attempt("limits of another process", SYS_prlimit64, getppid(), RLIMIT_CPU, nullptr, nullptr);
  attempt("processors of another process", SYS_sched_setaffinity, getppid(), 0, nullptr);
  attempt("setpriority", SYS_setpriority, 0, getppid(), 0);
  char letter = 'x';
  attempt("typing into the terminal", SYS_ioctl, STDIN_FILENO, TIOCSTI, &letter);
  return calls;
}

/// What a folder outside of reach, with the file "secret" in it, must not be used for.
inline std::vector<HostileCall> hostile_file_calls(const std::string& outside) {
  const std::string secret = outside + "/secret", made = outside + "/made";
  return {{"read a file", error_of(open(secret.c_str(), O_RDONLY))},
          {"write a file", error_of(open(secret.c_str(), O_WRONLY))},
          {"truncate a file", error_of(truncate(secret.c_str(), 0))},
          {"make a file", error_of(open(made.c_str(), O_WRONLY | O_CREAT, 0600))},
          {"list a folder", error_of(open(outside.c_str(), O_RDONLY | O_DIRECTORY))},
          {"make a folder", error_of(mkdir(made.c_str(), 0700))},
          {"remove a file", error_of(unlink(secret.c_str()))},
          {"rename a file", error_of(rename(secret.c_str(), made.c_str()))}};
}

}  // namespace relook
