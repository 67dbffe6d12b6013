#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ImathMatrix.h>
#include <fmt/format.h>

#include "description/importers/pbrt/materials.h"
#include "description/importers/pbrt/scene_options.h"

namespace abbe::importers::pbrt {

/// The graphics state at a position of the file.
struct GraphicsState {
  Imath::M44d to_world{};
  bool active = true;  ///< True if transforms apply to the start of the exposure.
  bool reversed = false;
  MaterialUse material{{"diffuse"}};
  std::optional<Directive> area_light{};
  std::string interior{};
  std::string exterior{};
  std::map<std::string, Parameters> attributes{};  // By the target of the `Attribute` directive.
  OwnedReservation memory{};                       ///< Memory of the state; each copy reserves as much.
};

/// The state that an `Import` restores at its end.
struct SavedState {
  GraphicsState state;
  std::vector<std::pair<GraphicsState, SourcePosition>> state_stack;
  std::map<std::string, Imath::M44d> coordinate_systems;
};

/// Executes the directives of a file.
class Reader {
 public:
  Reader(const std::filesystem::path& file, SceneImporter& importer)
      : import_{importer, file.parent_path()}, tokens_(file, importer), importer_(importer) {
    graphics_state_.memory = OwnedReservation(importer, 2 * sizeof(GraphicsState));
  }

  bool read();

 private:
  // Each handler reads what follows its keyword. False if reading cannot continue.
  using Handler = bool (Reader::*)(const Token& word);
  static const std::map<std::string, Handler>& handlers();

  bool read_names(std::size_t min_count, std::size_t max_count, const Token& word,
                  std::vector<std::string>& to);
  bool read_directive(const Token& word, Directive& to);
  bool read_named_directive(const Token& word, const Parameters& attributes,
                            std::map<std::string, Directive>& to);
  bool require_closed_blocks() const {
    return state_stack_.empty() ||
           importer_.refuse(state_stack_.back().second, "the block that begins here is not closed");
  }
  bool require_outside_object(const Token& word) {
    return object_
               ? importer_.refuse(word.where, fmt::format("{} is not allowed inside an object", word.text))
               : true;
  }

  bool transform(const Token& word);
  bool coordinate_system(const Token& word);
  bool use_coordinate_system(const Token& word);
  bool active_transform(const Token& word);
  bool transform_times(const Token& word);
  bool reverse_orientation(const Token& word);
  bool attribute_begin(const Token& word);
  bool attribute_end(const Token& word);
  bool attribute(const Token& word);
  bool object_begin(const Token& word);
  bool object_end(const Token& word);
  bool object_instance(const Token& word);
  bool world_begin(const Token& word);
  bool include(const Token& word);
  bool end_import();
  bool colour_space(const Token& word);
  bool option(const Token& word);
  bool camera(const Token& word);
  bool setting(const Token& word);
  bool material(const Token& word);
  bool make_named_material(const Token& word);
  bool named_material(const Token& word);
  bool make_named_medium(const Token& word);
  bool medium_interface(const Token& word);
  bool texture(const Token& word);
  bool light(const Token& word);
  bool area_light(const Token& word);
  bool shape(const Token& word);

  ImportState import_;
  Tokens tokens_;
  SceneImporter& importer_;
  Materials materials_{import_};
  GraphicsState graphics_state_{};
  std::vector<std::pair<GraphicsState, SourcePosition>> state_stack_{};
  std::map<std::string, Imath::M44d> coordinate_systems_{};
  std::vector<SavedState> saved_states_{};
  std::optional<schema::Named<spec::Object>> object_{};
  std::vector<std::string> empty_objects_{};
  SceneOptions options_{};
  std::size_t material_count_ = 0;
  bool in_world_ = false;
};

}  // namespace abbe::importers::pbrt
