// Table 1 of the paper, computed from values: which class a change has, and why.
#include <algorithm>

#include "edit/apply.h"
#include "edit/effect/effect.h"
#include "edit/effect/material_changes.h"

namespace relook {
namespace {

std::string name_of(const Material& material) { return material.name.empty() ? "(default)" : material.name; }

/// Collects classes and sentences.
struct Findings {
  bool color = false, optical = false, geometric = false;
  std::vector<std::string> reasons;

  void add(ChangeClass change, std::string reason) {
    color = color || change == ChangeClass::color;
    optical = optical || change == ChangeClass::optical;
    geometric = geometric || change == ChangeClass::geometric;
    reasons.push_back(std::move(reason));
  }
};

/// Meshes that living objects show with a material: what decides its optics besides its values.
std::vector<MeshId> meshes_with(const Scene& scene, MaterialId material) {
  std::vector<MeshId> meshes;
  for (const Object& object : scene.objects)
    if (object.alive && object.material == material) meshes.push_back(object.mesh);
  std::sort(meshes.begin(), meshes.end());
  meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  return meshes;
}

/// The class of a change of a material on one mesh.
ChangeClass class_of(const Material& before, const Material& after, const Mesh& mesh, Integrator integrator) {
  return class_of(
      effect_of(before, surface_optics(before, mesh), after, surface_optics(after, mesh), mesh, integrator));
}

/// Does a material send rays on alike whatever mesh shows it? Its optics depend on a mesh through its smallest alpha
/// alone, and steadily: if both extremes agree, all meshes do. Where coverage decides per hit, vertex colours do, too.
bool is_alike_on_all(const Material& material, Integrator integrator) {
  if (integrator == Integrator::path && passes_by_coverage(material)) return false;
  Mesh solid, clear;
  clear.min_alpha = 0;
  return surface_optics(material, solid) == surface_optics(material, clear);
}

/// The strongest class over all meshes that show the material.
ChangeClass class_of_material(const Scene& scene, const SceneDelta::MaterialChange& change) {
  const Material& after = scene.material(change.id);
  if (is_alike_on_all(change.before, scene.integrator) && is_alike_on_all(after, scene.integrator))
    return class_of(change.before, after, Mesh(), scene.integrator);
  ChangeClass strongest = ChangeClass::color;
  for (MeshId mesh : meshes_with(scene, change.id))
    strongest = std::max(strongest, class_of(change.before, after, scene.mesh(mesh), scene.integrator));
  return strongest;
}

void classify_material(const Scene& scene, const SceneDelta::MaterialChange& change, Findings& findings) {
  const Material& after = scene.material(change.id);
  findings.add(class_of_material(scene, change),
               "material " + name_of(after) + ": " + describe_material_change(change.before, after));
}

/// The material as it was before the edit.
const Material& material_before(const Scene& scene, const SceneDelta& delta, MaterialId id) {
  for (const SceneDelta::MaterialChange& change : delta.materials)
    if (change.id == id) return change.before;
  return scene.material(id);
}

std::string object_name(const Object& object) {
  std::string name = "node " + object.node;
  if (object.primitive > 0) name += " primitive " + std::to_string(object.primitive);
  if (object.instance > 0) name += " instance " + std::to_string(object.instance);
  return name;
}

std::string describe_deformation(const Object& before, const Object& after) {
  static const Deformation kNone;
  const Deformation& old = before.deformation ? *before.deformation : kNone;
  const Deformation& now = after.deformation ? *after.deformation : kNone;
  return old.joints == now.joints ? "morph weights changed" : "its joints are transformed";
}

/// What a report says of an object that is moved in the sense of ObjectEffect, after its name.
std::string describe_move(const Object& before, const Object& after) {
  if (before.alive != after.alive) return after.alive ? " appears" : " disappears";
  if (before.mesh != after.mesh) return ": another mesh";
  if (before.deformation != after.deformation) return ": " + describe_deformation(before, after);
  if (before.displacement == after.displacement) return " is transformed";
  return !before.displacement  ? ": displacement map added"
         : !after.displacement ? ": displacement map removed"
                               : ": displacement map changed";
}

void classify_object(const Scene& scene, const SceneDelta& delta, const SceneDelta::ObjectChange& change,
                     Findings& findings) {
  const Object& before = change.before;
  const Object& after = scene.object(change.id);
  const std::string name = object_name(after);
  const ObjectEffect effect = effect_of(before, after);
  if (effect.moved) return findings.add(class_of(effect), name + describe_move(before, after));
  const Material& old_material = material_before(scene, delta, before.material);
  const Material& new_material = scene.material(after.material);
  findings.add(class_of(old_material, new_material, scene.mesh(after.mesh), scene.integrator),
               name + ": material " + name_of(old_material) + " -> " + name_of(new_material));
}

std::string light_name(const Light& before, const Light& after) {
  const std::string& light = after.light.empty() ? before.light : after.light;
  if (after.kind == LightKind::suns) return "the suns of the environment";
  if (after.kind == LightKind::emission) return "emission of material " + light;
  return "light " + light + " (node " + after.node + ")";
}

/// What a report says of a light, after its name.
std::string describe_move(const Light& before, const Light& after, const LightEffect& effect) {
  if (effect.exists_otherwise) return after.alive ? " appears" : " disappears";
  if (before.kind != after.kind) return ": another type";
  const bool is_placed_otherwise = before.position != after.position || before.direction != after.direction;
  if (is_placed_otherwise) return " is transformed";
  return ": " + describe_light_change(before, after);
}

void classify_light(const Scene& scene, const SceneDelta::LightChange& change, Findings& findings) {
  const Light& before = change.before;
  const Light& after = scene.light(change.id);
  const LightEffect effect = effect_of(before, after);
  // Of suns and emission, colours are told of the environment and of the material.
  if (!traits_of(after.kind).in_document && class_of(effect) == ChangeClass::color) return;
  findings.add(class_of(effect), light_name(before, after) + describe_move(before, after, effect));
}

}  // namespace

std::string_view change_class_name(ChangeClass change) {
  constexpr std::array<std::string_view, 5> kNames{"base", "color", "optical", "geometric", "mixed"};
  return kNames[static_cast<std::size_t>(change)];
}

ChangeClass combined(ChangeClass a, ChangeClass b) {
  const auto is = [&](ChangeClass kind) { return a == kind || b == kind; };
  if (is(ChangeClass::mixed) || (is(ChangeClass::optical) && is(ChangeClass::geometric))) return ChangeClass::mixed;
  return std::max(a, b);
}

Classification classify(const Scene& after, const SceneDelta& delta) {
  Findings findings;
  for (const SceneDelta::MaterialChange& change : delta.materials) classify_material(after, change, findings);
  for (const SceneDelta::ObjectChange& change : delta.objects) classify_object(after, delta, change, findings);
  for (const SceneDelta::LightChange& change : delta.lights) classify_light(after, change, findings);
  if (delta.ambient_before)
    findings.add(ChangeClass::color, "ambient light: " + describe_values(*delta.ambient_before, after.ambient));
  if (delta.environment_before)
    findings.add(ChangeClass::color,
                 "environment: " + describe_environment_change(*delta.environment_before, after.environment));
  Classification result;
  result.reasons = std::move(findings.reasons);
  if (findings.optical && findings.geometric)
    result.change = ChangeClass::mixed;
  else if (findings.geometric)
    result.change = ChangeClass::geometric;
  else if (findings.optical)
    result.change = ChangeClass::optical;
  return result;
}

}  // namespace relook
