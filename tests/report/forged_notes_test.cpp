// What a run folder says of itself may have been changed by anybody: a replay into it ends with the frames of an
// undisturbed run, bit for bit, and a report of the same facts, or with one line; never with less and exit code 0.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "base/files.h"
#include "base/hash.h"
#include "base/json.h"
#include "report/run_entry_check.h"
#include "report/run_ledger.h"
#include "run_program.h"

namespace relook {
namespace {

namespace fs = std::filesystem;
using Pointer = Json::json_pointer;

constexpr const char* kRunJournal = R"({"relook": "journal/1", "steps": [
  {"name": "red", "edit": [{"op": "replace", "path": "/materials/Paint/pbrMetallicRoughness/baseColorFactor",
                            "value": [0.9, 0.3, 0.2, 1]}]},
  {"name": "up", "edit": [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0, 1.3, 0]}]},
  {"name": "drag", "select": ["/nodes/CentralSphere"], "drag": [
     [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.2, 1, 0]}],
     [{"op": "replace", "path": "/nodes/CentralSphere/translation", "value": [0.4, 1, 0.1]}]]},
  {"name": "wedge", "wedge": {"path": "/materials/Glass/extensions/KHR_materials_ior/ior", "values": [1.2, 1.7]}},
  {"name": "last", "edit": [{"op": "replace", "path": "/nodes/Lamp/translation", "value": [-1, 5.5, 4]}]}]})";

/// Members that others must agree with, and those that nothing on disk but the entry says.
constexpr std::array kFacts{"step",    "name",       "class",       "frame", "frame_hash",
                            "preview", "drag_frame", "wedge_frame", "edits", "samples_total"};
constexpr std::array kOnlySaid{"pixels_changed", "overlays", "verify", "verify_percent"};

enum class Lie { type, others, huge, negative };

Json lie_of(const Json& value, const Json& others, Lie lie) {
  switch (lie) {
    case Lie::type:
      return value.is_string() ? Json(7) : value.is_structured() ? Json("none") : Json::array({value});
    case Lie::others:
      return others;
    case Lie::huge:
      return value.is_string() ? Json("../../" + std::string(5000, 'x')) : Json(18446744073709551615ULL);
    case Lie::negative:
      return value.is_string() ? Json("\xE2\x80\xAE/etc/passwd") : Json(-1);
  }
  return nullptr;
}

class ForgedNotes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchFolder>("forged_notes");
    const std::string scene = (fs::path(RELOOK_SOURCE_DIR) / "scenes/spheres/spheres.gltf").string();
    std::ofstream(at("j.json")) << kRunJournal;
    ASSERT_EQ(run_program({RELOOK_PROGRAM, "preprocess", scene, "-o", at("c"), "--resolution", "32x18", "--samples",
                           "2", "--quiet"})
                  .exit_code,
              0);
    const ProgramResult whole = replay("whole");
    ASSERT_EQ(whole.exit_code, 0) << whole.output;
    frames_ = frames_in("whole");
    report_ = read_json(at("whole/report.json"));
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string at(const std::string& name) { return (*folder_ / name).string(); }
  static Json read_json(const std::string& path) { return parse_json(text_of(read_file(path)), path); }
  static ProgramResult replay(const std::string& run) {
    return run_program({RELOOK_PROGRAM, "replay", at("c"), at("j.json"), "-o", at(run), "--quiet", "--report", "json"});
  }
  static std::map<std::string, Bytes> frames_in(const std::string& run) {
    std::map<std::string, Bytes> frames;
    for (const char* part : {"frames", "previews"})
      for (const auto& entry : fs::directory_iterator(at(run + "/" + part)))
        frames[entry.path().lexically_relative(at(run)).string()] =
            entry.is_symlink() || !entry.is_regular_file() ? Bytes() : read_file(entry.path());
    return frames;
  }

  /// The finished run again.
  static void copy_run() {
    fs::remove_all(at("run"));
    fs::copy(at("whole"), at("run"), fs::copy_options::recursive);
    for (const auto& [name, bytes] : frames_)  // so that a time of change tells as little as it can
      fs::last_write_time(at("run/" + name), fs::last_write_time(at("whole/" + name)));
  }
  static Json entries() {
    Json steps = report_["steps"];
    for (Json& step : steps) step.erase("seal");
    return steps;
  }
  /// The finished run with these entries as notes of a command that was killed.
  static void write_progress(const Json& entries, bool with_hashes) {
    copy_run();
    fs::remove(at("run/report.json"));
    const Json head =
        RunLedger::head_of({0, 5, report_["steps"].back()["edits"].get<std::string>(), false}, report_["source"]);
    std::ofstream file(at("run/progress.jsonl"));
    const auto line = [&](const Json& entry, const std::string& hashed) {
      file << hash128(bytes_of(hashed)) << " " << entry.dump() << "\n";
    };
    line(head, head.dump());
    const Json honest = ForgedNotes::entries();
    for (std::size_t i = 0; i < entries.size(); ++i)
      line(entries[i], with_hashes || i >= honest.size() ? entries[i].dump() : honest[i].dump());
  }
  /// The finished run with these entries in its report.
  static void write_report(const Json& entries, bool with_seals) {
    copy_run();
    std::string text(text_of(read_file(at("whole/report.json"))));
    const std::size_t begin = text.find("\"steps\": [\n") + 11, end = text.find("\n  ],\n  \"frames\"");
    std::string lines;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      Json entry = entries[i];
      if (!with_seals && i < report_["steps"].size()) entry["seal"] = report_["steps"][i]["seal"];
      lines += (i == 0 ? "" : ",\n") + (with_seals ? sealed(entry.dump()) : entry.dump());
    }
    std::ofstream(at("run/report.json")) << text.replace(begin, end - begin, lines);
  }

  /// Resumes. `may_refuse`: one line is an answer, too. `believes`: what only entries say is believed.
  static void expect_whole(bool may_refuse, bool believes = false) {
    const ProgramResult result = replay("run");
    if (may_refuse && result.exit_code != 0) {
      EXPECT_TRUE(std::set({1, 2, 5}).contains(result.exit_code)) << result.output;
      EXPECT_EQ(std::ranges::count(result.output, '\n'), 1) << result.output;
      EXPECT_TRUE(result.output.starts_with("relook: ")) << result.output;
      return;
    }
    ASSERT_EQ(result.exit_code, 0) << result.output;
    EXPECT_LE(std::ranges::count(result.output, '\n'), 1) << result.output;
    EXPECT_TRUE(frames_in("run") == frames_);
    const Json report = read_json(at("run/report.json"));
    for (const char* key :
         {"relook", "scene", "source", "journal", "camera", "resolution", "samples", "frames", "interrupted", "parts"})
      EXPECT_EQ(report[key], report_[key]) << key;
    ASSERT_EQ(report["steps"].size(), report_["steps"].size());
    for (std::size_t i = 0; i < report_["steps"].size(); ++i) {
      SCOPED_TRACE("entry " + std::to_string(i));
      const Json &now = report["steps"][i], &then = report_["steps"][i];
      for (const char* key : kFacts) EXPECT_EQ(now[key], then[key]) << key;
      for (const char* key : kOnlySaid) EXPECT_TRUE(believes || now[key] == then[key]) << key;
      for (const auto& [name, stamp] : then["files"].items())
        for (const char* key : {"hash", "bytes"}) EXPECT_EQ(now["files"][name][key], stamp[key]) << name;
    }
    EXPECT_EQ(replay("run").output, "") << "nothing is left to warn of";
  }

  static std::vector<Pointer> leaves() {
    std::set<Pointer> all;
    const Json steps = entries();
    const std::function<void(const Json&, const Pointer&)> visit = [&](const Json& value, const Pointer& at) {
      all.insert(at);
      if (value.is_object() && at.to_string() != "/files")
        for (const auto& [key, part] : value.items()) visit(part, at / key);
    };
    for (const auto& [key, value] : steps[1].items()) visit(value, Pointer() / key);
    std::vector<Pointer> pointers(all.begin(), all.end());
    for (const char* key : {"hash", "bytes", "modified"}) pointers.push_back(Pointer("/files/frame") / key);
    return pointers;
  }
  /// A place within an entry: "/files/frame" stands for its frame's own.
  static Pointer placed(const Json& entry, const Pointer& pointer) {
    if (!pointer.to_string().starts_with("/files/frame")) return pointer;
    return Pointer("/files") / entry["frame"].get<std::string>() / pointer.back();
  }

  static inline std::unique_ptr<ScratchFolder> folder_;
  static inline std::map<std::string, Bytes> frames_;
  static inline Json report_;
};

/// Each member of an entry, of another entry each: a few runs are enough.
TEST_F(ForgedNotes, any_member_of_an_entry) {
  const std::vector<Pointer> pointers = leaves();
  ASSERT_GT(pointers.size(), 60U);
  const std::set<std::string> keys{"/edits", "/step", "/drag_frame", "/wedge_frame"};  // what finds an entry
  for (const Lie lie : {Lie::type, Lie::others, Lie::huge, Lie::negative})
    for (const bool is_sealed : {false, true})
      for (const bool in_report : {false, true}) {
        Json steps = entries();
        std::size_t lies = 0;
        const auto check = [&](const std::string& what) {
          SCOPED_TRACE("lie " + std::to_string(static_cast<int>(lie)) + (is_sealed ? " sealed" : " not sealed") +
                       (in_report ? " in the report" : " in the notes") + ", to " + what);
          in_report ? write_report(steps, is_sealed) : write_progress(steps, is_sealed);
          expect_whole(is_sealed, is_sealed);
          steps = entries();
          lies = 0;
        };
        for (const Pointer& pointer : pointers) {
          Json& entry = steps[lies];
          const Json& others = steps[(lies + 1) % steps.size()];
          const Pointer place = placed(entry, pointer), there = placed(others, pointer);
          if (entry.contains(place))
            entry[place] = lie_of(entry[place], others.contains(there) ? others[there] : Json(), lie);
          if (++lies == steps.size() || keys.contains(pointer.to_string())) check(pointer.to_string());
        }
        if (lies > 0) check("the last ones");
      }
}

TEST_F(ForgedNotes, entries_in_another_order_twice_or_of_nothing) {
  const Json honest = entries();
  std::map<std::string, Json> cases;
  cases["twice"] = honest;
  cases["twice"].push_back(honest[1]);
  cases["swapped"] = honest;
  std::swap(cases["swapped"][1], cases["swapped"][2]);
  cases["steps swapped"] = honest;
  std::swap(cases["steps swapped"][1]["step"], cases["steps swapped"][2]["step"]);
  cases["one missing"] = honest;
  cases["one missing"].erase(2);
  cases["no whole step"] = honest;
  cases["no whole step"].erase(5);
  cases["of no step"] = honest;
  cases["of no step"].push_back(honest[1]);
  cases["of no step"].back()["step"] = 99;
  cases["of no file"] = honest;
  cases["of no file"][1]["files"] = Json::object();
  cases["of a file elsewhere"] = honest;
  cases["of a file elsewhere"][1]["files"]["../../secret"] = honest[1]["files"].begin().value();
  for (const auto& [name, steps] : cases)
    for (const bool in_report : {false, true}) {
      SCOPED_TRACE(name + (in_report ? " in the report" : " in the notes"));
      in_report ? write_report(steps, true) : write_progress(steps, true);
      expect_whole(true);
    }
}

TEST_F(ForgedNotes, the_report_around_the_entries) {
  const std::string text(text_of(read_file(at("whole/report.json"))));
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"\"interrupted\": false", "\"interrupted\": 0"},
           {"\"interrupted\": false", "\"interrupted\": true"},
           {"\"0-5\"", "\"0-4294967295\""},
           {"\"camera\": \"", "\"camera\": \"x"},
           {"\"samples\": 2", "\"samples\": -2"},
           {"\"full_render_seconds\": null", "\"full_render_seconds\": []"},
           {"    \"frames/0001.exr\": \"", "    \"frames/0001.exr\": \"0"},
           {"\n  }\n}\n", ",\n    \"frames/0099.exr\": \"0\"\n  }\n}\n"},
           {"\n  }\n}\n", "\n  }\n}\n\n{}"}}) {
    SCOPED_TRACE(to);
    ASSERT_NE(text.rfind(from), text.npos);
    copy_run();
    std::string forged = text;
    std::ofstream(at("run/report.json")) << forged.replace(text.rfind(from), from.size(), to);
    expect_whole(from.starts_with("\"camera"));  // of another source: refused
  }
}

/// Notes and seals are made anew by whoever changes the files: hash, size and time are those of the file.
TEST_F(ForgedNotes, another_file_in_the_place_of_a_frame) {
  const std::string first = "frames/0001.exr", second = "frames/0002.exr";
  const std::map<std::string, std::function<void()>> changes{
      {"missing", [&] { fs::remove(at("run/" + first)); }},
      {"empty", [&] { fs::resize_file(at("run/" + first), 0); }},
      {"of another step",
       [&] { fs::copy_file(at("run/" + second), at("run/" + first), fs::copy_options::overwrite_existing); }},
      {"a link to another step",
       [&] {
         fs::remove(at("run/" + first));
         fs::create_symlink("0002.exr", at("run/" + first));
       }},
      {"a hard link to another step",
       [&] {
         fs::remove(at("run/" + first));
         fs::create_hard_link(at("run/" + second), at("run/" + first));
       }},
      {"a FIFO",
       [&] {
         fs::remove(at("run/" + first));
         ASSERT_EQ(mkfifo(at("run/" + first).c_str(), 0666), 0);
       }},
      {"a byte changed under the same time", [&] {
         const auto time = fs::last_write_time(at("run/" + first));
         std::fstream file(at("run/" + first), std::ios::in | std::ios::out | std::ios::binary);
         file.seekp(-1, std::ios::end);
         file.put('\x55');
         file.close();
         fs::last_write_time(at("run/" + first), time);
       }}};
  for (const auto& [name, change] : changes)
    for (const bool notes_it : {false, true})
      for (const bool in_report : {false, true}) {
        if (notes_it && name.starts_with("a byte")) continue;  // a frame as good as any
        SCOPED_TRACE(name + (notes_it ? " and noted" : "") + (in_report ? " in the report" : " in the notes"));
        copy_run();
        change();
        Json steps = entries();
        const fs::path file = at("run/" + first);
        if (notes_it && fs::is_regular_file(file)) {
          const Bytes bytes = read_file(file);
          struct stat status {};
          ASSERT_EQ(stat(file.c_str(), &status), 0);
          Json& stamp = steps[1]["files"][first];
          stamp["hash"] = steps[1]["frame_hash"] = hash128(bytes);
          stamp["bytes"] = bytes.size();
          stamp["modified"] = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
        }
        in_report ? write_report(steps, true) : write_progress(steps, true);
        change();
        expect_whole(name == "a FIFO" || name == "empty");
      }
}

/// Files beyond the run are not touched, whatever a note names.
TEST_F(ForgedNotes, nothing_outside_the_run_is_removed) {
  std::ofstream(at("secret")) << "kept";
  Json steps = entries();
  for (Json& entry : steps) {
    entry["frame"] = "../secret";
    entry["files"] = {{"../secret", entry["files"].begin().value()}};
  }
  for (const bool in_report : {false, true}) {
    in_report ? write_report(steps, true) : write_progress(steps, true);
    expect_whole(true);
    EXPECT_EQ(text_of(read_file(at("secret"))), "kept");
  }
}

}  // namespace
}  // namespace relook
