// Where nodes stand and how they are turned, for journals that move them (draft_moves.h, draft_rig.h).
#pragma once
#include <map>
#include <set>
#include <string>

#include "base/json.h"
#include "scene/compile/compile_transform.h"
#include "scene/look/look.h"

namespace relook {

/// A rotation as glTF has it: x, y, z, w.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
/// By `degrees` about a unit axis, counter-clockwise as seen from its tip.
[[nodiscard]] Quaternion turn(const WidePoint& axis, double degrees);
/// `first`, then `second`.
[[nodiscard]] Quaternion then(const Quaternion& first, const Quaternion& second);
[[nodiscard]] WidePoint turned(const Quaternion& rotation, const WidePoint& point);
/// Turns -z to `along` (unit) without a roll: +y stays as far up as it can.
[[nodiscard]] Quaternion looking(const WidePoint& along);
/// Numbers as short as floats can be written.
[[nodiscard]] Json json_of(const Quaternion& rotation);
[[nodiscard]] Json json_of(const WidePoint& point);

/// The nodes of a document in the world.
class Placement {
 public:
  explicit Placement(const LookDocument& document);

  [[nodiscard]] const WideTransform& world(const std::string& node) const { return worlds_.at(node); }
  [[nodiscard]] WidePoint place(const std::string& node) const;
  [[nodiscard]] std::string parent(const std::string& node) const;  // "": a root
  [[nodiscard]] std::vector<std::string> roots() const;
  /// Of all that is visible at and below a node; empty if nothing is.
  [[nodiscard]] WideBox bounds(const std::string& node) const;
  /// A node and all below it.
  [[nodiscard]] std::set<std::string> subtree(const std::string& node) const;

  /// Operations that turn a node as it stands in the world about a point. Throws InputError where that is no rotation
  /// of the node, because one above it is scaled unevenly.
  [[nodiscard]] Json turned_edit(const std::string& node, const Quaternion& rotation, const WidePoint& center) const;
  /// Operations after which a node stands at `place`, turned by `rotation` in the world; its scale stays. As above.
  [[nodiscard]] Json placed_edit(const std::string& node, const Quaternion& rotation, const WidePoint& place) const;

 private:
  /// The rotation in the world of what a node hangs on.
  [[nodiscard]] Quaternion rotation_above(const std::string& node) const;

  const LookDocument& document_;
  std::map<std::string, WideTransform> worlds_;
  std::map<std::string, std::string> parents_;
};

/// A node of the document. Throws InputError with the nearest name.
void require_node(const LookDocument& document, const std::string& name);
[[nodiscard]] Json replace_operation(const std::string& path, Json value);

}  // namespace relook
