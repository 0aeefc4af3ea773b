// The page of a run as people use it who choose a look: options as a tree, wedges and grids, A against B, notes, a
// phone, paper (tests/pages/review_page.py); and that pages of 200 and 2,000 steps open quickly.
#include <gtest/gtest.h>

#include <string>

#include "page_browser.h"
#include "synthetic_run.h"

namespace relook {
namespace {

/// A disc on a gradient, whose place and colours follow from the entry.
Rgba disc(std::size_t i, std::uint32_t x, std::uint32_t y) {
  const float dx = static_cast<float>(x) - 40 - static_cast<float>(i * 7 % 80);
  const float dy = static_cast<float>(y) - 45, red = static_cast<float>(i % 5) / 4;
  if (dx * dx + dy * dy < 900) return {red, 0.5F, 1 - red, 1};
  return {0.1F + static_cast<float>(x) / 400, 0.2F, 0.2F + static_cast<float>(y) / 300, 1};
}

PatchOperation replace(const std::string& path, const Json& value) {
  PatchOperation operation;
  operation.path = path;
  operation.value = value;
  return operation;
}

Json axis(const std::string& path, const std::string& label, const Json& texts) {
  return {{"path", path}, {"label", label}, {"texts", texts}};
}

TEST(ReviewPage, a_look_is_chosen_from_70_steps) {
  const ScratchFolder folder("page_review");
  SyntheticRun run(folder / "run", 160, 90, disc);
  run.head["scene"]["file"] = "/srv/shows/secret/watch.gltf";
  run.head["journal"] = {
      {"file", "/srv/shows/secret/looks.json"}, {"hash", "7"}, {"note", "For the launch."}, {"author", "Ana"}};
  run.journal.steps.resize(70);
  run.add(0);
  for (std::size_t step = 1; step <= 69; ++step) {
    if (step == 11) {
      Json& own = run.add_wedge(
          step, Json::array({axis("/lights/Key/intensity", "Key intensity", {"1", "2", "4", "8", "16"})}));
      own["keep"] = false;
      own["from"] = 3;
    } else if (step == 12) {
      run.add_wedge(
          step, Json::array({axis("/materials/Case/roughness", "Case roughness", {"0.1", "0.4", "0.8"}),
                             axis("/lights/Key/color", "Key colour", {"warm", "white", "cool", "night"})}))["from"] =
          nullptr;
    } else {
      Json& entry = run.add(step);
      entry["from"] = step <= 10 ? Json(nullptr) : Json(step - 1);
      if (step >= 20 && step <= 22) entry["pixels_changed"] = 0;
      run.journal.steps[step - 1].edit = {
          replace("/materials/" + std::string(step == 17 ? "Velvet" : "Strap") + "/roughnessFactor",
                  0.01 * static_cast<double>(step))};
    }
  }
  run.entries[5]["note"] = "Bolder, as the client asked.";
  run.entries[5]["author"] = "Bo";
  run.write_report();
  run.write_page();
  use_in_browser("review_page.py", folder / "run", page_expectations(folder / "run", false), folder);
}

TEST(ReviewPage, two_hundred_and_2000_steps_open_quickly) {
  for (const std::size_t count : {std::size_t{200}, std::size_t{2000}}) {
    const ScratchFolder folder("page_quick_" + std::to_string(count));
    SyntheticRun run(folder / "run", 160, 90, disc);
    run.journal.steps.resize(count);
    for (std::size_t step = 0; step <= count; ++step) {
      run.add(step);
      if (step > 0)
        run.journal.steps[step - 1].edit = {
            replace("/materials/Strap/roughnessFactor", 0.0001 * static_cast<double>(step))};
    }
    run.write_report();
    run.write_page();
    Json expected = page_expectations(folder / "run", false);
    expected.update({{"rows", count + 1}, {"mixes", false}, {"words", "material Strap: roughness becomes"}});
    expected["pixels"] = Json::array();
    for (const std::size_t entry : {count, std::size_t{0}, count / 2})
      expected["pixels"].push_back(run.expected_pixel(entry, 77, 41));
    use_in_browser("long_page.py", folder / "run", expected, folder);
  }
}

}  // namespace
}  // namespace relook
