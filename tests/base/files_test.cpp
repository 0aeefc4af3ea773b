// Checked files: nothing but regular files is read, nothing outside the folder, and a failed write leaves no trace.
#include "base/files.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "base/error.h"

namespace relook {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("relook_files_" + std::string(test->name()) + std::to_string(::getpid()));
    fs::create_directories(folder_ / "inner");
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename());
    std::sort(found.begin(), found.end());
    return found;
  }

  fs::path folder_;
};

template <class Action>
std::string message_of_error(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Files, what_is_written_is_read_back) {
  const fs::path path = folder_ / "data.bin";
  std::string text(100'000, 'x');
  text[5] = '\0';
  write_file(path, text);
  EXPECT_EQ(text_of(read_file(path)), text);
  write_file(path, std::string_view("short"));
  EXPECT_EQ(text_of(read_file(path)), "short");
  write_file(path, std::string_view());
  EXPECT_TRUE(read_file(path).empty());
  EXPECT_EQ(names(), (std::vector<std::string>{"data.bin", "inner"})) << "no temporary file may remain";
}

TEST_F(Files, only_regular_files_are_read) {
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  EXPECT_NE(message_of_error([&] { (void)read_file(folder_ / "fifo"); }).find("is not a regular file"),
            std::string::npos);
  EXPECT_NE(message_of_error([&] { (void)read_file(folder_); }).find("is a folder"), std::string::npos);
  EXPECT_NE(message_of_error([&] { (void)read_file(folder_ / "none"); }).find("no such file"), std::string::npos);
  EXPECT_NE(message_of_error([&] { (void)read_file("/dev/zero"); }).find("is not a regular file"), std::string::npos);
}

TEST_F(Files, size_limit_is_kept) {
  write_file(folder_ / "ten", std::string_view("0123456789"));
  EXPECT_EQ(read_file(folder_ / "ten", 10).size(), 10U);
  EXPECT_NE(message_of_error([&] { (void)read_file(folder_ / "ten", 9); }).find("has 10 bytes; at most 9"),
            std::string::npos);
}

TEST_F(Files, contained_paths_stay_inside) {
  write_file(folder_ / "secret", std::string_view("s"));
  write_file(folder_ / "inner/here", std::string_view("h"));
  fs::create_symlink("../secret", folder_ / "inner/out");
  fs::create_symlink("here", folder_ / "inner/link");
  fs::create_directory_symlink("..", folder_ / "inner/up");
  const auto resolve = [&](std::string_view uri) {
    return contained_path(folder_ / "inner", {}, uri, "scene", "/where");
  };
  EXPECT_EQ(text_of(read_file(resolve("here"))), "h");
  EXPECT_EQ(text_of(read_file(resolve("./here"))), "h");
  EXPECT_EQ(text_of(read_file(resolve("link"))), "h") << "a link that stays inside";
  using namespace std::string_view_literals;
  for (const std::string_view uri :
       {"../secret"sv, "a/../../secret"sv, "out"sv, "up/secret"sv, "/etc/hostname"sv, ""sv, "."sv, ".."sv, "none"sv,
        "file:here"sv, "http://h/here"sv, "here\0x"sv, "..\\secret"sv})
    EXPECT_TRUE(message_of_error([&] { (void)resolve(uri); }).starts_with("scene: /where: ")) << uri;
}

TEST_F(Files, failed_writes_leave_the_old_file_and_no_other) {
  const fs::path path = folder_ / "data.bin";
  write_file(path, std::string_view("old"));
  EXPECT_NE(message_of_error([&] { write_file(folder_ / "missing/data.bin", std::string_view("new")); }), "");

  rlimit old_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit small{4096, old_limit.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  ExitCode code = ExitCode::ok;
  try {
    write_file(path, std::string(1'000'000, 'n'));
  } catch (const Error& error) {
    code = error.code();
  }
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(code, ExitCode::out_of_resources);
  EXPECT_EQ(text_of(read_file(path)), "old");
  EXPECT_EQ(names(), (std::vector<std::string>{"data.bin", "inner"}));
}

TEST_F(Files, a_folder_in_the_way_is_an_error) {
  EXPECT_NE(message_of_error([&] { write_file(folder_ / "inner", std::string_view("x")); }), "");
  EXPECT_EQ(names(), std::vector<std::string>{"inner"});
  write_file(folder_ / "plain", std::string_view("x"));
  EXPECT_NE(message_of_error([&] { make_folders(folder_ / "plain/below"); }), "");
  EXPECT_NE(message_of_error([&] { make_folders(folder_ / "plain"); }), "");
  make_folders(folder_ / "a/b/c");
  make_folders(folder_ / "a/b/c");
  EXPECT_TRUE(fs::is_directory(folder_ / "a/b/c"));
}

TEST_F(Files, a_damaged_temporary_name_is_stepped_over) {
  const std::string stale = ".data.bin." + std::to_string(::getpid()) + ".0.tmp";
  std::ofstream(folder_ / stale) << "someone else's";
  write_file(folder_ / "data.bin", std::string_view("mine"));
  EXPECT_EQ(text_of(read_file(folder_ / "data.bin")), "mine");
  EXPECT_EQ(text_of(read_file(folder_ / stale)), "someone else's");
}

}  // namespace
}  // namespace relook
