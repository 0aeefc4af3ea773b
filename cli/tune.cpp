// `relook tune`: what each eviction policy and budget would have cost a replay, from its access log.
#include <cstdio>

#include "cache/residency/access_log.h"
#include "verbs.h"

namespace relook {
namespace {

constexpr int kShares[] = {5, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100};  // percent of all pieces

struct Row {
  std::uint64_t memory_bytes = 0;
  std::vector<TrialCost> policies;  // in the order of kEvictionPolicies
  TrialCost clairvoyant;
};

Row row_of(const AccessLog& log, std::uint64_t memory_bytes) {
  Row row;
  row.memory_bytes = memory_bytes;
  for (const EvictionPolicy policy : kEvictionPolicies) row.policies.push_back(try_policy(log, policy, memory_bytes));
  row.clairvoyant = try_clairvoyant(log, memory_bytes);
  return row;
}

Json cost_json(const TrialCost& cost) {
  return {{"returns", cost.returns}, {"bytes", cost.bytes}, {"seconds", cost.seconds}};
}

Json row_json(const Row& row) {
  Json policies = Json::object();
  for (std::size_t i = 0; i < row.policies.size(); ++i)
    policies[std::string(policy_name(kEvictionPolicies[i]))] = cost_json(row.policies[i]);
  policies["clairvoyant"] = cost_json(row.clairvoyant);
  return {{"memory", row.memory_bytes}, {"policies", std::move(policies)}};
}

std::string text(const Row& row) {
  char cell[64];
  std::snprintf(cell, sizeof cell, "%8.1f M", static_cast<double>(row.memory_bytes) / (1 << 20));
  std::string line = cell;
  for (const TrialCost& cost : row.policies) {
    std::snprintf(cell, sizeof cell, " %11.4f", cost.seconds);
    line += cell;
  }
  std::snprintf(cell, sizeof cell, " %11.4f", row.clairvoyant.seconds);
  return line + cell;
}

}  // namespace

ExitCode run_tune(const Arguments& arguments, Console& console) {
  const std::string& file = arguments.inputs[0];
  const Bytes bytes = read_file(file);
  const AccessLog log = parse_access_log(text_of(bytes), file);
  console.line(std::to_string(log.accesses.size()) + " accesses to " + std::to_string(log.pieces) +
               " pieces; seconds to have back what has left, by memory for pieces and by policy");
  std::string head = "    memory";
  for (const EvictionPolicy policy : kEvictionPolicies) {
    char cell[32];
    std::snprintf(cell, sizeof cell, " %11s", std::string(policy_name(policy)).c_str());
    head += cell;
  }
  console.line(head + " clairvoyant");
  Json rows = Json::array();
  const Progress progress = console.stage("trying");
  for (std::size_t i = 0; i < std::size(kShares); ++i) {
    progress(static_cast<double>(i) / std::size(kShares));
    const Row row = row_of(log, log.total_bytes() / 100 * static_cast<std::uint64_t>(kShares[i]) +
                                    (kShares[i] == 100 ? log.total_bytes() % 100 : 0));
    console.line(text(row));
    rows.push_back(row_json(row));
  }
  console.end_stage();
  console.json({{"accesses", log.accesses.size()},
                {"pieces", log.pieces},
                {"bytes", log.total_bytes()},
                {"largest_piece", log.largest_bytes()},
                {"budgets", std::move(rows)}});
  return ExitCode::ok;
}

}  // namespace relook
