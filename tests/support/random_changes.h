// Edits at random, from a seed, on the scenes of the tests.
#pragma once
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "edit/journal.h"
#include "replay/replay.h"
#include "test_scenes.h"

namespace relook {

/// RELOOK_SEED, or a fixed number.
[[nodiscard]] std::uint64_t seed_of_run();

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : next_([engine = std::mt19937_64(seed)]() mutable { return engine(); }) {}
  /// Throws are whatever `next` gives.
  explicit Dice(std::function<std::uint64_t()> next) : next_(std::move(next)) {}
  /// [0, count)
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(next_() % count); }
  bool chance(double share) { return between(0, 1) < share; }
  /// On a grid of 1/64, so that JSON and float agree.
  double between(double low, double high) {
    const double t = static_cast<double>(below(65)) / 64;
    return low + (high - low) * t;
  }
  template <class T>
  const T& one_of(const std::vector<T>& choices) {
    return choices[below(choices.size())];
  }
  Json color() { return {between(0, 1), between(0, 1), between(0, 1)}; }

 private:
  std::function<std::uint64_t()> next_;
};

/// One to three edits of weights and joints of puppet_scene().
[[nodiscard]] Json random_deformation(Dice& dice);

/// An edit and what undoes it.
struct Change {
  std::vector<Json> forward, backward;  // operations, in order

  /// Sets a member that may or may not exist.
  void set(const Json& look, const std::string& pointer, Json value) {
    const Json::json_pointer at(pointer);
    if (look.contains(at))
      undo_first({{"op", "add"}, {"path", pointer}, {"value", look.at(at)}});
    else
      undo_first({{"op", "remove"}, {"path", pointer}});
    forward.push_back({{"op", "add"}, {"path", pointer}, {"value", std::move(value)}});
  }
  void remove(const Json& look, const std::string& pointer) {
    undo_first({{"op", "add"}, {"path", pointer}, {"value", look.at(Json::json_pointer(pointer))}});
    forward.push_back({{"op", "remove"}, {"path", pointer}});
  }

 private:
  void undo_first(Json operation) { backward.insert(backward.begin(), std::move(operation)); }
};

/// One to three changes of any kind in one edit; no two of the same place.
[[nodiscard]] Change random_change(const Json& look, Dice& dice);
[[nodiscard]] Edit edit_of_list(const std::vector<Json>& operations);
/// One frame of a drag: something that a node's selection can do.
[[nodiscard]] Change random_movement(const Json& look, const std::string& node, Dice& dice);
/// A scene whose image is small.
[[nodiscard]] SceneState small_scene(TestScene scene, const ViewOptions& view);
/// A replay of it.
[[nodiscard]] Replayer replayer_of(TestScene scene, ViewOptions view, const RegionOptions& regions,
                                   const ResidencyOptions& residency = {});

}  // namespace relook
