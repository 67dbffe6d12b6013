#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ImathMatrix.h>
#include <fmt/format.h>

#include "importers/pbrt/scene_objects.h"
#include "importers/pbrt/scene_options.h"
#include "importers/pbrt/spectra.h"
#include "importers/pbrt/syntax.h"
#include "importers/shared/scene_importer.h"

namespace abbe::importers {
namespace pbrt {

using Imath::M44d;

namespace {

const std::vector<std::string> kAttributeTargets{"light", "material", "medium", "shape", "texture"};

std::size_t bytes_of_samples(const TextureValue& value) {
  const auto* spectrum = std::get_if<Spectrum>(&value);
  const auto* samples = spectrum != nullptr ? std::get_if<Samples>(spectrum) : nullptr;
  return samples != nullptr ? (samples->nm.capacity() + samples->values.capacity()) * sizeof(double) : 0;
}

}  // namespace

/// pbrt's graphics state at a position of the file.
struct GraphicsState {
  /// Current transform, for row vectors. It leads from world to camera space before WorldBegin.
  M44d to_world{};
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
  std::map<std::string, M44d> coordinate_systems;
};

/// Executes the directives of a file of pbrt-v4 and fills `SceneImporter::scene`. The importer must outlive
/// it; call `read` once.
class Reader {
 public:
  Reader(const std::filesystem::path& file, SceneImporter& importer)
      : import_{importer, file.parent_path()}, tokens_(file, importer), importer_(importer) {
    graphics_state_.memory = OwnedReservation(importer, 2 * sizeof(GraphicsState));
  }

  /// Reads the file to its end. False after an error, of which the first that makes the syntax ambiguous ends
  /// the reading.
  bool read();

 private:
  // Each handler reads what follows its keyword `word`. False, after an error, if reading cannot continue.
  using Handler = bool (Reader::*)(const Token& word);
  static const std::map<std::string, Handler>& handlers();

  // Appends the quoted names that follow to `to`, up to `max_count` names in all. Reports fewer than
  // `min_count`.
  bool read_names(std::size_t min_count, std::size_t max_count, const Token& word,
                  std::vector<std::string>& to);
  bool read_directive(const Token& word, Directive& to);
  // Reads a quoted name and the parameters, one of which is the type; adds `attributes` as defaults.
  bool read_named_directive(const Token& word, const Parameters& attributes,
                            std::map<std::string, Directive>& to);
  bool require_closed_blocks() const {
    return state_stack_.empty() ||
           importer_.refuse(state_stack_.back().second, "the block that begins here is not closed");
  }
  bool require_outside_object(const Token& word) {
    return !object_ ||
           importer_.refuse(word.where, fmt::format("{} is not allowed inside an object", word.text));
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
  std::map<std::string, M44d> coordinate_systems_{};
  std::vector<SavedState> saved_states_{};               // One per file being imported.
  std::optional<schema::Named<spec::Object>> object_{};  // The object between ObjectBegin and ObjectEnd.
  std::vector<std::string> empty_objects_{};             // Names of objects whose shapes were all dropped.
  SceneOptions options_{};
  std::size_t material_count_ = 0;  // Number of `Material` directives so far.
  bool in_world_ = false;
};

const std::map<std::string, Reader::Handler>& Reader::handlers() {
  static const std::map<std::string, Handler> kHandlers{{"LookAt", &Reader::transform},
                                                        {"Translate", &Reader::transform},
                                                        {"Scale", &Reader::transform},
                                                        {"Rotate", &Reader::transform},
                                                        {"Transform", &Reader::transform},
                                                        {"ConcatTransform", &Reader::transform},
                                                        {"Identity", &Reader::transform},
                                                        {"CoordinateSystem", &Reader::coordinate_system},
                                                        {"CoordSysTransform", &Reader::use_coordinate_system},
                                                        {"ActiveTransform", &Reader::active_transform},
                                                        {"TransformTimes", &Reader::transform_times},
                                                        {"ReverseOrientation", &Reader::reverse_orientation},
                                                        {"AttributeBegin", &Reader::attribute_begin},
                                                        {"AttributeEnd", &Reader::attribute_end},
                                                        {"TransformBegin", &Reader::attribute_begin},
                                                        {"TransformEnd", &Reader::attribute_end},
                                                        {"Attribute", &Reader::attribute},
                                                        {"ObjectBegin", &Reader::object_begin},
                                                        {"ObjectEnd", &Reader::object_end},
                                                        {"ObjectInstance", &Reader::object_instance},
                                                        {"WorldBegin", &Reader::world_begin},
                                                        {"Include", &Reader::include},
                                                        {"Import", &Reader::include},
                                                        {"ColorSpace", &Reader::colour_space},
                                                        {"Option", &Reader::option},
                                                        {"Camera", &Reader::camera},
                                                        {"Film", &Reader::setting},
                                                        {"Sampler", &Reader::setting},
                                                        {"Integrator", &Reader::setting},
                                                        {"PixelFilter", &Reader::setting},
                                                        {"Accelerator", &Reader::setting},
                                                        {"Material", &Reader::material},
                                                        {"MakeNamedMaterial", &Reader::make_named_material},
                                                        {"NamedMaterial", &Reader::named_material},
                                                        {"MakeNamedMedium", &Reader::make_named_medium},
                                                        {"MediumInterface", &Reader::medium_interface},
                                                        {"Texture", &Reader::texture},
                                                        {"LightSource", &Reader::light},
                                                        {"AreaLightSource", &Reader::area_light},
                                                        {"Shape", &Reader::shape}};
  return kHandlers;
}

bool Reader::read() {
  while (const auto word = tokens_.next()) {
    if (word->ends_import()) {
      if (!end_import()) return false;
      continue;
    }
    const auto known = word->quoted ? handlers().end() : handlers().find(word->text);
    if (known == handlers().end()) {
      std::vector<std::string> names;
      for (const auto& [name, handler] : handlers()) names.push_back(name);
      return importer_.refuse(word->where, unknown_name("directive", word->text, names));
    }
    if (!(this->*known->second)(*word)) return false;
  }
  if (tokens_.failed()) return false;
  if (!require_closed_blocks()) return false;
  if (object_) return importer_.refuse(object_->where, "the object that begins here is not closed");
  if (!in_world_) return importer_.refuse(tokens_.end(), "the file ends before WorldBegin");
  return !importer_.diagnostics.has_errors();
}

bool Reader::read_names(std::size_t min_count, std::size_t max_count, const Token& word,
                        std::vector<std::string>& to) {
  while (to.size() < max_count && tokens_.peek() && tokens_.peek()->quoted)
    to.push_back(tokens_.next()->text);
  if (to.size() >= min_count || tokens_.failed()) return !tokens_.failed();
  const auto& next = tokens_.peek();
  return importer_.refuse(next ? next->where : tokens_.end(),
                          fmt::format("expected a quoted name after {} (got {})", word.text,
                                      next ? fmt::format("\"{}\"", next->text) : "the end of the file"));
}

bool Reader::read_directive(const Token& word, Directive& to) {
  std::vector<std::string> type;
  if (!read_names(1, 1, word, type)) return false;
  auto parameters = Parameters::read(tokens_, importer_);
  if (!parameters) return false;
  to = {type[0], *std::move(parameters), word.where};
  return true;
}

bool Reader::read_named_directive(const Token& word, const Parameters& attributes,
                                  std::map<std::string, Directive>& to) {
  Directive directive;
  if (!read_directive(word, directive)) return false;
  directive.parameters.add_defaults(attributes);
  const std::string name = std::exchange(directive.type, directive.parameters.text("type", ""));
  if (directive.type.empty()) importer_.fail(word.where, fmt::format("{} needs \"string type\"", word.text));
  to[name] = std::move(directive);
  return true;
}

bool Reader::transform(const Token& word) {
  M44d moved = graphics_state_.to_world;
  if (!apply_transform(word, tokens_, moved, importer_)) return false;
  if (graphics_state_.active) graphics_state_.to_world = moved;
  return true;
}

bool Reader::coordinate_system(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name)) return false;
  coordinate_systems_[name[0]] = graphics_state_.to_world;
  return true;
}

bool Reader::use_coordinate_system(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name)) return false;
  if (!saved_states_.empty() && !coordinate_systems_.contains(name[0])) {
    importer_.note(word.where, fmt::format("the coordinate system \"{}\" is not defined in the imported "
                                           "file: the directive is ignored, as in pbrt",
                                           name[0]));
    return true;
  }
  if (const M44d* system = find(coordinate_systems_, "coordinate system", name[0], word.where, importer_))
    graphics_state_.to_world = *system;
  return true;
}

bool Reader::active_transform(const Token& word) {
  const auto token = tokens_.next();
  const std::string name = token ? token->text : "";
  if (name != "StartTime" && name != "EndTime" && name != "All")
    return importer_.refuse(token ? token->where : word.where,
                            fmt::format("expected StartTime, EndTime or All (got \"{}\")", name));
  graphics_state_.active = name != "EndTime";
  if (!graphics_state_.active)
    importer_.note(word.where,
                   "animated transforms are not supported: those at the start of the exposure are used");
  return true;
}

bool Reader::transform_times(const Token& word) {
  std::vector<double> n;
  return read_numbers(2, word, tokens_, n, importer_);
}

bool Reader::reverse_orientation(const Token& /*word*/) {
  graphics_state_.reversed = !graphics_state_.reversed;
  return true;
}

bool Reader::attribute_begin(const Token& word) {
  state_stack_.emplace_back(graphics_state_, word.where);
  return true;
}

bool Reader::attribute_end(const Token& word) {
  if (state_stack_.empty())
    return importer_.refuse(word.where, fmt::format("{} without a matching begin directive", word.text));
  graphics_state_ = std::move(state_stack_.back().first);
  state_stack_.pop_back();
  return true;
}

bool Reader::attribute(const Token& word) {
  Directive target;
  if (!read_directive(word, target)) return false;
  if (!importer_.is_known("target of attributes", target.type, kAttributeTargets, word.where)) return false;
  target.parameters.add_defaults(graphics_state_.attributes[target.type]);
  graphics_state_.attributes[target.type] = target.parameters;
  return true;
}

bool Reader::object_begin(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name) || !require_outside_object(word)) return false;
  object_ = {name[0], {}, word.where};
  return attribute_begin(word);
}

bool Reader::object_end(const Token& word) {
  if (!object_ || state_stack_.empty()) return importer_.refuse(word.where, "ObjectEnd without ObjectBegin");
  attribute_end(word);
  // An object whose shapes were all dropped has no instances.
  if (object_->value.shapes.empty())
    empty_objects_.push_back(object_->name);
  else
    importer_.scene.objects.push_back(*std::move(object_));
  object_.reset();
  return true;
}

bool Reader::object_instance(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name) || !require_outside_object(word)) return false;
  if (std::ranges::find(empty_objects_, name[0]) != empty_objects_.end()) return true;
  std::vector<std::string> names;
  for (const auto& object : importer_.scene.objects) names.push_back(object.name);
  if (importer_.is_known("object", name[0], names, word.where))
    append_instance(name[0], graphics_state_.to_world * import_.world_mirror, word.where, importer_);
  return true;
}

bool Reader::world_begin(const Token& word) {
  if (in_world_) return importer_.refuse(word.where, "a second WorldBegin");
  in_world_ = true;
  graphics_state_.active = true;
  apply_options(options_, word.where, import_);
  graphics_state_.to_world = M44d();
  coordinate_systems_["world"] = M44d();
  return true;
}

bool Reader::include(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name)) return false;
  if (name[0].ends_with(".gz"))
    return importer_.refuse(
        word.where, fmt::format("compressed files are not supported: decompress \"{}\" first", name[0]));
  const std::filesystem::path file = import_.folder / name[0];
  if (word.text == "Include") {
    tokens_.include(file, word.where);
    return !tokens_.failed();
  }
  if (!in_world_) return importer_.refuse(word.where, "an Import before WorldBegin");
  saved_states_.push_back(
      {graphics_state_, std::exchange(state_stack_, {}), std::exchange(coordinate_systems_, {})});
  tokens_.import_file(file, word.where);
  return !tokens_.failed();
}

bool Reader::end_import() {
  if (!require_closed_blocks()) return false;
  SavedState& saved = saved_states_.back();
  graphics_state_ = std::move(saved.state);
  state_stack_ = std::move(saved.state_stack);
  coordinate_systems_ = std::move(saved.coordinate_systems);
  saved_states_.pop_back();
  return true;
}

bool Reader::colour_space(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name)) return false;
  if (name[0] != "srgb")
    importer_.note(
        word.where,
        fmt::format("the colour space \"{}\" is not supported: colours are taken as Rec.709", name[0]));
  return true;
}

bool Reader::option(const Token& word) {
  const auto parameters = Parameters::read(tokens_, importer_);
  if (parameters) parameters->note_unused(word.text);
  return parameters.has_value();
}

bool Reader::camera(const Token& word) {
  options_.camera.emplace();
  if (!read_directive(word, *options_.camera)) return false;
  options_.camera_to_world = graphics_state_.to_world.inverse();
  options_.camera_medium = graphics_state_.exterior;
  coordinate_systems_["camera"] = options_.camera_to_world;
  return true;
}

// Stores settings, which are evaluated at WorldBegin. An accelerator does not change the picture.
bool Reader::setting(const Token& word) {
  static const std::map<std::string, std::optional<Directive> SceneOptions::*> kSettings{
      {"Film", &SceneOptions::film},
      {"Integrator", &SceneOptions::integrator},
      {"PixelFilter", &SceneOptions::filter},
      {"Sampler", &SceneOptions::sampler}};
  Directive directive;
  if (!read_directive(word, directive)) return false;
  const auto known = kSettings.find(word.text);
  if (known != kSettings.end()) options_.*known->second = std::move(directive);
  return true;
}

bool Reader::material(const Token& word) {
  graphics_state_.material = {};
  graphics_state_.material.number = ++material_count_;
  if (!read_directive(word, graphics_state_.material.directive)) return false;
  graphics_state_.material.directive.parameters.add_defaults(graphics_state_.attributes["material"]);
  return true;
}

bool Reader::make_named_material(const Token& word) {
  return read_named_directive(word, graphics_state_.attributes["material"], import_.materials);
}

bool Reader::named_material(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name)) return false;
  if (const Directive* known = find(import_.materials, "material", name[0], word.where, importer_))
    graphics_state_.material = {*known, name[0]};
  return true;
}

bool Reader::make_named_medium(const Token& word) {
  return read_named_directive(word, graphics_state_.attributes["medium"], import_.media);
}

bool Reader::medium_interface(const Token& word) {
  std::vector<std::string> names;
  if (!read_names(1, 2, word, names)) return false;
  graphics_state_.interior = names[0];
  graphics_state_.exterior = names.size() > 1 ? names[1] : names[0];
  return true;
}

bool Reader::texture(const Token& word) {
  std::vector<std::string> names;
  if (!read_names(3, 3, word, names)) return false;
  static const std::map<std::string, TextureKind> kKinds{{"float", TextureKind::number},
                                                         {"spectrum", TextureKind::spectrum}};
  const TextureKind* kind = find(kKinds, "type of texture", names[1], word.where, importer_);
  auto parameters = Parameters::read(tokens_, importer_);
  if (kind == nullptr || !parameters) return false;
  parameters->add_defaults(graphics_state_.attributes["texture"]);
  const Directive directive{names[2], *std::move(parameters), word.where};
  TextureValue value = texture_of(directive, *kind, import_);
  importer_.reserve_memory(bytes_of_samples(value));
  import_.textures[*kind][names[0]] = std::move(value);
  directive.parameters.note_unused(fmt::format("texture \"{}\"", directive.type));
  return true;
}

bool Reader::light(const Token& word) {
  Directive directive;
  if (!read_directive(word, directive)) return false;
  directive.parameters.add_defaults(graphics_state_.attributes["light"]);
  add_light(directive, graphics_state_.to_world * import_.world_mirror, import_);
  return true;
}

bool Reader::area_light(const Token& word) {
  if (!read_directive(word, graphics_state_.area_light.emplace())) return false;
  graphics_state_.area_light->parameters.add_defaults(graphics_state_.attributes["light"]);
  return true;
}

bool Reader::shape(const Token& word) {
  Directive directive;
  if (!read_directive(word, directive)) return false;
  if (!in_world_) return importer_.refuse(word.where, "a shape before WorldBegin");
  directive.parameters.add_defaults(graphics_state_.attributes["shape"]);
  const bool bare = graphics_state_.material.directive.type == "interface" ||
                    graphics_state_.material.directive.type.empty();
  if (bare && graphics_state_.interior.empty() && !graphics_state_.area_light)
    return true;  // There is neither a surface nor a medium.
  MaterialUse material = graphics_state_.material;
  if (bare || material.directive.type == "dielectric") material.interior = graphics_state_.interior;
  ImportedShape shape;
  shape.material = materials_.name_of(material);
  shape.reversed = graphics_state_.reversed;
  shape.to_world = object_ ? graphics_state_.to_world : graphics_state_.to_world * import_.world_mirror;
  add_shape(directive, graphics_state_.area_light, std::move(shape),
            object_ ? ShapeOwner::object : ShapeOwner::scene,
            object_ ? object_->value.shapes : importer_.scene.shapes, import_);
  return true;
}

}  // namespace pbrt

bool read_pbrt(const std::filesystem::path& file, SceneImporter& importer) {
  return pbrt::Reader(file, importer).read();
}

}  // namespace abbe::importers
