#include "importers/pbrt/directives.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importers/pbrt/lights.h"
#include "importers/pbrt/shapes.h"
#include "importers/pbrt/spectra.h"
#include "importers/pbrt/transforms.h"

namespace abbe::importers::pbrt {

using Imath::M44d;

namespace {

const std::vector<std::string> kAttributeTargets{"light", "material", "medium", "shape", "texture"};

std::size_t bytes_of_samples(const TextureValue& value) {
  const auto* spectrum = std::get_if<Spectrum>(&value);
  const auto* samples = spectrum != nullptr ? std::get_if<Samples>(spectrum) : nullptr;
  return samples != nullptr ? (samples->nm.capacity() + samples->values.capacity()) * sizeof(double) : 0;
}

}  // namespace

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
  if (std::ranges::find(kAttributeTargets, target.type) == kAttributeTargets.end())
    return importer_.refuse(word.where, unknown_name("target of attributes", target.type, kAttributeTargets));
  target.parameters.add_defaults(graphics_state_.attributes[target.type]);
  graphics_state_.attributes[target.type] = target.parameters;
  return true;
}

bool Reader::object_begin(const Token& word) {
  std::vector<std::string> name;
  if (!read_names(1, 1, word, name) || !require_outside_object(word)) return false;
  state_stack_.emplace_back(graphics_state_, word.where);
  object_ = {name[0], {}, word.where};
  return true;
}

bool Reader::object_end(const Token& word) {
  if (!object_ || state_stack_.empty()) return importer_.refuse(word.where, "ObjectEnd without ObjectBegin");
  graphics_state_ = std::move(state_stack_.back().first);
  state_stack_.pop_back();
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
  if (std::ranges::find(names, name[0]) == names.end())
    importer_.diagnostics.error(word.where, unknown_name("object", name[0], names));
  else
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
  if (parameters) parameters->note_unused(word.text, importer_);
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
  directive.parameters.note_unused(fmt::format("texture \"{}\"", directive.type), importer_);
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
  ShapeUse use;
  if (!read_directive(word, use.directive)) return false;
  if (!in_world_) return importer_.refuse(word.where, "a shape before WorldBegin");
  use.directive.parameters.add_defaults(graphics_state_.attributes["shape"]);
  const bool bare = graphics_state_.material.directive.type == "interface" ||
                    graphics_state_.material.directive.type.empty();
  if (bare && graphics_state_.interior.empty() && !graphics_state_.area_light)
    return true;  // There is neither a surface nor a medium.
  MaterialUse material = graphics_state_.material;
  if (bare || material.directive.type == "dielectric") material.interior = graphics_state_.interior;
  use.material = materials_.name_of(material);
  use.reversed = graphics_state_.reversed;
  use.emission = graphics_state_.area_light;
  use.to_world = object_ ? graphics_state_.to_world : graphics_state_.to_world * import_.world_mirror;
  add_shape(use, object_ ? ShapeOwner::object : ShapeOwner::scene,
            object_ ? object_->value.shapes : importer_.scene.shapes, import_);
  return true;
}

}  // namespace abbe::importers::pbrt
