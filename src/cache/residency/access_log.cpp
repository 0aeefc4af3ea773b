#include "cache/residency/access_log.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

/// Takes the fields of a line one by one.
class Fields {
 public:
  Fields(std::string_view line, std::string_view file, std::size_t number)
      : rest_(line), file_(file), number_(number) {}

  std::string_view word() {
    const std::size_t end = std::min(rest_.find(' '), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (word.empty()) refuse("six fields: change, kind, tile, bytes, seconds, surface area");
    return word;
  }
  template <class T>
  T number(const char* what) {
    const std::string_view text = word();
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) refuse(what);
    return value;
  }
  double measure(const char* what) {
    const auto value = number<double>(what);
    if (!std::isfinite(value) || value < 0) refuse(what);
    return value;
  }
  void end() const {
    if (!rest_.empty()) refuse("nothing after the surface area");
  }
  [[noreturn]] void refuse(const char* expected) const {
    throw InputError(file_, "line " + std::to_string(number_), std::string("expected ") + expected);
  }

 private:
  std::string_view rest_, file_;
  std::size_t number_;
};

/// The pieces in memory, replayed access by access.
class Trial {
 public:
  /// The weight of a piece, of which the lowest leaves first, from the piece and the number of the change.
  using Weigh = std::function<double(std::uint32_t piece, const PieceFacts& facts, std::uint64_t change)>;

  Trial(const AccessLog& log, std::uint64_t memory_bytes, Weigh weigh)
      : memory_(memory_bytes), weigh_(std::move(weigh)), pieces_(log.pieces) {}

  void access(const Access& access) {
    if (access.change != change_) candidates_.clear();
    change_ = access.change;
    Piece& piece = pieces_[access.piece];
    if (piece.facts.uses > 0 && !piece.is_resident) {
      ++cost_.returns;
      cost_.bytes += access.facts.bytes;
      cost_.seconds += access.facts.return_seconds;
    }
    if (piece.is_resident) resident_ -= piece.facts.bytes;
    piece.is_resident = true;
    resident_ += access.facts.bytes;
    const std::uint64_t uses = piece.facts.uses + 1;
    piece.facts = access.facts;
    piece.facts.uses = uses;
    piece.facts.last_use = access.change;
    piece.facts.gdsf_inflation = inflation_;
    make_room(access.piece);
  }
  [[nodiscard]] const TrialCost& cost() const { return cost_; }

 private:
  struct Piece {
    bool is_resident = false;
    PieceFacts facts;
  };
  void make_room(std::uint32_t in_use) {
    for (bool is_listed = false; resident_ > memory_;) {
      if (candidates_.empty()) {
        if (std::exchange(is_listed, true)) return;
        list(in_use);
        continue;
      }
      const auto [weight, index] = candidates_.back();
      candidates_.pop_back();
      Piece& piece = pieces_[index];
      if (!piece.is_resident || index == in_use) continue;
      piece.is_resident = false;
      resident_ -= piece.facts.bytes;
      inflation_ = std::max(inflation_, weight);
    }
  }
  void list(std::uint32_t in_use) {
    for (std::uint32_t i = 0; i < pieces_.size(); ++i)
      if (pieces_[i].is_resident && i != in_use) candidates_.emplace_back(weigh_(i, pieces_[i].facts, change_), i);
    std::ranges::sort(candidates_, std::greater());
  }

  std::uint64_t memory_, resident_ = 0, change_ = 0;
  Weigh weigh_;
  std::vector<Piece> pieces_;
  std::vector<std::pair<double, std::uint32_t>> candidates_;
  double inflation_ = 0;  // of GDSF
  TrialCost cost_;
};

}  // namespace

std::uint64_t AccessLog::largest_bytes() const {
  std::uint64_t largest = 0;
  for (const Access& access : accesses) largest = std::max(largest, access.facts.bytes);
  return largest;
}

std::uint64_t AccessLog::total_bytes() const {
  std::vector<std::uint64_t> bytes(pieces, 0);
  for (const Access& access : accesses) bytes[access.piece] = std::max(bytes[access.piece], access.facts.bytes);
  std::uint64_t sum = 0;
  for (const std::uint64_t piece : bytes) sum += piece;
  return sum;
}

AccessLog parse_access_log(std::string_view text, std::string_view file) {
  if (!text.starts_with(kAccessLogHeader)) throw InputError(file, "", "not an access log of relook");
  AccessLog log;
  std::map<std::pair<std::string_view, std::uint32_t>, std::uint32_t> numbers;
  std::size_t line_number = 1;
  for (text.remove_prefix(kAccessLogHeader.size()); !text.empty();) {
    const std::size_t end = text.find('\n');
    Fields fields(text.substr(0, end), file, ++line_number);
    if (end == std::string_view::npos) fields.refuse("a whole line: the log is cut off");
    text.remove_prefix(end + 1);
    Access access;
    access.change = fields.number<std::uint64_t>("a change");
    if (!log.accesses.empty() && access.change < log.accesses.back().change)
      fields.refuse("changes that do not go back");
    const std::string_view kind = fields.word();
    const auto tile = fields.number<std::uint32_t>("a tile");
    access.facts.bytes = fields.number<std::uint64_t>("bytes");
    if (access.facts.bytes > (std::uint64_t{1} << 40)) fields.refuse("bytes of one tile");
    access.facts.return_seconds = fields.measure("seconds");
    access.facts.surface_area = fields.measure("a surface area");
    fields.end();
    const auto [entry, is_new] = numbers.try_emplace({kind, tile}, log.pieces);
    if (is_new) ++log.pieces;
    access.piece = entry->second;
    log.accesses.push_back(access);
  }
  return log;
}

TrialCost try_policy(const AccessLog& log, EvictionPolicy policy, std::uint64_t memory_bytes) {
  Trial trial(log, memory_bytes, [policy](std::uint32_t, const PieceFacts& facts, std::uint64_t change) {
    return eviction_weight(policy, facts, change);
  });
  for (const Access& access : log.accesses) trial.access(access);
  return trial.cost();
}

TrialCost try_clairvoyant(const AccessLog& log, std::uint64_t memory_bytes) {
  std::vector<std::uint64_t> next_of_access(log.accesses.size()), next(log.pieces, kNever);
  for (std::size_t i = log.accesses.size(); i-- > 0;) next_of_access[i] = std::exchange(next[log.accesses[i].piece], i);
  std::size_t now = 0;
  Trial trial(log, memory_bytes, [&](std::uint32_t piece, const PieceFacts& facts, std::uint64_t) {
    if (next[piece] == kNever) return 0.0;
    return facts.return_seconds / (static_cast<double>(facts.bytes) * static_cast<double>(next[piece] - now));
  });
  next.assign(log.pieces, kNever);
  for (; now < log.accesses.size(); ++now) {
    next[log.accesses[now].piece] = next_of_access[now];
    trial.access(log.accesses[now]);
  }
  return trial.cost();
}

}  // namespace relook
