// The rooms of the code keep the order that src/README.md gives, and stay small enough to be looked through.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace relook {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 30, kMostTestFiles = 15, kMostLines = 400;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Which rooms a room may include, by the lines of a map: "A, B <- C, D" lets C and D include A and B, and what these
/// may so far.
class Order {
 public:
  void add(std::string line) {
    std::ranges::replace(line, ',', ' ');
    std::set<std::string> above, below;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (word != "<-") {
        above.insert(word);
        continue;
      }
      let(above, below);
      below = std::exchange(above, {});
    }
    let(above, below);
  }
  [[nodiscard]] bool has(const std::string& room) const { return below_.contains(room); }
  [[nodiscard]] bool may_include(const std::string& room, const std::string& other) const {
    return room == other || below_.at(room).contains(other);
  }
  [[nodiscard]] std::size_t size() const { return below_.size(); }

 private:
  void let(const std::set<std::string>& rooms, const std::set<std::string>& others) {
    for (const std::string& room : rooms) {
      std::set<std::string>& all = below_[room];
      for (const std::string& other : others) {
        all.insert(other);
        all.insert(below_[other].begin(), below_[other].end());
      }
    }
  }

  std::map<std::string, std::set<std::string>> below_;
};

/// The one in the fence that follows "Dependencies point one way".
Order order_of(const fs::path& readme) {
  Order order;
  bool is_near = false, is_inside = false;
  for (const std::string& line : lines_of(readme)) {
    is_near = is_near || line.starts_with("Dependencies point one way");
    if (is_near && line.starts_with("```")) {
      if (is_inside) break;
      is_inside = true;
    } else if (is_inside) {
      order.add(line);
    }
  }
  return order;
}

bool is_code(const fs::path& file) { return file.extension() == ".h" || file.extension() == ".cpp"; }

class Rooms : public testing::Test {
 protected:
  /// Calls visit(path) for the folders and files below, but for the fuzz corpus and what is hidden.
  template <class Visit>
  void for_each_below(const fs::path& folder, const Visit& visit) const {
    for (auto at = fs::recursive_directory_iterator(root_ / folder); at != fs::recursive_directory_iterator(); ++at) {
      const std::string name = at->path().filename().string();
      if (at->is_directory() && (name == "corpus" || name.starts_with('.') || name.starts_with("__")))
        at.disable_recursion_pending();
      else
        visit(at->path());
    }
  }
  [[nodiscard]] std::string short_name(const fs::path& path) const { return path.lexically_relative(root_).string(); }

  fs::path root_ = RELOOK_SOURCE_DIR;
};

TEST_F(Rooms, IncludeNothingFromAbove) {
  const Order order = order_of(root_ / "src/README.md");
  ASSERT_GE(order.size(), 12U);
  EXPECT_TRUE(order.may_include("replay", "base"));
  EXPECT_FALSE(order.may_include("base", "scene"));
  std::size_t includes = 0;
  for_each_below("src", [&](const fs::path& file) {
    if (!is_code(file)) return;
    const std::string room = file.lexically_relative(root_ / "src").begin()->string();
    ASSERT_TRUE(order.has(room)) << short_name(file);
    for (const std::string& line : lines_of(file)) {
      constexpr std::string_view kInclude = "#include \"";
      if (!line.starts_with(kInclude)) continue;
      const std::string other = line.substr(kInclude.size(), line.find('/') - kInclude.size());
      EXPECT_TRUE(order.has(other) && order.may_include(room, other)) << short_name(file) << ": " << line;
      ++includes;
    }
  });
  EXPECT_GT(includes, 500U);
}

TEST_F(Rooms, HaveNotTooManyFiles) {
  std::map<std::string, std::size_t> files;
  for (const char* const top : {"src", "cli", "tests"})
    for_each_below(top, [&](const fs::path& path) {
      if (fs::is_regular_file(path)) ++files[short_name(path.parent_path())];
    });
  EXPECT_GT(files.size(), 20U);
  for (const auto& [folder, count] : files) EXPECT_LE(count, folder == "tests" ? kMostTestFiles : kMostFiles) << folder;
}

TEST_F(Rooms, HaveNoFilesThatAreTooLong) {
  for (const char* const top : {"src", "cli", "tests"})
    for_each_below(top, [&](const fs::path& path) {
      if (!is_code(path)) return;
      EXPECT_LE(lines_of(path).size(), kMostLines) << short_name(path);
    });
}

}  // namespace
}  // namespace relook
