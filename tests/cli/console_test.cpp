// What is printed where: on terminals of several kinds, into pipes whose reader has gone, and for errors of many lines.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "terminal.h"

namespace relook {
namespace {

constexpr const char* kJournal = R"({"relook": "journal/1", "steps": [
  {"edit": [{"op": "replace", "path": "/lights/Lamp/intensity", "value": 40}]}]})";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class ConsoleOutput : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  /// What a render shows on a terminal whose environment these settings of `env` change.
  [[nodiscard]] std::string shown(std::vector<std::string> environment, std::vector<std::string> options = {}) const {
    std::vector<std::string> command{"env", "-u", "NO_COLOR"};
    command.insert(command.end(), environment.begin(), environment.end());
    for (const char* word : {RELOOK_PROGRAM, "render", kScene.c_str(), "--resolution", "64x36", "-o"})
      command.emplace_back(word);
    command.push_back(at("x.exr"));
    command.insert(command.end(), options.begin(), options.end());
    const ProgramResult result = run_on_terminal(command);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return result.output;
  }
  ScratchFolder folder_{"console"};
};

TEST_F(ConsoleOutput, a_terminal_gets_a_bar) {
  const std::string output = shown({"TERM=xterm"});
  EXPECT_TRUE(has(output, "\r[##############################] 100 % render\x1b[K")) << output;
  EXPECT_TRUE(has(output, "\r\x1b[K")) << output;
}

TEST_F(ConsoleOutput, a_dumb_terminal_gets_plain_lines) {
  for (const char* setting : {"TERM=dumb", "TERM=", "--unset=TERM"}) {
    const std::string output = shown({setting});
    EXPECT_TRUE(has(output, "render: 100 %\r\n")) << setting << output;
    EXPECT_FALSE(has(output, "\r[")) << setting << output;
    EXPECT_FALSE(has(output, "\x1b")) << setting << output;
  }
}

TEST_F(ConsoleOutput, no_color_means_no_escape_sequences) {
  const std::string output = shown({"TERM=xterm", "NO_COLOR=1"});
  EXPECT_TRUE(has(output, "\r[##############################] 100 % render")) << output;
  EXPECT_FALSE(has(output, "\x1b")) << output;
  const std::string cleared = "\r" + std::string(std::string("[] 100 % render").size() + 30, ' ') + "\r";
  EXPECT_TRUE(has(output, cleared)) << output;
  EXPECT_TRUE(has(shown({"TERM=xterm", "NO_COLOR="}), "\x1b[K")) << "an empty NO_COLOR asks for nothing";
}

TEST_F(ConsoleOutput, a_journal_is_not_awaited_from_a_terminal) {
  const ProgramResult result = run_on_terminal({RELOOK_PROGRAM, "inspect", "-"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.output, "relook: stdin: is a terminal; \"-\" reads from a pipe or a file\r\n");
}

/// Runs the program with a standard output that nobody reads any more; the rest of its output is returned.
ProgramResult run_unread(int output, std::vector<std::string> arguments) {
  const std::string redirection = "exec \"$@\" >&" + std::to_string(output);
  arguments.insert(arguments.begin(), {"sh", "-c", redirection, "sh", RELOOK_PROGRAM});
  return run_program(arguments);
}

TEST_F(ConsoleOutput, a_reader_that_has_gone_is_no_error) {
  write_file(at("j.json"), std::string_view(kJournal));
  ASSERT_EQ(
      run_program({RELOOK_PROGRAM, "preprocess", kScene, "-o", at("c"), "--resolution", "64x36", "--quiet"}).exit_code,
      0);
  ASSERT_EQ(run_program({RELOOK_PROGRAM, "replay", at("c"), at("j.json"), "-o", at("run"), "--quiet"}).exit_code, 0);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  int sockets[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets), 0);
  close(ends[0]);
  close(sockets[0]);
  for (const int output : {ends[1], sockets[1]}) {
    for (const auto& [arguments, code] : std::vector<std::pair<std::vector<std::string>, int>>{
             {{"inspect", kScene, "--look"}, 0},
             {{"inspect", at("run")}, 0},
             {{"inspect", at("run"), "--json"}, 0},
             {{"completions", "bash"}, 0},
             {{"check", at("c"), "--progress", "none"}, 0},
             {{"compare", at("run/frames/0000.exr"), at("run/frames/0001.exr"), "--progress", "none"}, 10},
             {{"replay", at("c"), at("j.json"), "-o", at("again"), "--progress", "openjd", "--fresh"}, 0}}) {
      const ProgramResult result = run_unread(output, arguments);
      EXPECT_EQ(result.exit_code, code) << arguments[0] << ": " << result.output;
      EXPECT_EQ(result.output.find("relook:"), std::string::npos) << arguments[0] << ": " << result.output;
    }
    EXPECT_EQ(read_file(at("again/frames/0001.exr")), read_file(at("run/frames/0001.exr")));
    std::filesystem::remove_all(at("again"));
  }
  close(ends[1]);
  close(sockets[1]);
}

TEST_F(ConsoleOutput, the_log_of_a_replay_leaves_a_pipe_to_results) {
  write_file(at("j.json"), std::string_view(kJournal));
  ASSERT_EQ(
      run_program({RELOOK_PROGRAM, "preprocess", kScene, "-o", at("c"), "--resolution", "64x36", "--quiet"}).exit_code,
      0);
  struct Streams {
    std::string out, err;
  };
  /// `after`: "| cat" for a pipe.
  const auto replayed = [&](const std::string& options, const std::string& after) {
    const ProgramResult result = run_program(
        {"sh", "-c",
         "cd \"$1\" && \"$2\" replay c j.json -o run --fresh --progress none " + options + " 2>err " + after + " >out",
         "sh", at(""), RELOOK_PROGRAM});
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return Streams{std::string(text_of(read_file(at("out")))), std::string(text_of(read_file(at("err"))))};
  };
  const std::string line = "1 color \"step 1\": ";
  const Streams file = replayed("", ""), pipe = replayed("", "| cat"), json = replayed("--json", "| cat");
  EXPECT_TRUE(has(file.out, line)) << file.out;
  EXPECT_EQ(file.err, "");
  EXPECT_TRUE(has(pipe.err, line)) << pipe.err;
  EXPECT_FALSE(has(pipe.out, line)) << pipe.out;
  EXPECT_EQ(json.err, "") << "no progress, no log beside JSON";
  EXPECT_TRUE(parse_json(json.out, "out").contains("runs"));
  const Streams logged = replayed("--log-json", ""), quiet = replayed("--quiet", "| cat");
  EXPECT_FALSE(has(logged.out, line)) << logged.out;
  const Json entry = parse_json(logged.err.substr(0, logged.err.find('\n')), "log");
  EXPECT_EQ(entry["level"], "info");
  EXPECT_TRUE(has(entry["message"], "0 base"));
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(ConsoleOutput, a_full_disk_under_standard_output_is_an_error_after_the_work) {
  const ProgramResult result = run_program({"sh", "-c", "exec \"$@\" >/dev/full", "sh", RELOOK_PROGRAM, "render",
                                            kScene, "-o", at("x.exr"), "--resolution", "64x36", "--progress", "none"});
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_EQ(result.output, "relook: standard output: cannot be written\n");
  EXPECT_TRUE(std::filesystem::exists(at("x.exr")));
}

TEST_F(ConsoleOutput, each_wrong_step_has_its_line_in_every_format) {
  write_file(at("j.json"), std::string_view(R"({"relook": "journal/1", "steps": [{}, {"edit": []}, {"wedge": 3}]})"));
  const std::string file = at("j.json");
  const std::string first = file + ": /steps/0: a step needs \"edit\", \"wedge\", or \"select\" and \"drag\"",
                    second = file + ": /steps/2/wedge: must be an object";
  const ProgramResult plain = run_program({RELOOK_PROGRAM, "inspect", file});
  EXPECT_EQ(plain.exit_code, 2);
  EXPECT_EQ(plain.output, "relook: " + first + "\nrelook: " + second + "\n");
  const ProgramResult openjd = run_program({RELOOK_PROGRAM, "inspect", file, "--progress", "openjd"});
  EXPECT_EQ(openjd.exit_code, 2);
  EXPECT_TRUE(has(openjd.output, "openjd_fail: " + first + "; 1 more line\n")) << openjd.output;
  EXPECT_EQ(openjd.output.find("openjd_fail"), openjd.output.rfind("openjd_fail"));
  const ProgramResult logged = run_program({RELOOK_PROGRAM, "inspect", file, "--log-json"});
  EXPECT_EQ(logged.exit_code, 2);
  const std::size_t end = logged.output.find('\n');
  for (const auto& [line, message] :
       {std::pair{logged.output.substr(0, end), first}, {logged.output.substr(end + 1), second}}) {
    const Json entry = parse_json(line, "log");
    EXPECT_EQ(entry["level"], "error");
    EXPECT_EQ(entry["exit_code"], 2);
    EXPECT_EQ(entry["message"], message);
  }
}

}  // namespace
}  // namespace relook
