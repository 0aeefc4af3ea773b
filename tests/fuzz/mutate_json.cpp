#include "mutate_json.h"

#include <array>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "fuzz_targets.h"
#include "libfuzzer_mutate.h"

namespace relook {
namespace {

/// Item i of an object or array.
Json& item(Json& value, std::size_t i) {
  auto at = value.begin();
  std::advance(at, static_cast<std::ptrdiff_t>(i));
  return *at;
}

/// A value somewhere below `root`, and what holds it.
struct Place {
  Json* holder = nullptr;  // null: the root
  std::size_t index = 0;
};

Place choose_place(Json& root, Choices& choices) {
  Place place;
  Json* value = &root;
  while (value->is_structured() && !value->empty() && (place.holder == nullptr || choices.below(5) != 0)) {
    place = {value, choices.below(value->size())};
    value = &item(*value, place.index);
  }
  return place;
}

Json& value_of(Json& root, const Place& place) {
  return place.holder == nullptr ? root : item(*place.holder, place.index);
}

Json number_of(Choices& choices) {
  constexpr std::array<double, 12> kSpecial{0,      1,       -1,    0.5,          1e-45, 1e-30,
                                            3.4e38, -3.4e38, 1e300, 4294967295.0, 1e9,   -0.0};
  switch (choices.below(5)) {
    case 0:
      return kSpecial[choices.below(kSpecial.size())];
    case 1:
      return choices.number(1);
    case 2:
      return static_cast<std::int64_t>(choices.number(8));
    case 3:
      return static_cast<std::int64_t>(choices.number(2)) - 32768;
    default: {
      float value = 0;
      const auto bits = static_cast<std::uint32_t>(choices.number(4));
      std::memcpy(&value, &bits, sizeof value);
      return value - value == 0 ? Json(value) : Json(0.25);
    }
  }
}

Json scalar_of(const Json& old, Choices& choices) {
  constexpr std::array<const char*, 10> kTexts{"",     "-", "0", "/", "~", "Gold", "x.glb", "../x", "\xE2\x80\xAE",
                                               "scene"};
  switch (choices.below(8)) {
    case 0:
      return nullptr;
    case 1:
      return choices.below(2) == 1;
    case 2:
      return kTexts[choices.below(kTexts.size())];
    case 3:
      return Json::object();
    case 4:
      return Json::array();
    case 5:
      return old.is_number() ? Json(old.get<double>() * (choices.below(2) == 0 ? -1 : 2)) : number_of(choices);
    default:
      return number_of(choices);
  }
}

}  // namespace

void mutate_json(Json& root, Choices& choices) {
  const std::size_t kind = choices.below(8);
  const Place place = choose_place(root, choices);
  Json& value = value_of(root, place);
  switch (kind) {
    case 0:
    case 1:
    case 2:
      value = scalar_of(value, choices);
      break;
    case 3:  // what is elsewhere in the document
    case 4: {
      Json other = value_of(root, choose_place(root, choices));
      value = std::move(other);
      break;
    }
    case 5:
      if (place.holder == nullptr) break;
      place.holder->erase(std::next(place.holder->begin(), static_cast<std::ptrdiff_t>(place.index)));
      break;
    case 6: {  // once more
      Json copy = value;
      if (place.holder != nullptr && place.holder->is_array())
        place.holder->push_back(std::move(copy));
      else if (place.holder != nullptr)
        (*place.holder)["added" + std::to_string(choices.below(4))] = std::move(copy);
      break;
    }
    default: {  // under the key of another
      const Place other = choose_place(root, choices);
      if (place.holder == nullptr || !place.holder->is_object() || other.holder == nullptr ||
          !other.holder->is_object())
        break;
      const std::string key = std::next(other.holder->begin(), static_cast<std::ptrdiff_t>(other.index)).key();
      Json copy = value;
      (*place.holder)[key] = std::move(copy);
    }
  }
}

std::size_t mutate_json_text(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  if (seed % 4 == 0) return libfuzzer_mutate(data, size, most);
  Json document = Json::parse(data, data + size, nullptr, false);
  if (document.is_discarded()) return libfuzzer_mutate(data, size, most);
  std::mt19937 random(seed);
  Bytes bytes(256);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 0xFFU);
  Choices choices(bytes);
  for (std::size_t i = choices.below(3) + 1; i > 0; --i) mutate_json(document, choices);
  const std::string text = json_text(document);
  if (text.size() > most) return libfuzzer_mutate(data, size, most);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace relook
