// `relook compare` on what `--aovs` writes, as scripts see it: no channel of it may differ unseen.
#include <gtest/gtest.h>

#include "base/files.h"
#include "compare/file_comparison.h"
#include "compare_file.h"
#include "run_program.h"

namespace relook {
namespace {

class CompareLayers : public testing::Test {
 protected:
  CompareLayers() {
    const ProgramResult result =
        run_program({RELOOK_PROGRAM, "render", kScene, "--integrator", "whitted", "-o", at("a.exr"), "--resolution",
                     "24x16", "--samples", "3", "--aovs", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static ProgramResult compare(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {RELOOK_PROGRAM, "compare"});
    arguments.insert(arguments.end(), {"--progress", "none"});
    return run_program(arguments);
  }
  ScratchFolder folder_{"compare_layers"};
};

TEST_F(CompareLayers, an_edit_of_one_sample_of_any_channel_is_found) {
  const bool has_idiff = run_program({"sh", "-c", "command -v idiff"}).exit_code == 0;
  if (!has_idiff) std::printf("no idiff here to compare with; install openimageio-tools\n");
  const std::vector<FilePart> parts = read_parts(at("a.exr"));
  ASSERT_EQ(parts.size(), 1U);
  ASSERT_GT(parts[0].channels.size(), 40U);
  write_parts(at("same.exr"), parts);
  const ProgramResult same = compare({at("a.exr"), at("same.exr")});
  EXPECT_EQ(same.exit_code, 0) << same.output;
  std::size_t pixel = 0;
  for (const auto& [name, channel] : parts[0].channels) {
    std::vector<FilePart> edited = parts;
    pixel = (pixel + 101) % parts[0].pixels();
    edited[0].channels[name].set(pixel, 0.25F);
    if (edited[0].channels[name].samples == channel.samples) edited[0].channels[name].set(pixel, 0.75F);
    write_parts(at("b.exr"), edited);
    const ProgramResult found = compare({at("a.exr"), at("b.exr")});
    EXPECT_EQ(found.exit_code, 10) << name;
    EXPECT_NE(found.output.find("first difference: channel " + name + "\n"), std::string::npos) << found.output;
    EXPECT_NE(found.output.find(": 1 of 384 pixels differ"), std::string::npos) << found.output;
    if (has_idiff) {
      EXPECT_NE(run_program({"idiff", at("a.exr"), at("b.exr")}).exit_code, 0) << name;
    }
  }
}

TEST_F(CompareLayers, one_bit_of_any_channel_is_found) {
  const std::vector<FilePart> parts = read_parts(at("a.exr"));
  const ExrFile first(read_file(at("a.exr")), "a.exr");
  for (const auto& [name, channel] : parts[0].channels) {
    std::vector<FilePart> edited = parts;
    edited[0].channels[name].flip_bit(200);
    write_parts(at("b.exr"), edited);
    const ExrFile second(read_file(at("b.exr")), "b.exr");
    const FrameComparison comparison = compare_exr_files(first, second, {}, std::nullopt).comparison;
    EXPECT_EQ(comparison.verdict, Verdict::failure) << name;
    EXPECT_EQ(comparison.first_difference, "channel " + name);
    const bool is_rank = name.starts_with("Crypto");
    const Verdict lenient =
        compare_exr_files(first, second, {.fail = 1e30, .fail_percent = 100}, std::nullopt).comparison.verdict;
    EXPECT_EQ(lenient, is_rank ? Verdict::failure : Verdict::within) << name;
  }
}

TEST_F(CompareLayers, runs_differ_when_a_layer_does) {
  for (const char* folder : {"one", "two"}) std::filesystem::create_directories(folder_ / folder / "frames");
  std::vector<FilePart> parts = read_parts(at("a.exr"));
  write_parts(at("one/frames/0000.exr"), parts);
  parts[0].channels["depth.Z"].set(5, 7);
  parts[0].channels["N.X"].set(5, 7);
  write_parts(at("two/frames/0000.exr"), parts);
  const ProgramResult text = compare({at("one"), at("two")});
  EXPECT_EQ(text.exit_code, 10);
  EXPECT_NE(text.output.find("0000.exr: layer N: 1 of 384 pixels differ"), std::string::npos) << text.output;
  EXPECT_NE(text.output.find("0000.exr: layer depth: 1 of 384 pixels differ"), std::string::npos) << text.output;
  EXPECT_NE(text.output.find("total: 0 of 384 pixels differ, max error 0, RMS error 0, in 2 layers"), std::string::npos)
      << text.output;
  EXPECT_EQ(text.output.find("layer albedo"), std::string::npos) << "no line for an equal layer";
  EXPECT_EQ(compare({at("one"), at("two"), "-o", at("report")}).exit_code, 10);
  const Bytes bytes = read_file(folder_ / "report/compare.json"), page = read_file(folder_ / "report/compare.html");
  const Json json = parse_json(text_of(bytes), "compare.json");
  EXPECT_EQ(json["relook"], "compare/1");
  EXPECT_EQ(json["total"]["layers_different"], 2);
  const Json& frame = json["frames"]["0000.exr"];
  EXPECT_EQ(frame["first_difference"], "channel N.X");
  std::size_t equal = 0;
  for (const Json& layer : frame["layers"]) equal += layer["verdict"] == "equal" ? 1U : 0U;
  EXPECT_EQ(equal, frame["layers"].size() - 2);
  EXPECT_NE(text_of(page).find("Layers that differ"), std::string_view::npos);
  EXPECT_NE(text_of(page).find("channel depth.Z"), std::string_view::npos);
}

TEST_F(CompareLayers, files_without_a_picture_have_a_page) {
  FilePart part;
  part.fill("Z", 3);
  write_parts(at("z.exr"), {part});
  part.channels["Z"].set(7, 4);
  write_parts(at("y.exr"), {part});
  EXPECT_EQ(compare({at("z.exr"), at("z.exr"), "-o", at("same")}).exit_code, 0);
  const ProgramResult result = compare({at("z.exr"), at("y.exr"), "-o", at("other")});
  EXPECT_EQ(result.exit_code, 10);
  EXPECT_NE(result.output.find("y.exr: layer Z: 1 of 48 pixels differ, max error 1"), std::string::npos)
      << result.output;
  const Bytes page = read_file(folder_ / "other/compare.html");
  EXPECT_EQ(text_of(page).find("data:image"), std::string_view::npos);
  EXPECT_TRUE(text_of(page).ends_with("</html>\n"));
}

}  // namespace
}  // namespace relook
