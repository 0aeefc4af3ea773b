// The bits of frames, ray paths and hits, over all programs: test scenes under tests/golden_edits.json, the project's
// own scenes under its journals, with one and several samples and shadow bits, and of both integrators. A table in
// tests/golden_bits has a hash of each, and names the arithmetic (cache/arithmetic.h) under which they hold: there is a
// table for each kind of processor.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "base/files.h"
#include "base/hash.h"
#include "cache/arithmetic.h"
#include "edit/journal_walk.h"
#include "replay/replay.h"
#include "run_program.h"
#include "test_scenes.h"

namespace relook {
namespace {

const std::filesystem::path kProject = RELOOK_SOURCE_DIR;
const std::filesystem::path kTables = kProject / "tests/golden_bits";
constexpr const char* kHowToWrite =
    "RELOOK_GOLDEN_BITS=write relook_tests --gtest_filter='GoldenBits.*' writes this machine's table anew, and removes "
    "those of other versions";

template <class T>
void append(Bytes& bytes, std::span<const T> values) {
  const BytesView view = std::as_bytes(values);
  bytes.insert(bytes.end(), view.begin(), view.end());
}

std::string short_hash(const Bytes& bytes) { return hash128(bytes).substr(0, 16); }

/// Of the frame with the colours of its samples, and of their paths and hits.
std::string bits_of(const Image& image) {
  Bytes colors, trees;
  append(colors, std::span<const Rgba>(image.frame.pixels));
  for (const std::vector<Rgba>& tile : image.sample_colors) append(colors, std::span<const Rgba>(tile));
  for (const PackedSums& tile : image.light_sums) append(colors, std::span<const std::byte>(tile.values()));
  for (const TileTrees& tile : image.trees) {
    for (const PathId path : tile.paths) append(trees, image.paths.words(path));
    append(trees, std::span<const Hit>(tile.hits));
  }
  return short_hash(colors) + " " + short_hash(trees);
}

/// "NAME" to hashes. Names are in order.
using Bits = std::map<std::string, std::string>;

/// The bits of a scene after preprocess and after each frame of a journal.
void take_bits(const std::string& name, SceneState state, ViewOptions view, const Journal& journal, Bits& bits) {
  const std::string integrator = view.integrator == Integrator::path ? "path, " : "";
  const std::string start = integrator + name + ", " + std::to_string(view.samples) + " samples, " +
                            std::to_string(view.shadow_bits) + " shadow bits: ";
  int frames = 0;
  const auto note = [&](const Image& image, const std::string& what) {
    char number[16];
    std::snprintf(number, sizeof number, "%03d ", frames++);
    bits[start + number + what] = bits_of(image);
  };
  Image image = preprocessed(state.scene(), view);
  note(image, "preprocess");
  Replayer replayer(std::move(state), std::move(image));
  const std::filesystem::path folder = journal.path.parent_path();
  for (const JournalEvent& event : JournalWalk(journal)) {
    switch (event.kind) {
      case EventKind::edit:
        replayer.step(event.edit(), journal.file, folder);
        note(replayer.image(), event.step->name);
        break;
      case EventKind::drag:
        replayer.drag(event.edit(), journal.file, folder);
        note(replayer.image(), event.step->name);
        break;
      case EventKind::release:
        replayer.release();
        note(replayer.image(), event.step->name + ", released");
        break;
      case EventKind::base:
      case EventKind::wedge_end:
        break;
    }
  }
}

constexpr ViewOptions kViews[] = {{1, 6, 0}, {4, 6, 2}};
constexpr ViewOptions kPathView{.samples = 4, .integrator = Integrator::path, .diffuse_depth = 2};

SceneState path_state(const SceneState& state) {
  return {state.document(), state.scene().camera, state.pyramids(), Integrator::path};
}

Bits bits_of_all_programs() {
  Bits bits;
  const Journal edits = read_journal(kProject / "tests/golden_edits.json");
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study})
    for (const ViewOptions& view : kViews)
      take_bits(test_scene_name(scene), test_scene(scene, 96 / view.samples, 72 / view.samples), view, edits, bits);
  const Journal table1 = read_journal(kProject / "journals/table1.json");
  for (const ViewOptions& view : kViews)
    take_bits("scenes/spheres",
              scene_of_file(kProject / "scenes/spheres/spheres.gltf", 128 / view.samples, 72 / view.samples), view,
              table1, bits);
  for (const TestScene scene : {TestScene::spheres, TestScene::cards, TestScene::study})
    take_bits(test_scene_name(scene), path_state(test_scene(scene, 24, 18)), kPathView, edits, bits);
  take_bits("scenes/spheres", path_state(scene_of_file(kProject / "scenes/spheres/spheres.gltf", 32, 18)), kPathView,
            table1, bits);
  return bits;
}

/// The garden is generated. Python may count with another libm: then it is another scene, and not in the table.
void take_bits_of_garden(const Bits& golden, Bits& bits) {
  const ScratchFolder folder("golden");
  const ProgramResult made = run_program(
      {"python3", (kProject / "scenes/generate.py").string(), "garden", (folder / "garden").string(), "20"});
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::string scene = short_hash(read_file(folder / "garden/garden.gltf"));
  const std::string name = "scenes/garden of 20 leaves";
  if (const auto known = golden.find(name); known != golden.end() && known->second != scene) {
    std::printf("SKIPPED: this Python makes another garden; its bits are NOT tested\n");
    for (const auto& [row, hashes] : golden)
      if (row.starts_with(name)) bits[row] = hashes;
    return;
  }
  bits[name] = scene;
  take_bits(name, scene_of_file(folder / "garden/garden.gltf", 96, 96), kViews[0],
            read_journal(kProject / "journals/table3.json"), bits);
}

struct Table {
  Arithmetic arithmetic;
  Bits bits;
};

constexpr std::string_view kHead = "arithmetic ";
constexpr std::size_t kGap = 2;

/// Where the table of an arithmetic stands: "avx2-1a2b3c4d.txt".
std::filesystem::path table_of(std::string instructions) {
  constexpr std::string_view kBefore = ", reciprocals ";
  if (const std::size_t at = instructions.find(kBefore); at != std::string::npos)
    instructions.replace(at, kBefore.size(), "-");
  return kTables / (instructions + ".txt");
}

Table read_table(const std::filesystem::path& path) {
  Table table;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(kHead)) {
      const Json head = parse_json(line.substr(kHead.size()), path.string());
      table.arithmetic = read_arithmetic(JsonView(head, path.string()));
    } else if (const std::size_t gap = line.find("  "); gap != std::string::npos) {
      table.bits[line.substr(gap + kGap)] = line.substr(0, gap);
    }
  }
  return table;
}

/// This machine's table or, where there is none, the one that was written before tables named how the processor
/// approximates reciprocals.
Table nearest_table() {
  const std::string& instructions = own_arithmetic().instructions;
  const std::filesystem::path own = table_of(instructions);
  return read_table(std::filesystem::exists(own) ? own : table_of(instructions.substr(0, instructions.find(','))));
}

void write_table(const Bits& bits) {
  for (const auto& entry : std::filesystem::directory_iterator(kTables))
    if (read_table(entry.path()).arithmetic.version != own_arithmetic().version) std::filesystem::remove(entry.path());
  std::ostringstream text;
  text << kHead << arithmetic_json(own_arithmetic()).dump() << "\n";
  for (const auto& [name, hashes] : bits) text << hashes << "  " << name << "\n";
  write_file(table_of(own_arithmetic().instructions), text.str());
}

bool is_asked_to_write() {
  const char* const wanted = std::getenv("RELOOK_GOLDEN_BITS");
  return wanted != nullptr && std::string(wanted) == "write";
}

/// Rows whose hashes are not those of the table; of rows that the table lacks only if `missing_too`.
std::vector<std::string> different_rows(const Bits& golden, const Bits& bits, bool missing_too) {
  std::vector<std::string> rows;
  for (const auto& [name, hashes] : bits) {
    const auto known = golden.find(name);
    if (known == golden.end() ? missing_too : known->second != hashes) rows.push_back(name);
  }
  if (missing_too)
    for (const auto& row : golden)
      if (!bits.contains(row.first)) rows.push_back(row.first);
  return rows;
}

std::string first_of(const std::vector<std::string>& rows) {
  std::string text = std::to_string(rows.size()) + " rows differ";
  for (std::size_t i = 0; i < std::min<std::size_t>(rows.size(), 10); ++i) text += "\n  " + rows[i];
  return text;
}

TEST(GoldenBits, are_those_of_the_table) {
  const Table golden = nearest_table();
  const bool is_writing = is_asked_to_write();
  const Arithmetic& own = own_arithmetic();
  const bool is_own = golden.arithmetic == own;
  // It may be of this kind of processor: then its bits are these.
  const bool may_be_own = golden.arithmetic.version == own.version && golden.arithmetic.embree == own.embree &&
                          golden.arithmetic.libc == own.libc;
  const std::string not_tested = "SKIPPED: the nearest table was " + arithmetic_difference(golden.arithmetic) +
                                 "; the bits of this machine are NOT tested";
  if (!is_writing) {
    ASSERT_EQ(golden.arithmetic.version, own.version) << "kArithmeticVersion was raised: " << kHowToWrite;
    if (!is_own && !may_be_own) GTEST_SKIP() << not_tested;
  }
  Bits bits = bits_of_all_programs();
  take_bits_of_garden(golden.bits, bits);
  // Tables of processors that were not at hand are older than the rows of paths.
  const bool has_all =
      std::ranges::any_of(golden.bits, [](const auto& row) { return row.first.starts_with("path, "); });
  if (!is_writing && !has_all) std::printf("SKIPPED: the table has no paths; their bits are NOT tested\n");
  const std::vector<std::string> different = different_rows(golden.bits, bits, has_all && !is_writing);
  if (is_own && !different.empty())
    FAIL() << first_of(different)
           << "\nWhere pixels, paths or hits have other bits than before, raise kArithmeticVersion in "
              "src/cache/arithmetic.h, so that older caches are refused. Then, and when only rows are new:\n"
           << kHowToWrite;
  if (is_writing)
    write_table(bits);
  else if (!different.empty())
    GTEST_SKIP() << not_tested;
}

}  // namespace
}  // namespace relook
