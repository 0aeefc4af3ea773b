// Rays against triangles. The only interface to Embree: one bottom level per mesh (two where some of its objects report
// each hit of a shadow segment and others end it), one instance per object, top levels for the whole scene and for
// selections over the same bottom levels. After edits a top level is stacked: its base without what changed since, and
// a small overlay. Results depend on the ray and the objects alone: never on build order, stacking, thread count, or on
// what else is in the top level. Coincident hits are ordered by (t, object key, primitive).
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "trace/ray_scene.h"
#include "trace/tree/ray_tree.h"

namespace relook {

/// The nearest hit of a ray. `object` none: nothing was met.
struct Meeting {
  ObjectId object = ObjectId::none();
  Hit hit;
  float t = std::numeric_limits<float>::infinity();
  std::uint64_t key = 0;
  [[nodiscard]] bool nearer_than(const Meeting& other) const {
    if (t != other.t) return t < other.t;
    if (key != other.key) return key < other.key;
    return hit.primitive < other.hit.primitive;
  }
};

struct Ray {
  Point origin;
  Direction direction;  // any length; t counts in its lengths
  float t_max = std::numeric_limits<float>::infinity();
  float t_min = 0;
  Meeting behind{};  // object not none: a hit of this ray; only what comes after it is met
  bool from_light = true;  // of a segment: single-sided surfaces are met where they face the light, else the segment
};

/// A surface that a shadow segment crosses.
struct Crossing {
  ObjectId object;
  Hit hit;
  float t = 0;
  std::uint64_t key = 0;
  bool operator==(const Crossing&) const = default;
};

/// What crossings of one segment are ordered by.
[[nodiscard]] inline std::tuple<float, std::uint64_t, std::uint32_t> place_on_segment(const Crossing& crossing) {
  return {crossing.t, crossing.key, crossing.hit.primitive};
}

/// Told how many bytes acceleration structures are about to take; negative: have given back. Called from any thread.
/// What it throws about bytes to be taken ends the building, which throws it in turn.
using MemoryMonitor = std::function<void(std::int64_t bytes)>;

class Tracer {
 public:
  /// A set of objects that rays can be shot at.
  class TopLevel {
   public:
    TopLevel();
    ~TopLevel();
    TopLevel(TopLevel&&) noexcept;
    TopLevel& operator=(TopLevel&&) noexcept;
    [[nodiscard]] bool empty() const;

   private:
    friend class Tracer;
    struct Impl;
    std::unique_ptr<Impl> impl_;
  };
  struct Placed {
    ObjectId id;
    const RayObject* object;  // outlives the top level
  };

  /// `count_blockers`: its top levels may be asked for blockers(); passes() is slower then.
  explicit Tracer(bool count_blockers = false, MemoryMonitor monitor = {});
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  /// Objects that are not alive are left out. A change of an object's geometry or of what its optics let through needs
  /// a new top level, or replace(). Bottom levels are made once per mesh and kept until drop_unused(). Where
  /// memory is short, throws std::bad_alloc, ResourceError, or what the monitor throws; nothing half built is kept.
  [[nodiscard]] TopLevel build(std::span<const Placed> objects);
  [[nodiscard]] TopLevel build(const RayScene& scene);

  /// Drops the bottom levels of meshes that no object uses any more: once an edit, since all of them are looked at.
  void drop_unused();

  /// Makes `level` stand for its base, the objects it was built over, without `hidden`, plus `added`: only the small
  /// top level over `added` is built. Not cumulative: each call replaces what earlier calls hid and added. Results
  /// equal those of a top level built afresh, bit for bit. Requires: every object of the base that is not as it was
  /// when the base was built is hidden; `level` is of this tracer. Ids in `hidden` that the base lacks are ignored.
  void replace(TopLevel& level, std::span<const ObjectId> hidden, std::span<const Placed> added);

  /// Rays with a component that is not finite, or larger than 1e18, meet nothing.
  [[nodiscard]] static Meeting intersect(const TopLevel& level, const Ray& ray);

  /// Where a ray meets a triangle that it is known to meet: the t of intersect(), bit for bit. `level`: over the
  /// triangle's object alone. Infinity if it does not meet it.
  [[nodiscard]] static float distance(const TopLevel& level, const Ray& ray, std::uint32_t primitive);

  /// Segments run from a point to a light, against the light's own way: single-sided surfaces are met where they face
  /// the light, or, towards the sample of a light that rays meet as well, where such a ray meets them. False if an opaque object blocks the segment; otherwise true, and `crossings` holds the transparent
  /// surfaces in order. `crossings` is cleared first.
  [[nodiscard]] static bool passes(const TopLevel& level, const Ray& ray, std::vector<Crossing>& crossings);

  /// All surfaces that the segment crosses, opaque ones too, in order. `crossings` is cleared first. Requires: a level
  /// of a tracer made with `count_blockers`.
  static void blockers(const TopLevel& level, const Ray& ray, std::vector<Crossing>& crossings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace relook
