// One pass over the text with the parser's own events: limits and duplicate keys are checked before a value is kept.
#include "base/json.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace relook {
namespace {

constexpr std::size_t kDeepest = 64;
constexpr std::size_t kMostValues = 16'000'000;
constexpr std::size_t kUsualItems = 4;  // of an array: a vector, a colour

/// The parser's message without its prefix and with a bounded quotation of the text.
std::string parse_message(std::string_view message) {
  if (const auto end = message.find("] "); message.starts_with('[') && end != std::string_view::npos)
    message.remove_prefix(end + 2);
  constexpr std::size_t kLongest = 160;
  if (message.size() <= kLongest) return std::string(message);
  return std::string(message.substr(0, kLongest)) + "...";
}

/// Receives the events of nlohmann's iterative parser and builds the document.
class Builder : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(std::string_view file) : file_(file) {}
  [[nodiscard]] Json take() { return std::move(root_); }

  bool null() override { return keep(nullptr); }
  bool boolean(bool value) override { return keep(value); }
  bool number_integer(number_integer_t value) override { return keep(value); }
  bool number_unsigned(number_unsigned_t value) override { return keep(value); }
  bool number_float(number_float_t value, const string_t& text) override {
    if (!std::isfinite(value)) fail("number " + text.substr(0, 40) + " is too large");
    return keep(value);
  }
  bool string(string_t& value) override { return keep(std::move(value)); }
  bool binary(binary_t&) override { fail("binary data"); }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    keys_.back() = std::move(name);
    const auto& members = stack_.back()->get_ref<const Json::object_t&>();
    const bool is_last = members.empty() || members.rbegin()->first < keys_.back();  // as in all that is written sorted
    if (!is_last && members.contains(keys_.back())) fail("this key appears twice");
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    throw InputError(file_, "byte " + std::to_string(position), parse_message(error.what()));
  }

 private:
  bool keep(Json value) {
    place(std::move(value));
    return true;
  }
  bool open(Json container) {
    if (stack_.size() >= kDeepest) fail("nested deeper than " + std::to_string(kDeepest) + " levels");
    stack_.push_back(place(std::move(container)));
    keys_.emplace_back();
    return true;
  }
  bool close() {
    stack_.pop_back();
    keys_.pop_back();
    return true;
  }
  Json* place(Json value) {
    if (++values_ > kMostValues) fail("more than " + std::to_string(kMostValues) + " values");
    if (stack_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *stack_.back();
    if (parent.is_object()) {
      auto& members = parent.get_ref<Json::object_t&>();
      return &members.emplace_hint(members.end(), keys_.back(), std::move(value))->second;
    }
    auto& items = parent.get_ref<Json::array_t&>();
    if (items.empty()) items.reserve(kUsualItems);
    return &items.emplace_back(std::move(value));
  }
  /// Throws InputError with the pointer to the value that is being read.
  [[noreturn]] void fail(std::string_view what) const {
    std::string pointer;
    for (std::size_t i = 0; i < stack_.size(); ++i) {
      const bool open_below = i + 1 < stack_.size();
      const Json& container = *stack_[i];
      pointer += '/';
      if (container.is_object())
        pointer += escape_token(keys_[i]);
      else
        pointer += std::to_string(container.size() - (open_below ? 1 : 0));
    }
    constexpr std::size_t kLongest = 200;
    if (pointer.size() > kLongest) pointer = pointer.substr(0, kLongest) + "...";
    throw InputError(file_, pointer, what);
  }

  std::string_view file_;
  Json root_;
  std::vector<Json*> stack_;       // open containers; a parent does not grow while its child is open
  std::vector<std::string> keys_;  // per open container: key being read
  std::size_t values_ = 0;
};

std::string short_number(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.9g", value);
  return digits;
}

template <class Choices>
std::string suggestion(std::string_view word, const Choices& choices) {
  const std::string nearest = nearest_name(word, choices);
  return nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?";
}

}  // namespace

Json parse_json(std::string_view text, std::string_view file) {
  if (text.empty()) throw InputError(file, "byte 0", "is empty");
  Builder builder(file);
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) throw InputError(file, "", "is not JSON");
  return builder.take();
}

std::string json_text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string escape_token(std::string_view token) {
  std::string escaped;
  escaped.reserve(token.size());
  for (const char c : token) {
    if (c == '~')
      escaped += "~0";
    else if (c == '/')
      escaped += "~1";
    else
      escaped += c;
  }
  return escaped;
}

std::vector<std::string> split_pointer(std::string_view pointer, std::string_view file, std::string_view where) {
  if (!pointer.starts_with('/')) throw InputError(file, where, "a JSON pointer starts with \"/\"");
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~') {
      const char escape = i + 1 < pointer.size() ? pointer[i + 1] : '\0';
      if (escape != '0' && escape != '1') throw InputError(file, where, "\"~\" must be followed by 0 or 1");
      tokens.back() += escape == '0' ? '~' : '/';
      ++i;
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

bool JsonView::has(std::string_view key) const {
  require_object();
  return value_->find(key) != value_->end();
}

JsonView JsonView::at(std::string_view key) const {
  require_object();
  const auto found = value_->find(key);
  if (found == value_->end()) fail("\"" + std::string(key) + "\" is missing");
  return {*found, file_, pointer_ + "/" + escape_token(key)};
}

JsonView JsonView::at(std::size_t index) const {
  require_array();
  if (index >= value_->size())
    fail("has " + std::to_string(value_->size()) + " entries, none at " + std::to_string(index));
  return {(*value_)[index], file_, pointer_ + "/" + std::to_string(index)};
}

std::size_t JsonView::size() const {
  if (!value_->is_structured()) fail("must be an array or an object");
  return value_->size();
}

double JsonView::number(double low, double high) const {
  if (!value_->is_number()) fail("must be a number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("must be a finite number");
  if (number < low || number > high)
    fail(short_number(number) + " is out of range: must be between " + short_number(low) + " and " +
         short_number(high));
  return number;
}

float JsonView::real(float low, float high) const {
  return static_cast<float>(number(static_cast<double>(low), static_cast<double>(high)));
}

std::int64_t JsonView::integer(std::int64_t low, std::int64_t high) const {
  if (!value_->is_number_integer()) fail("must be an integer");
  const bool too_large = value_->is_number_unsigned() && value_->get<std::uint64_t>() > std::uint64_t{INT64_MAX};
  const std::int64_t number = too_large ? INT64_MAX : value_->get<std::int64_t>();
  if (too_large || number < low || number > high) {
    const std::string shown = too_large ? std::to_string(value_->get<std::uint64_t>()) : std::to_string(number);
    fail(shown + " is out of range: must be between " + std::to_string(low) + " and " + std::to_string(high));
  }
  return number;
}

bool JsonView::boolean() const {
  if (!value_->is_boolean()) fail("must be true or false");
  return value_->get<bool>();
}

std::string JsonView::text() const {
  if (!value_->is_string()) fail("must be a string");
  return value_->get<std::string>();
}

void JsonView::reals(std::span<float> out, float low, float high) const {
  require_array();
  if (value_->size() != out.size())
    fail("must have " + std::to_string(out.size()) + " numbers, has " + std::to_string(value_->size()));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = at(i).real(low, high);
}

std::size_t JsonView::one_of(std::span<const std::string_view> choices) const {
  const std::string word = text();
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found == choices.end()) {
    std::string known;
    for (const auto choice : choices) known += (known.empty() ? "\"" : ", \"") + std::string(choice) + "\"";
    fail("\"" + word.substr(0, 80) + "\" is not one of " + known + suggestion(word, choices));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

void JsonView::require_object() const {
  if (!value_->is_object()) fail("must be an object");
}

void JsonView::require_array() const {
  if (!value_->is_array()) fail("must be an array");
}

void JsonView::only_keys(std::span<const std::string_view> known) const {
  require_object();
  for (const auto& [key, value] : value_->items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail("unknown key \"" + key.substr(0, 80) + "\"" + suggestion(key, known));
}

void JsonView::fail(std::string_view what) const { throw InputError(file_, pointer_, what); }

}  // namespace relook
