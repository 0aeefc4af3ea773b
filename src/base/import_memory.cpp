#include "base/import_memory.h"

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "base/error.h"

namespace relook {
namespace {

/// The budget belongs to the process: what is unpacked fills one memory, whichever scene it is of.
struct Budget {
  std::mutex mutex;
  std::uint64_t limit = kImportMemory, used = 0, working = 0;
};

Budget& budget() {
  static Budget budget;
  return budget;
}

std::string in_mib(std::uint64_t bytes) { return std::to_string(bytes / (1 << 20) + (bytes % (1 << 20) != 0 ? 1 : 0)); }

[[noreturn]] void refuse(std::uint64_t bytes, std::uint64_t left, std::uint64_t limit, std::string_view file,
                         std::string_view where) {
  throw ResourceError(file, std::string(where) + " takes " + in_mib(bytes) + " MiB unpacked, " +
                                std::to_string(left >> 20) + " of " + in_mib(limit) +
                                " MiB are left; --import-memory SIZE allows more");
}

void take(Budget& all, std::uint64_t bytes, std::string_view file, std::string_view where) {
  const std::uint64_t left = all.limit - std::min(all.limit, all.used);
  if (bytes > left) refuse(bytes, left, all.limit, file, where);
  all.used += bytes;
}

}  // namespace

void set_import_memory(std::uint64_t bytes) {
  Budget& all = budget();
  const std::lock_guard lock(all.mutex);
  all.limit = bytes;
  all.used -= std::exchange(all.working, 0);
}

ImportShare::ImportShare(std::uint64_t bytes, std::string_view file, std::string_view where) {
  const std::lock_guard lock(budget().mutex);
  take(budget(), bytes, file, where);
  bytes_ = bytes;
}

ImportShare::~ImportShare() {
  if (bytes_ == 0) return;
  const std::lock_guard lock(budget().mutex);
  budget().used -= bytes_;
}

void take_working_memory(std::uint64_t bytes, std::string_view file, std::string_view where) {
  const std::lock_guard lock(budget().mutex);
  if (bytes <= budget().working) return;
  take(budget(), bytes - budget().working, file, where);
  budget().working = bytes;
}

void require_import_memory(std::uint64_t bytes, std::string_view file, std::string_view where) {
  const std::lock_guard lock(budget().mutex);
  if (bytes > budget().limit) refuse(bytes, budget().limit, budget().limit, file, where);
}

}  // namespace relook
