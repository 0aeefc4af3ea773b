// Strict JSON: what is refused, and that every refusal names its place.
#include "base/json.h"

#include <gtest/gtest.h>

#include <array>

#include "base/error.h"

namespace relook {
namespace {

/// The message of the InputError that `action` throws; "" if it throws none.
template <class Action>
std::string refusal(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return "";
}

std::string parse_refusal(std::string_view text) {
  return refusal([&] { (void)parse_json(text, "f"); });
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + "1" + std::string(depth, ']'); }

TEST(Json, parses_what_it_should) {
  const Json json = parse_json(R"({"a":[1,-2,3.5,true,null,"x\u00e9"],"b":{"a":{}}})", "f");
  EXPECT_EQ(json["a"].size(), 6U);
  EXPECT_EQ(json["a"][1].get<int>(), -2);
  EXPECT_EQ(json["a"][5].get<std::string>(), "x\xC3\xA9");
  EXPECT_TRUE(json["b"]["a"].is_object());
  EXPECT_EQ(parse_json("7", "f").get<int>(), 7);
}

TEST(Json, depth_64_is_read_and_65_is_refused) {
  EXPECT_EQ(parse_refusal(nested(64)), "");
  EXPECT_NE(parse_refusal(nested(65)).find("nested deeper than 64 levels"), std::string::npos);
  EXPECT_NE(parse_refusal(std::string(1'000'000, '[')).find("nested deeper"), std::string::npos);
}

TEST(Json, repeated_keys_are_refused_with_their_pointer) {
  EXPECT_EQ(parse_refusal(R"({"a":{"b":1,"c":2,"b":3}})"), "f: /a/b: this key appears twice");
  EXPECT_EQ(parse_refusal(R"([0,{"x":1,"x":1}])"), "f: /1/x: this key appears twice");
  EXPECT_EQ(parse_refusal(R"([{"x":1},{"x":1}])"), "");
}

TEST(Json, numbers_beyond_double_are_refused) {
  EXPECT_NE(parse_refusal("[1e400]"), "");
  EXPECT_EQ(parse_refusal("[1e308]"), "");
  for (const char* text : {"[NaN]", "[Infinity]", "[-Infinity]", "[01]", "[+1]", "[.5]", "[1.]"})
    EXPECT_NE(parse_refusal(text), "") << text;
}

TEST(Json, every_cut_of_a_text_is_refused) {
  const std::string text = R"({"key":["value",{"n":-1.5e3}],"t":true})";
  for (std::size_t length = 0; length < text.size(); ++length)
    EXPECT_NE(parse_refusal(std::string_view(text).substr(0, length)), "") << length;
  EXPECT_NE(parse_refusal(text + "x"), "");
  EXPECT_NE(parse_refusal(text + "{}"), "");
}

TEST(Json, malformed_text_names_the_byte) {
  EXPECT_EQ(parse_refusal(""), "f: byte 0: is empty");
  EXPECT_TRUE(parse_refusal("{\"a\":}").starts_with("f: byte 6: ")) << parse_refusal("{\"a\":}");
  EXPECT_NE(parse_refusal("\"\xFF\""), "");
  EXPECT_NE(parse_refusal("\"\xED\xA0\x80\""), "") << "a surrogate in UTF-8";
  EXPECT_EQ(parse_refusal("{\"a\": oops\n}").find('\n'), std::string::npos);
}

TEST(JsonPointer, splits_and_escapes) {
  EXPECT_EQ(split_pointer("/a~1b/~0/", "f", ""), (std::vector<std::string>{"a/b", "~", ""}));
  EXPECT_EQ(escape_token("a/b~c"), "a~1b~0c");
  for (const char* pointer : {"", "a", "a/b", "/~", "/~2", "/a~"})
    EXPECT_NE(refusal([&] { (void)split_pointer(pointer, "f", "/steps/0/path"); }), "") << pointer;
}

TEST(JsonView, integers_are_strict) {
  const Json json = parse_json(R"([3, 3.0, -1, 18446744073709551615, "3", 3000000000])", "f");
  const JsonView view(json, "f", "/base");
  EXPECT_EQ(view.at(std::size_t{0}).integer(0, 10), 3);
  EXPECT_EQ(view.at(5).integer(0, INT64_MAX), 3'000'000'000);
  EXPECT_EQ(refusal([&] { (void)view.at(1).integer(0, 10); }), "f: /base/1: must be an integer");
  EXPECT_EQ(refusal([&] { (void)view.at(2).integer(0, 10); }),
            "f: /base/2: -1 is out of range: must be between 0 and 10");
  EXPECT_NE(refusal([&] { (void)view.at(3).integer(0, INT64_MAX); }), "") << "2^64-1 must not wrap";
  EXPECT_NE(refusal([&] { (void)view.at(4).integer(0, 10); }), "");
  EXPECT_NE(refusal([&] { (void)view.at(6); }), "");
}

TEST(JsonView, numbers_stay_in_range) {
  const Json json = parse_json(R"({"v":[1, 2.5, 1e300], "w":[1,2]})", "f");
  const JsonView view(json, "f");
  EXPECT_EQ(view.at("v").at(1).real(0, 3), 2.5F);
  EXPECT_NE(refusal([&] { (void)view.at("v").at(2).real(); }), "") << "1e300 must not become infinite";
  std::array<float, 3> out{};
  EXPECT_EQ(refusal([&] { view.at("w").reals(out); }), "f: /w: must have 3 numbers, has 2");
  EXPECT_TRUE(refusal([&] { view.at("v").reals(out, 0, 2); }).starts_with("f: /v/1: 2.5 is out of range"));
}

TEST(JsonView, types_are_checked) {
  const Json json = parse_json(R"({"t":true,"s":"x","o":{},"a":[]})", "f");
  const JsonView view(json, "f");
  EXPECT_TRUE(view.at("t").boolean());
  EXPECT_EQ(view.at("s").text(), "x");
  EXPECT_EQ(refusal([&] { (void)view.at("s").boolean(); }), "f: /s: must be true or false");
  EXPECT_EQ(refusal([&] { (void)view.at("t").text(); }), "f: /t: must be a string");
  EXPECT_EQ(refusal([&] { (void)view.at("a").has("x"); }), "f: /a: must be an object");
  EXPECT_EQ(refusal([&] { (void)view.at("o").at(std::size_t{0}); }), "f: /o: must be an array");
  EXPECT_EQ(refusal([&] { (void)view.at("missing"); }), "f: \"missing\" is missing");
  EXPECT_NE(refusal([&] { (void)view.at("t").size(); }), "");
}

TEST(JsonView, unknown_words_get_a_suggestion) {
  const Json json = parse_json(R"({"kind":"marbel","sclae":1})", "f");
  const JsonView view(json, "f");
  static constexpr std::array<std::string_view, 2> kKinds = {"marble", "wood"};
  EXPECT_EQ(refusal([&] { (void)view.at("kind").one_of(kKinds); }),
            "f: /kind: \"marbel\" is not one of \"marble\", \"wood\"; did you mean \"marble\"?");
  static constexpr std::array<std::string_view, 2> kKeys = {"kind", "scale"};
  EXPECT_EQ(refusal([&] { view.only_keys(kKeys); }), "f: unknown key \"sclae\"; did you mean \"scale\"?");
}

}  // namespace
}  // namespace relook
