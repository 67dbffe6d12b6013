#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ImathMatrix.h>
#include <fmt/format.h>

#include "importers/pbrt/materials.h"
#include "importers/pbrt/scene_options.h"

namespace abbe::importers::pbrt {

/// pbrt's graphics state at a position of the file.
struct GraphicsState {
  /// Current transform, for row vectors. It leads from world to camera space before WorldBegin.
  Imath::M44d to_world{};
  bool active = true;     ///< True if transforms apply to the start of the exposure.
  bool reversed = false;  ///< True after an odd number of ReverseOrientation.
  MaterialUse material{{"diffuse"}};
  std::optional<Directive> area_light{};           ///< Area light of the following shapes, if any.
  std::string interior{};                          ///< Name of the medium inside shapes; empty if none.
  std::string exterior{};                          ///< Name of the medium around shapes; empty if none.
  std::map<std::string, Parameters> attributes{};  ///< Defaults by the target of the `Attribute` directive.
  OwnedReservation memory{};                       ///< Memory of the state; each copy reserves as much.
};

/// The state that the end of an imported file restores.
struct SavedState {
  GraphicsState state;
  std::vector<std::pair<GraphicsState, SourcePosition>> state_stack;
  std::map<std::string, Imath::M44d> coordinate_systems;
};

/// Executes the directives of a file of pbrt-v4 and fills `SceneImporter::scene`. Errors go to the importer's
/// diagnostics. The importer must outlive it; call `read` once.
class Reader {
 public:
  Reader(const std::filesystem::path& file, SceneImporter& importer)
      : import_{importer, file.parent_path()}, tokens_(file, importer), importer_(importer) {
    graphics_state_.memory = OwnedReservation(importer, 2 * sizeof(GraphicsState));
  }

  /// Reads the file to its end. False after an error, of which the first that makes the syntax ambiguous ends
  /// the reading. Throws Error{resource} if the memory limit of the importer's inputs is exceeded.
  bool read();

 private:
  // Each handler reads what follows its keyword `word`. False, after an error, if reading cannot continue.
  using Handler = bool (Reader::*)(const Token& word);
  static const std::map<std::string, Handler>& handlers();

  // Appends the quoted names that follow to `to`, up to `max_count` names in all. Reports fewer than
  // `min_count`.
  bool read_names(std::size_t min_count, std::size_t max_count, const Token& word,
                  std::vector<std::string>& to);
  // Reads a quoted type and the parameters.
  bool read_directive(const Token& word, Directive& to);
  // Reads a quoted name and the parameters, one of which is the type; adds `attributes` as defaults.
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
  std::vector<std::pair<GraphicsState, SourcePosition>> state_stack_{};  // Open blocks and their positions.
  std::map<std::string, Imath::M44d> coordinate_systems_{};
  std::vector<SavedState> saved_states_{};               // One per file being imported.
  std::optional<schema::Named<spec::Object>> object_{};  // The object between ObjectBegin and ObjectEnd.
  std::vector<std::string> empty_objects_{};             // Names of objects whose shapes were all dropped.
  SceneOptions options_{};
  std::size_t material_count_ = 0;  // Number of `Material` directives so far.
  bool in_world_ = false;
};

}  // namespace abbe::importers::pbrt
