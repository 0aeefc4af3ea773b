#include "fuzz_case.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>

#include "base/import_memory.h"
#include "base/input_errors.h"
#include "base/parallel.h"
#include "scene/texture/image_library.h"

namespace relook {
namespace {

[[noreturn]] void give_up(std::string_view sentence) {
  std::fprintf(stderr, "fuzz: %.*s\n", static_cast<int>(sentence.size()), sentence.data());
  std::abort();
}

bool is_one_line(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; });
}

}  // namespace

void begin_fuzz_case() {
  static const bool is_first = [] {
    limit_image_library_threads();
    return true;
  }();
  static_cast<void>(is_first);
  set_thread_count(1);
  set_float_mode();
  set_import_memory(kFuzzImportMemory);
}

void expect(bool condition, std::string_view sentence) {
  if (!condition) give_up(sentence);
}

bool is_answered(std::initializer_list<ExitCode> codes, const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    const bool has_lines = dynamic_cast<const InputErrors*>(&error) != nullptr;
    if (std::ranges::find(codes, error.code()) == codes.end() || (!has_lines && !is_one_line(error.what())))
      give_up("exit " + std::to_string(static_cast<int>(error.code())) + ": " + error.what());
    if (std::getenv("RELOOK_FUZZ_SAYS") != nullptr) std::fprintf(stderr, "answer: %s\n", error.what());
  } catch (const std::exception& error) {
    give_up(std::string("not an Error: ") + error.what());
  }
  return false;
}

FuzzFolder::FuzzFolder(const std::string& target) {
  const std::filesystem::path shared = "/dev/shm";
  const bool has_memory = std::getenv("TMPDIR") == nullptr && ::access(shared.c_str(), W_OK) == 0;
  path_ = (has_memory ? shared : std::filesystem::temp_directory_path()) /
          ("relook_fuzz_" + target + "_" + std::to_string(::getpid()));
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
}

FuzzFolder::~FuzzFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void overwrite_file(const std::filesystem::path& path, BytesView bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text_of(bytes);
}

std::uint64_t Choices::number(std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i, ++next_)
    if (next_ < bytes_.size()) value |= std::to_integer<std::uint64_t>(bytes_[next_]) << (8 * i);
  return value;
}

}  // namespace relook
