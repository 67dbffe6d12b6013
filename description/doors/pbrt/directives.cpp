#include "description/doors/pbrt/directives.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/doors/pbrt/lights.h"
#include "description/doors/pbrt/shapes.h"
#include "description/doors/pbrt/spectra.h"
#include "description/doors/pbrt/transforms.h"

namespace abbe::doors::pbrt {

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
  M44d moved = state_.to_world;
  if (!apply_transform(word, tokens_, moved, door_)) return false;
  if (state_.active) state_.to_world = moved;
  return true;
}

bool Reader::coordinate_system(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name)) return false;
  systems_[name[0]] = state_.to_world;
  return true;
}

bool Reader::use_coordinate_system(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name)) return false;
  if (!importing_.empty() && !systems_.contains(name[0])) {
    door_.note(word.where,
               fmt::format("an imported file does not know the coordinate system \"{}\" of what is "
                           "around it: its transform stays as it is, as there",
                           name[0]));
    return true;
  }
  if (const M44d* system = find(systems_, "coordinate system", name[0], word.where, door_))
    state_.to_world = *system;
  return true;
}

bool Reader::active_transform(const Token& word) {
  const auto token = tokens_.next();
  const std::string name = token ? token->text : "";
  if (name != "StartTime" && name != "EndTime" && name != "All")
    return door_.refuse(token ? token->where : word.where,
                        fmt::format("expected StartTime, EndTime or All (got \"{}\")", name));
  state_.active = name != "EndTime";
  if (!state_.active)
    door_.note(word.where, "nothing moves during an exposure here: all stands as at its start");
  return true;
}

bool Reader::transform_times(const Token& word) {
  std::vector<double> n;
  return read_numbers(2, word, tokens_, n, door_);
}

bool Reader::reverse_orientation(const Token& /*word*/) {
  state_.reversed = !state_.reversed;
  return true;
}

bool Reader::attribute_begin(const Token& word) {
  pushed_.emplace_back(state_, word.where);
  return true;
}

bool Reader::attribute_end(const Token& word) {
  if (pushed_.empty()) return door_.refuse(word.where, fmt::format("{} without its beginning", word.text));
  state_ = std::move(pushed_.back().first);
  pushed_.pop_back();
  return true;
}

bool Reader::attribute(const Token& word) {
  Made of;
  if (!made(word, of)) return false;
  if (std::ranges::find(kAttributeTargets, of.type) == kAttributeTargets.end())
    return door_.refuse(word.where, unknown_name("target of attributes", of.type, kAttributeTargets));
  of.parameters.complete(state_.attributes[of.type]);
  state_.attributes[of.type] = of.parameters;
  return true;
}

bool Reader::object_begin(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name) || !outside_object(word)) return false;
  pushed_.emplace_back(state_, word.where);
  object_ = {name[0], {}, word.where};
  return true;
}

bool Reader::object_end(const Token& word) {
  if (!object_ || pushed_.empty()) return door_.refuse(word.where, "ObjectEnd without its beginning");
  state_ = std::move(pushed_.back().first);
  pushed_.pop_back();
  // One of nothing but what was dropped has no instances either.
  if (object_->value.shapes.empty())
    empty_objects_.push_back(object_->name);
  else
    door_.scene.objects.push_back(*std::move(object_));
  object_.reset();
  return true;
}

bool Reader::object_instance(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name) || !outside_object(word)) return false;
  if (std::ranges::find(empty_objects_, name[0]) != empty_objects_.end()) return true;
  std::vector<std::string> names;
  for (const auto& object : door_.scene.objects) names.push_back(object.name);
  if (std::ranges::find(names, name[0]) == names.end())
    door_.diagnostics.error(word.where, unknown_name("object", name[0], names));
  else
    place_instance(name[0], state_.to_world * world_.upright, word.where, door_);
  return true;
}

bool Reader::world_begin(const Token& word) {
  if (in_world_) return door_.refuse(word.where, "a second WorldBegin");
  in_world_ = true;
  state_.active = true;
  set_picture(picture_, word.where, world_);
  state_.to_world = M44d();
  systems_["world"] = M44d();
  return true;
}

bool Reader::include(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name)) return false;
  if (name[0].ends_with(".gz"))
    return door_.refuse(word.where, fmt::format("\"{}\" is packed: unpack it first", name[0]));
  const std::filesystem::path file = world_.folder / name[0];
  if (word.text == "Include") {
    tokens_.include(file, word.where);
    return !tokens_.failed();
  }
  if (!in_world_) return door_.refuse(word.where, "an Import before WorldBegin");
  importing_.push_back({state_, std::exchange(pushed_, {}), std::exchange(systems_, {})});
  tokens_.import_file(file, word.where);
  return !tokens_.failed();
}

bool Reader::end_import() {
  if (!blocks_ended()) return false;
  Kept& kept = importing_.back();
  state_ = std::move(kept.state);
  pushed_ = std::move(kept.pushed);
  systems_ = std::move(kept.systems);
  importing_.pop_back();
  return true;
}

bool Reader::colour_space(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name)) return false;
  if (name[0] != "srgb")
    door_.note(word.where, fmt::format("colours of the space \"{}\" are taken for Rec.709", name[0]));
  return true;
}

bool Reader::option(const Token& word) {
  const auto parameters = Parameters::read(tokens_, door_);
  if (parameters) parameters->note_unused(word.text, door_);
  return parameters.has_value();
}

bool Reader::camera(const Token& word) {
  picture_.camera.emplace();
  if (!made(word, *picture_.camera)) return false;
  picture_.camera_to_world = state_.to_world.inverse();
  picture_.camera_medium = state_.outside;
  systems_["camera"] = picture_.camera_to_world;
  return true;
}

// Those that are read now and looked at when the world begins; an accelerator changes no picture.
bool Reader::setting(const Token& word) {
  static const std::map<std::string, std::optional<Made> Picture::*> kSettings{
      {"Film", &Picture::film},
      {"Integrator", &Picture::integrator},
      {"PixelFilter", &Picture::filter},
      {"Sampler", &Picture::sampler}};
  Made said;
  if (!made(word, said)) return false;
  const auto known = kSettings.find(word.text);
  if (known != kSettings.end()) picture_.*known->second = std::move(said);
  return true;
}

bool Reader::material(const Token& word) {
  state_.material = {};
  state_.material.number = ++materials_said_;
  if (!made(word, state_.material.made)) return false;
  state_.material.made.parameters.complete(state_.attributes["material"]);
  return true;
}

bool Reader::make_named_material(const Token& word) {
  return named(word, state_.attributes["material"], world_.materials);
}

bool Reader::named_material(const Token& word) {
  std::vector<std::string> name;
  if (!texts(1, 1, word, name)) return false;
  if (const Made* known = find(world_.materials, "material", name[0], word.where, door_))
    state_.material = {*known, name[0]};
  return true;
}

bool Reader::make_named_medium(const Token& word) {
  return named(word, state_.attributes["medium"], world_.media);
}

bool Reader::medium_interface(const Token& word) {
  std::vector<std::string> names;
  if (!texts(1, 2, word, names)) return false;
  state_.inside = names[0];
  state_.outside = names.size() > 1 ? names[1] : names[0];
  return true;
}

bool Reader::texture(const Token& word) {
  std::vector<std::string> names;
  if (!texts(3, 3, word, names)) return false;
  static const std::map<std::string, TextureKind> kKinds{{"float", TextureKind::number},
                                                         {"spectrum", TextureKind::spectrum}};
  const TextureKind* kind = find(kKinds, "type of texture", names[1], word.where, door_);
  auto parameters = Parameters::read(tokens_, door_);
  if (kind == nullptr || !parameters) return false;
  parameters->complete(state_.attributes["texture"]);
  const Made thing{names[2], *std::move(parameters), word.where};
  TextureValue value = texture_of(thing, *kind, world_);
  door_.take_memory(bytes_of_samples(value));
  world_.textures[*kind][names[0]] = std::move(value);
  thing.parameters.note_unused(fmt::format("texture \"{}\"", thing.type), door_);
  return true;
}

bool Reader::light(const Token& word) {
  Made thing;
  if (!made(word, thing)) return false;
  thing.parameters.complete(state_.attributes["light"]);
  add_light(thing, state_.to_world * world_.upright, world_);
  return true;
}

bool Reader::area_light(const Token& word) {
  if (!made(word, state_.area_light.emplace())) return false;
  state_.area_light->parameters.complete(state_.attributes["light"]);
  return true;
}

bool Reader::shape(const Token& word) {
  ShapeUse use;
  if (!made(word, use.made)) return false;
  if (!in_world_) return door_.refuse(word.where, "a shape before WorldBegin");
  use.made.parameters.complete(state_.attributes["shape"]);
  const bool bare = state_.material.made.type == "interface" || state_.material.made.type.empty();
  if (bare && state_.inside.empty() && !state_.area_light) return true;  // neither matter nor surface
  MaterialUse material = state_.material;
  if (bare || material.made.type == "dielectric") material.inside = state_.inside;
  use.material = materials_.name_of(material);
  use.reversed = state_.reversed;
  use.emission = state_.area_light;
  use.to_world = object_ ? state_.to_world : state_.to_world * world_.upright;
  add_shape(use, object_ ? Among::object : Among::scene, object_ ? object_->value.shapes : door_.scene.shapes,
            world_);
  return true;
}

}  // namespace abbe::doors::pbrt
