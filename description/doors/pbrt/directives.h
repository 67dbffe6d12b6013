#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ImathMatrix.h>
#include <fmt/format.h>

#include "description/doors/pbrt/film.h"
#include "description/doors/pbrt/materials.h"

namespace abbe::doors::pbrt {

/// What attributes hold at a place of the file.
struct State {
  Imath::M44d to_world{};
  bool active = true;  ///< Transforms change what is at the start of the exposure.
  bool reversed = false;
  MaterialUse material{{"diffuse"}};
  std::optional<Made> area_light{};
  std::string inside{};
  std::string outside{};
  std::map<std::string, Parameters> attributes{};  // by what has them
  OwnedMemory memory{};                            ///< Counts the state itself, each copy again.
};

/// What an imported file leaves as it is, whatever it says.
struct Kept {
  State state;
  std::vector<std::pair<State, SourcePosition>> pushed;
  std::map<std::string, Imath::M44d> systems;
};

/// Follows the directives of a file.
class Reader {
 public:
  Reader(const std::filesystem::path& file, Door& door)
      : world_{door, file.parent_path()}, tokens_(file, door), door_(door) {
    state_.memory = OwnedMemory(door, 2 * sizeof(State));
  }

  bool read();

 private:
  // Each reads what follows its word; false when the file cannot be read on.
  using Directive = bool (Reader::*)(const Token& word);
  static const std::map<std::string, Directive>& directives();

  bool texts(std::size_t least, std::size_t most, const Token& word, std::vector<std::string>& to);
  bool made(const Token& word, Made& to);
  bool named(const Token& word, const Parameters& attributes, std::map<std::string, Made>& to);
  bool blocks_ended() const {
    return pushed_.empty() || door_.refuse(pushed_.back().second, "begins here and does not end");
  }
  bool outside_object(const Token& word) {
    return object_ ? door_.refuse(word.where, fmt::format("{} within an object", word.text)) : true;
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

  World world_;
  Tokens tokens_;
  Door& door_;
  Materials materials_{world_};
  State state_{};
  std::vector<std::pair<State, SourcePosition>> pushed_{};
  std::map<std::string, Imath::M44d> systems_{};
  std::vector<Kept> importing_{};
  std::optional<schema::Named<spec::Object>> object_{};
  std::vector<std::string> empty_objects_{};
  Picture picture_{};
  std::size_t materials_said_ = 0;
  bool in_world_ = false;
};

}  // namespace abbe::doors::pbrt
