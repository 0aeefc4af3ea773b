#include "base/system/system_calls.h"

#ifdef RELOOK_HAS_SANDBOX
#include <asm/ioctls.h>
#include <errno.h>
#include <linux/audit.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <sys/syscall.h>

#include <cstdint>
#include <initializer_list>

namespace relook {
namespace {

#ifdef __x86_64__
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#endif

/// set_mempolicy_home_node of Linux 5.17; the calls of x32 have numbers far above it, too.
constexpr std::uint32_t kLastKnownCall = 450;

constexpr long kRefused[] = {
    // Other programs and processes; fork() is a clone without CLONE_THREAD where it has no call of its own.
    SYS_execve, SYS_execveat, SYS_setpriority, SYS_ioprio_set, SYS_ptrace, SYS_process_vm_readv, SYS_process_vm_writev,
    SYS_process_madvise, SYS_process_mrelease, SYS_kcmp, SYS_pidfd_open, SYS_pidfd_getfd, SYS_pidfd_send_signal,
    SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo,
#ifdef SYS_fork
    SYS_fork, SYS_vfork,
#endif
#ifdef __GLIBC__
    SYS_tkill,
#endif
    // The network, and what else is shared between processes.
    SYS_socket, SYS_socketpair, SYS_connect, SYS_bind, SYS_listen, SYS_accept, SYS_accept4, SYS_sendto, SYS_sendmsg,
    SYS_sendmmsg, SYS_recvfrom, SYS_recvmsg, SYS_recvmmsg, SYS_shutdown, SYS_getsockname, SYS_getpeername,
    SYS_setsockopt, SYS_getsockopt, SYS_shmget, SYS_shmat, SYS_shmctl, SYS_shmdt, SYS_msgget, SYS_msgsnd, SYS_msgrcv,
    SYS_msgctl, SYS_semget, SYS_semop, SYS_semctl, SYS_semtimedop, SYS_mq_open, SYS_mq_unlink,
    // Names, owners and modes that Landlock has no say in.
    SYS_linkat, SYS_symlinkat, SYS_mknodat, SYS_fchmodat, SYS_fchmod, SYS_fchownat, SYS_fchown, SYS_utimensat,
    SYS_setxattr, SYS_lsetxattr, SYS_fsetxattr, SYS_removexattr, SYS_lremovexattr, SYS_fremovexattr,
    SYS_name_to_handle_at, SYS_open_by_handle_at, SYS_fanotify_init, SYS_fanotify_mark,
#ifdef SYS_link
    SYS_link, SYS_symlink, SYS_mknod, SYS_chmod, SYS_chown, SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat,
#endif
    // Namespaces and file systems.
    SYS_unshare, SYS_setns, SYS_chroot, SYS_pivot_root, SYS_mount, SYS_umount2, SYS_move_mount, SYS_open_tree,
    SYS_mount_setattr, SYS_fsopen, SYS_fsconfig, SYS_fsmount, SYS_fspick, SYS_swapon, SYS_swapoff, SYS_quotactl,
    SYS_quotactl_fd,
    // Large parts of the kernel that a renderer has no use for.
    SYS_bpf, SYS_perf_event_open, SYS_userfaultfd, SYS_io_uring_setup, SYS_io_uring_enter, SYS_io_uring_register,
    SYS_keyctl, SYS_add_key, SYS_request_key, SYS_personality, SYS_vhangup, SYS_syslog, SYS_acct,
#ifdef SYS_uselib
    SYS_uselib, SYS_modify_ldt, SYS_iopl, SYS_ioperm,
#endif
    // The machine.
    SYS_kexec_load, SYS_init_module, SYS_finit_module, SYS_delete_module, SYS_reboot, SYS_settimeofday,
    SYS_clock_settime, SYS_adjtimex, SYS_clock_adjtime, SYS_sethostname, SYS_setdomainname,
#ifdef SYS_kexec_file_load
    SYS_kexec_file_load,
#endif
    // Users and capabilities.
    SYS_setuid, SYS_setgid, SYS_setreuid, SYS_setregid, SYS_setresuid, SYS_setresgid, SYS_setfsuid, SYS_setfsgid,
    SYS_setgroups, SYS_capset};

constexpr std::uint32_t kFail = SECCOMP_RET_ERRNO | EPERM, kUnknown = SECCOMP_RET_ERRNO | ENOSYS;

/// The offset of an argument of the call that is looked at: of its lower half, which both architectures have first.
constexpr std::uint32_t argument(std::uint32_t number) {
  return static_cast<std::uint32_t>(offsetof(seccomp_data, args)) + 8 * number;
}

class Filter {
 public:
  void load(std::uint32_t offset) { add(BPF_LD | BPF_W | BPF_ABS, offset); }
  void answer(std::uint32_t what) { add(BPF_RET | BPF_K, what); }
  /// What was loaded against `value`: if `test` (BPF_JEQ, ...) holds, the next `count` instructions, otherwise what
  /// follows them.
  void when(std::uint16_t test, std::uint32_t value, std::uint8_t count) {
    add(BPF_JMP | BPF_K | test, value, 0, count);
  }
  void unless(std::uint16_t test, std::uint32_t value, std::uint8_t count) {
    add(BPF_JMP | BPF_K | test, value, count, 0);
  }
  [[nodiscard]] std::vector<sock_filter> take() { return std::move(code_); }

 private:
  void add(unsigned code, std::uint32_t value, std::uint8_t if_true = 0, std::uint8_t if_false = 0) {
    code_.push_back({static_cast<std::uint16_t>(code), if_true, if_false, value});
  }
  std::vector<sock_filter> code_;
};

}  // namespace

std::vector<sock_filter> system_call_filter(pid_t own) {
  Filter filter;
  filter.load(offsetof(seccomp_data, arch));
  filter.unless(BPF_JEQ, kArchitecture, 1);
  filter.answer(SECCOMP_RET_KILL_PROCESS);
  filter.load(offsetof(seccomp_data, nr));
  filter.when(BPF_JGT, kLastKnownCall, 1);
  filter.answer(kUnknown);
  for (const long call : kRefused) {
    filter.when(BPF_JEQ, static_cast<std::uint32_t>(call), 1);
    filter.answer(kFail);
  }
  // The C library falls back on clone, whose flags can be looked at.
  filter.when(BPF_JEQ, SYS_clone3, 1);
  filter.answer(kUnknown);
  filter.when(BPF_JEQ, SYS_clone, 4);  // threads only
  filter.load(argument(0));
  filter.when(BPF_JSET, CLONE_THREAD, 1);
  filter.answer(SECCOMP_RET_ALLOW);
  filter.answer(kFail);
  for (const long call : {SYS_kill, SYS_tgkill}) {
    filter.when(BPF_JEQ, static_cast<std::uint32_t>(call), 4);
    filter.load(argument(0));
    filter.when(BPF_JEQ, static_cast<std::uint32_t>(own), 1);
    filter.answer(SECCOMP_RET_ALLOW);
    filter.answer(kFail);
  }
  // Limits, scheduling and the choice of processors: the process may set its own, as 0 or by its number.
  for (const long call :
       {SYS_prlimit64, SYS_sched_setaffinity, SYS_sched_setscheduler, SYS_sched_setparam, SYS_sched_setattr}) {
    filter.when(BPF_JEQ, static_cast<std::uint32_t>(call), 5);
    filter.load(argument(0));
    filter.unless(BPF_JEQ, 0, 2);
    filter.unless(BPF_JEQ, static_cast<std::uint32_t>(own), 1);
    filter.answer(kFail);
    filter.answer(SECCOMP_RET_ALLOW);
  }
  // TIOCSTI and TIOCLINUX type into the terminal from which the program was started.
  filter.when(BPF_JEQ, SYS_ioctl, 5);
  filter.load(argument(1));
  filter.unless(BPF_JEQ, TIOCSTI, 2);
  filter.unless(BPF_JEQ, TIOCLINUX, 1);
  filter.answer(SECCOMP_RET_ALLOW);
  filter.answer(kFail);
  filter.answer(SECCOMP_RET_ALLOW);
  return filter.take();
}

}  // namespace relook
#endif
