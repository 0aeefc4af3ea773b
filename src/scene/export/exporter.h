// One export: the document's entities in the order of the source's, then those that edits added; names to indices.
// exporter.cpp drives it and has what stands at the root, exporter_nodes.cpp nodes, scenes, skins and animations,
// exporter_look.cpp materials, textures, images, lights and meshes.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "scene/export/export_gltf.h"
#include "scene/gltf/gltf_write.h"
#include "scene/look/look_schema.h"

namespace relook {

class Exporter {
 public:
  Exporter(const LookDocument& document, const ExportSource* source, std::string folder);
  [[nodiscard]] ExportedScene run();

 private:
  static constexpr std::size_t kNowhere = SIZE_MAX;
  /// An entry of an array of the file.
  struct Slot {
    std::string name;               // in the document; "": not in the active scene
    std::size_t source = kNowhere;  // index in the source
  };
  using Slots = std::vector<Slot>;
  struct Entries {
    Slots slots;
    std::unordered_map<std::string, std::size_t> index;  // by name
    std::vector<std::size_t> moved;                      // by index in the source; kNowhere: removed
  };

  // exporter.cpp
  void take_buffers();
  void place(Section section);
  [[nodiscard]] const Entries& entries(Section section) const { return entries_[static_cast<std::size_t>(section)]; }
  [[nodiscard]] const Json& look(Section section) const { return document_.look[std::string(section_name(section))]; }
  /// The document's entity before any edit, if the source has it.
  [[nodiscard]] const Json* before(Section section, const std::string& name) const;
  [[nodiscard]] std::size_t index_of(Section section, const std::string& name) const;  // kNowhere: none
  [[nodiscard]] std::size_t moved(Section section, const Json& index) const;
  /// An entity's value; names of other entities are still names. `source`: what the file says of it, and null beside a
  /// null `before`.
  [[nodiscard]] Json written(Section section, const std::string& name, const Json* source, const Json* before) const;
  void name_to_index(Section section, Json& value) const;
  void remark(std::string text) { result_.remarks.push_back(std::move(text)); }
  void write_cameras();
  void write_variants();
  void list_extensions();
  void finish();

  // exporter_look.cpp
  void write_images();
  [[nodiscard]] Json image(const std::string& name, const std::shared_ptr<const Bytes>& bytes);
  void write_samplers();
  void write_textures();
  void set_texture_source(const Slot& slot, Json& texture);
  void write_materials();
  void write_meshes();
  [[nodiscard]] Json new_mesh(const std::string& name, const std::string& geometry);
  [[nodiscard]] std::optional<std::size_t> source_of_key(Section section, const std::string& key) const;
  void write_lights();
  [[nodiscard]] Json light(const std::string& name) const;
  [[nodiscard]] const Json* source_light(const std::string& name) const;

  // exporter_nodes.cpp
  void write_skins();
  [[nodiscard]] std::optional<Json> skin(const Slot& slot);
  [[nodiscard]] bool is_above(const std::string& node, const std::string& other) const;
  void write_nodes();
  [[nodiscard]] Json node(const Slot& slot);
  [[nodiscard]] Json idle_node(const Slot& slot) const;
  [[nodiscard]] std::string light_of_idle(const Json& node) const;
  void set_references(const std::string& name, const Json& value, Json& node);
  void set_camera(const std::string& name, const Json& value, Json& node);
  void set_light(const Json& value, Json& node) const;
  void set_instances(const Slot& slot, const Json& value, Json& node);
  void set_weights(const Json& value, Json& node) const;
  void set_rotation(Json& node) const;
  void write_scenes();
  void write_animations();
  [[nodiscard]] bool keeps_target(Json& target) const;
  [[nodiscard]] bool keeps_pointer(Json& target) const;

  const LookDocument& document_;
  const ExportSource* source_;
  std::string folder_;
  ExportedScene result_;
  Json& gltf_ = result_.gltf;
  ColumnWriter columns_{result_.gltf, result_.binary};
  std::array<Entries, kSectionCount> entries_;
  std::map<std::string, std::string> parents_;                                   // node -> its parent
  std::unordered_map<std::string, std::pair<const char*, std::size_t>> lights_;  // name -> extension, index there
  std::map<std::string, Json> geometry_, instances_;                             // written so far, by key
  std::map<const Bytes*, Json> placed_images_;                                   // where the bytes of an image are
  std::vector<std::string> required_;  // extensions that the file cannot do without
};

}  // namespace relook
