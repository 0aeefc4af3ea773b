#include "record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "base/parallel.h"
#include "report/report.h"

namespace relook {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown";
}

std::string number(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, std::abs(value) >= 1000 ? "%.0f" : "%.3g", value);
  return digits;
}

std::string goal_text(const Figure& figure) {
  if (!figure.goal) return "";
  return (figure.goal->is_most ? "at most " : "at least ") + number(figure.goal->value);
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

std::string cell(const char* tag, const std::string& text) {
  return std::string("<") + tag + ">" + escaped(text) + "</" + tag + ">";
}

template <class Key>
std::vector<std::string> distinct(const std::vector<const Figure*>& figures, Key key) {
  std::vector<std::string> values;
  for (const Figure* figure : figures)
    if (std::ranges::find(values, figure->*key) == values.end()) values.push_back(figure->*key);
  return values;
}

/// Rows by columns, the paper's figure and the goal below each value.
std::string table_html(const std::vector<const Figure*>& figures) {
  const std::vector<std::string> columns = distinct(figures, &Figure::column);
  std::string html = "<table><tr><th></th>";
  for (const std::string& column : columns) html += cell("th", column);
  html += "</tr>\n";
  for (const std::string& row : distinct(figures, &Figure::row)) {
    html += "<tr>" + cell("th", row);
    for (const std::string& column : columns) {
      const auto found = std::ranges::find_if(
          figures, [&](const Figure* figure) { return figure->row == row && figure->column == column; });
      if (found == figures.end()) {
        html += "<td></td>";
        continue;
      }
      const Figure& figure = **found;
      html += !figure.goal ? "<td>" : figure.is_reached() ? "<td class=\"reached\">" : "<td class=\"missed\">";
      html += escaped(number(figure.value) + (figure.unit.empty() ? "" : " " + figure.unit));
      if (!figure.paper.empty()) html += "<small>paper: " + escaped(figure.paper) + "</small>";
      if (figure.goal)
        html += "<small>" + escaped(goal_text(figure)) + (figure.is_reached() ? ": reached" : ": missed") + "</small>";
      html += "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
    "<title>relook: measures</title><style>\n"
    "body { font: 14px/1.4 system-ui, sans-serif; margin: 2rem; color: #1c1d1f; background: #fff; }\n"
    "table { border-collapse: collapse; margin-bottom: 1.5rem; }\n"
    "th, td { border: 1px solid #d2d2ce; padding: .2rem .5rem; text-align: right; vertical-align: top; }\n"
    "th { text-align: left; font-weight: 600; } small { display: block; color: #5b5e63; }\n"
    ".reached { background: #e3f4e6; } .missed { background: #fbe6df; }\n"
    "</style></head><body>\n<h1>relook: measures</h1>\n";

}  // namespace

bool Figure::is_reached() const {
  if (!goal) return true;
  return goal->is_most ? value <= goal->value : value >= goal->value;
}

void Record::add(Figure figure) {
  figure.scene = scene_;
  if (!has_goals_) figure.goal.reset();
  figures_.push_back(std::move(figure));
}

void Record::print_goals() const {
  std::string scene;
  for (const Figure& figure : figures_) {
    if (!figure.goal) continue;
    if (figure.scene != scene)
      std::printf("\n%-92.92s %12s %16s\n", (figure.scene + ": goals").c_str(), "here", "to reach");
    scene = figure.scene;
    std::printf("  %-90.90s %12s %16s  %s\n", (figure.row + ": " + figure.column).c_str(),
                (number(figure.value) + " " + figure.unit).c_str(), goal_text(figure).c_str(),
                figure.is_reached() ? "reached" : "missed");
  }
}

Json Record::json() const {
  Json figures = Json::array();
  for (const Figure& figure : figures_) {
    Json entry{{"scene", figure.scene},   {"table", figure.table}, {"row", figure.row},
               {"column", figure.column}, {"value", figure.value}, {"unit", figure.unit}};
    entry["paper"] = figure.paper.empty() ? Json(nullptr) : Json(figure.paper);
    entry["goal"] = nullptr;
    if (figure.goal)
      entry["goal"] = {{figure.goal->is_most ? "at_most" : "at_least", figure.goal->value},
                       {"reached", figure.is_reached()}};
    figures.push_back(std::move(entry));
  }
  return {{"relook", "bench/1"},
          {"program", program_version()},
          {"machine", {{"threads", thread_count()}, {"cpu", cpu_model()}}},
          {"figures", std::move(figures)}};
}

std::string Record::html() const {
  std::string html = kHead;
  html += "<p>" +
          escaped("relook " + std::string(program_version()) + ", " + std::to_string(thread_count()) + " threads, " +
                  cpu_model()) +
          "</p>\n";
  std::vector<const Figure*> all;
  for (const Figure& figure : figures_) all.push_back(&figure);
  for (const std::string& scene : distinct(all, &Figure::scene)) {
    html += cell("h2", scene) + "\n";
    std::vector<const Figure*> of_scene;
    std::ranges::copy_if(all, std::back_inserter(of_scene), [&](const Figure* f) { return f->scene == scene; });
    for (const std::string& table : distinct(of_scene, &Figure::table)) {
      std::vector<const Figure*> of_table;
      std::ranges::copy_if(of_scene, std::back_inserter(of_table), [&](const Figure* f) { return f->table == table; });
      html += cell("h3", table) + "\n" + table_html(of_table);
    }
  }
  return html + "</body></html>\n";
}

}  // namespace relook
