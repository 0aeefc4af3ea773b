#include "base/system/sandbox.h"

#include "base/system/sanitizers.h"
#include "base/system/system_calls.h"

#ifdef RELOOK_HAS_SANDBOX
#include <fcntl.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace relook {
namespace {

/// The attributes of a set of rules as of ABI 6; headers may be older than the kernel.
struct RulesetAttributes {
  std::uint64_t files = 0, network = 0, scopes = 0;
};
constexpr std::uint64_t kTruncate = 1 << 14;       // ABI 3
constexpr std::uint64_t kDeviceControl = 1 << 15;  // ABI 5: ioctl of devices opened from now on
constexpr std::uint64_t kNetwork = 3;              // ABI 4: TCP, bind and connect
constexpr std::uint64_t kScopes = 3;               // ABI 6: abstract sockets, signals

constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE;
constexpr std::uint64_t kRead = kReadFile | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWriteFile = LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate;
constexpr std::uint64_t kWrite = kRead | kWriteFile | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                                 LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REFER;
constexpr std::uint64_t kOfFiles = kReadFile | kWriteFile;  // what a rule of a single file may allow

/// 0: a kernel without Landlock, or one with ABI 1, under which nothing can be moved from folder to folder.
long landlock_abi() {
  const long abi = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  return abi < 2 ? 0 : abi;
}

std::uint64_t handled_files(long abi) {
  std::uint64_t rights = 2 * LANDLOCK_ACCESS_FS_REFER - 1;
  if (abi >= 3) rights |= kTruncate;
  if (abi >= 5) rights |= kDeviceControl;
  return rights;
}

void allow(int rules, const std::filesystem::path& path, std::uint64_t rights) {
  const int file = ::open(path.c_str(), O_PATH | O_CLOEXEC);
  if (file < 0) return;
  struct stat status {};
  if (::fstat(file, &status) == 0) {
    landlock_path_beneath_attr rule{};
    rule.allowed_access = S_ISDIR(status.st_mode) ? rights : rights & kOfFiles;
    rule.parent_fd = file;
    // The kernel refuses a rule for pipes and sockets, which Landlock leaves alone.
    static_cast<void>(syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0));
  }
  ::close(file);
}

void keep_to_files(const Reach& reach) {
  const long abi = landlock_abi();
  if (abi == 0) return;
  const RulesetAttributes attributes{handled_files(abi), kNetwork, kScopes};
  const std::size_t size = sizeof(std::uint64_t) * (abi >= 6 ? 3 : abi >= 4 ? 2 : 1);
  const auto rules = static_cast<int>(syscall(SYS_landlock_create_ruleset, &attributes, size, 0));
  if (rules < 0) return;
  for (const std::filesystem::path& path : reach.readable) allow(rules, path, kRead & attributes.files);
  for (const std::filesystem::path& path : reach.writable) allow(rules, path, kWrite & attributes.files);
  static_cast<void>(syscall(SYS_landlock_restrict_self, rules, 0));
  ::close(rules);
}

void give_up_calls() {
  std::vector<sock_filter> code = system_call_filter(::getpid());
  const sock_fprog program{static_cast<unsigned short>(code.size()), code.data()};
  // Without SPEC_ALLOW older kernels slow all branches down; no code runs here that came from outside.
  constexpr unsigned kFlags = SECCOMP_FILTER_FLAG_TSYNC | SECCOMP_FILTER_FLAG_SPEC_ALLOW;
  if (syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, kFlags, &program) != 0)
    static_cast<void>(syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program));
}

bool has_seccomp() {
  const std::uint32_t answer = SECCOMP_RET_ERRNO;
  return syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &answer) == 0;
}

}  // namespace

void enter_sandbox(const Reach& reach) {
  if (kIsInstrumented) return;  // sanitizers start programs and trace themselves
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
  keep_to_files(reach);
  give_up_calls();
}

std::string sandbox_text() {
  if (kIsInstrumented) return "none (a build with sanitizers)";
  std::string text = "no_new_privs";
  if (has_seccomp()) text += ", seccomp";
  if (const long abi = landlock_abi(); abi > 0) text += ", landlock " + std::to_string(abi);
  return text;
}

}  // namespace relook

#else

namespace relook {

void enter_sandbox(const Reach&) {}

std::string sandbox_text() { return "none (not built for Linux on x86-64 or aarch64)"; }

}  // namespace relook
#endif
