// Which verbs there are, and which options each takes, with the help of each. Values of plain types go straight into
// the arguments; those that have a syntax of our own are texts until the whole line is read (arguments.cpp).
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "options/arguments.h"

namespace relook {

/// Options that need our own syntax, as text until the whole line is read.
struct RawTexts {
  std::string report = "html";
  std::string resolution, memory, import_memory, disk, ray_trees, color_trees, verify, lights, progress = "auto";
  std::string integrator, lens;
  std::optional<std::uint32_t> samples;
  std::string json;  // compare, plan; "-": to stdout
  std::optional<std::string> steps;
  std::vector<const CLI::Option*> inspection_view;  // VIEW of inspect
};

/// `arguments` and `raw` outlive `app`.
void add_verbs(CLI::App& app, Arguments& arguments, RawTexts& raw);

}  // namespace relook
