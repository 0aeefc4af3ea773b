#include "edit/draft/placement.h"

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "edit/draft/journal_draft.h"
#include "scene/look/look_bounds.h"
#include "scene/look/look_schema.h"

namespace relook {
namespace {

/// Of the rows of a rotation matrix (row vectors), which are where the axes go.
Quaternion quaternion_of(const WidePoint& x, const WidePoint& y, const WidePoint& z) {
  const double trace = x.x + y.y + z.z;
  Quaternion q;
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    q = {(y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s, s / 4};
  } else if (x.x > y.y && x.x > z.z) {
    const double s = 2 * std::sqrt(1 + x.x - y.y - z.z);
    q = {s / 4, (x.y + y.x) / s, (z.x + x.z) / s, (y.z - z.y) / s};
  } else if (y.y > z.z) {
    const double s = 2 * std::sqrt(1 + y.y - x.x - z.z);
    q = {(x.y + y.x) / s, s / 4, (y.z + z.y) / s, (z.x - x.z) / s};
  } else {
    const double s = 2 * std::sqrt(1 + z.z - x.x - y.y);
    q = {(z.x + x.z) / s, (y.z + z.y) / s, s / 4, (x.y - y.x) / s};
  }
  return q;
}

Quaternion inverse(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }

WidePoint row(const WideTransform& matrix, int i) { return {matrix[i][0], matrix[i][1], matrix[i][2]}; }

WidePoint point_of(const Json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

Quaternion normalized(const Quaternion& q) {
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

/// The matrix of a node that has one, with its axes turned to those of `rotation` and its origin at `origin`.
Json matrix_of(const WideTransform& local, const Quaternion& rotation, const WidePoint& origin) {
  Json matrix = Json::array();
  for (int i = 0; i < 3; ++i) {
    WidePoint axis(0, 0, 0);
    axis[i] = row(local, i).length();
    const WidePoint is = turned(rotation, axis);
    for (const double x : {is.x, is.y, is.z, 0.0}) matrix.push_back(short_real(static_cast<float>(x)));
  }
  for (const double x : {origin.x, origin.y, origin.z, 1.0}) matrix.push_back(short_real(static_cast<float>(x)));
  return matrix;
}

}  // namespace

Quaternion turn(const WidePoint& axis, double degrees) {
  const double half = degrees * std::numbers::pi / 360, sine = std::sin(half);
  return {axis.x * sine, axis.y * sine, axis.z * sine, std::cos(half)};
}

Quaternion then(const Quaternion& a, const Quaternion& b) {
  return {b.w * a.x + b.x * a.w + b.y * a.z - b.z * a.y, b.w * a.y - b.x * a.z + b.y * a.w + b.z * a.x,
          b.w * a.z + b.x * a.y - b.y * a.x + b.z * a.w, b.w * a.w - b.x * a.x - b.y * a.y - b.z * a.z};
}

WidePoint turned(const Quaternion& q, const WidePoint& point) {
  const WidePoint axis(q.x, q.y, q.z), across = axis.cross(point) * 2.0;
  return point + across * q.w + axis.cross(across);
}

Quaternion looking(const WidePoint& along) {
  const WidePoint z = -along;
  WidePoint x = WidePoint(0, 1, 0).cross(z);
  if (x.length() < 1e-9) x = WidePoint(1, 0, 0);
  x.normalize();
  return normalized(quaternion_of(x, z.cross(x), z));
}

Json json_of(const Quaternion& q) {
  Json numbers = Json::array();
  for (const double x : {q.x, q.y, q.z, q.w}) numbers.push_back(short_real(static_cast<float>(x)));
  return numbers;
}

Json json_of(const WidePoint& point) {
  Json numbers = Json::array();
  for (const double x : {point.x, point.y, point.z}) numbers.push_back(short_real(static_cast<float>(x)));
  return numbers;
}

Placement::Placement(const LookDocument& document) : document_(document) {
  const Json& nodes = document.look.at("nodes");
  for (const auto& [name, node] : nodes.items())
    for (const Json& child : node.at("children")) parents_[child.get<std::string>()] = name;
  std::vector<std::string> todo = roots();
  while (!todo.empty()) {
    const std::string name = std::move(todo.back());
    todo.pop_back();
    const std::string above = parent(name);
    const WideTransform own = local_transform(nodes.at(name), document.file, "/nodes/" + escape_token(name));
    worlds_[name] = above.empty() ? own : own * worlds_.at(above);
    for (const Json& child : nodes.at(name).at("children"))
      if (nodes.contains(child.get<std::string>())) todo.push_back(child.get<std::string>());
  }
}

WidePoint Placement::place(const std::string& node) const { return row(world(node), 3); }

std::string Placement::parent(const std::string& node) const {
  const auto found = parents_.find(node);
  return found == parents_.end() ? "" : found->second;
}

std::vector<std::string> Placement::roots() const {
  std::vector<std::string> roots;
  for (const auto& item : document_.look.at("nodes").items())
    if (!parents_.contains(item.key())) roots.push_back(item.key());
  return roots;
}

std::set<std::string> Placement::subtree(const std::string& node) const {
  std::set<std::string> nodes;
  std::vector<std::string> todo{node};
  while (!todo.empty()) {
    const std::string name = std::move(todo.back());
    todo.pop_back();
    if (!document_.look.at("nodes").contains(name) || !nodes.insert(name).second) continue;
    for (const Json& child : document_.look.at("nodes").at(name).at("children"))
      todo.push_back(child.get<std::string>());
  }
  return nodes;
}

WideBox Placement::bounds(const std::string& node) const {
  const std::set<std::string> nodes = subtree(node);
  WideBox bounds;
  for_each_placed_mesh(document_, [&](const std::string& name, const Mesh& mesh, const WideTransform& to_world) {
    if (!nodes.contains(name)) return;
    for (const Point& position : mesh.positions) bounds.extendBy(WidePoint(position) * to_world);
  });
  return bounds;
}

Quaternion Placement::rotation_above(const std::string& node) const {
  constexpr double kRounding = 1e-5;
  const std::string above = parent(node);
  if (above.empty()) return {};
  const WideTransform& matrix = world(above);
  const WidePoint x = row(matrix, 0), y = row(matrix, 1), z = row(matrix, 2);
  const double size = x.length();
  const bool is_even = size > 0 && std::abs(y.length() - size) < kRounding * size &&
                       std::abs(z.length() - size) < kRounding * size && std::abs(x.dot(y)) < kRounding * size * size &&
                       std::abs(x.dot(z)) < kRounding * size * size && std::abs(y.dot(z)) < kRounding * size * size &&
                       x.cross(y).dot(z) > 0;
  if (!is_even)
    throw InputError(
        document_.file, "/nodes/" + escape_token(node),
        "hangs on node \"" + above +
            "\", which is scaled unevenly in the world or mirrored: no rotation of this node turns it there");
  return normalized(quaternion_of(x / size, y / size, z / size));
}

Json Placement::turned_edit(const std::string& node, const Quaternion& rotation, const WidePoint& center) const {
  const Json& entity = document_.look.at("nodes").at(node);
  const WidePoint place = turned(rotation, this->place(node) - center) + center;
  if (!entity.contains("matrix")) {
    const Quaternion above = rotation_above(node);
    const Json& own = entity.at("rotation");
    const Quaternion local =
        normalized({own[0].get<double>(), own[1].get<double>(), own[2].get<double>(), own[3].get<double>()});
    return placed_edit(node, then(then(local, above), rotation), place);
  }
  // Whatever the matrix does, it is followed by the motion, as the parent sees it.
  const Quaternion above = rotation_above(node);
  const Quaternion seen = then(then(above, rotation), inverse(above));
  const WideTransform local = local_transform(entity, document_.file, "/nodes/" + escape_token(node));
  const std::string parent = this->parent(node);
  const WidePoint origin = parent.empty() ? place : place * world(parent).inverse();
  Json matrix = Json::array();
  for (int i = 0; i < 3; ++i) {
    const WidePoint is = turned(seen, row(local, i));
    for (const double x : {is.x, is.y, is.z, 0.0}) matrix.push_back(short_real(static_cast<float>(x)));
  }
  for (const double x : {origin.x, origin.y, origin.z, 1.0}) matrix.push_back(short_real(static_cast<float>(x)));
  return Json::array({replace_operation("/nodes/" + escape_token(node) + "/matrix", std::move(matrix))});
}

Json Placement::placed_edit(const std::string& node, const Quaternion& rotation, const WidePoint& place) const {
  const Json& entity = document_.look.at("nodes").at(node);
  const std::string pointer = "/nodes/" + escape_token(node), parent = this->parent(node);
  const Quaternion local = normalized(then(rotation, inverse(rotation_above(node))));
  const WidePoint origin = parent.empty() ? place : place * world(parent).inverse();
  if (entity.contains("matrix")) {
    const WideTransform now = local_transform(entity, document_.file, pointer);
    return Json::array({replace_operation(pointer + "/matrix", matrix_of(now, local, origin))});
  }
  Json edit = Json::array({replace_operation(pointer + "/rotation", json_of(local))});
  const double moved = (origin - point_of(entity.at("translation"))).length();
  if (moved > 1e-6 * (1 + origin.length()))
    edit.push_back(replace_operation(pointer + "/translation", json_of(origin)));
  return edit;
}

void require_node(const LookDocument& document, const std::string& name) {
  if (!document.look.at("nodes").contains(name))
    throw InputError(document.file, "", missing_name(document, Target::nodes, name));
}

Json replace_operation(const std::string& path, Json value) {
  return {{"op", "replace"}, {"path", path}, {"value", std::move(value)}};
}

}  // namespace relook
