#include "description/doors/pbrt/reader.h"

#include <fmt/format.h>

#include "description/doors/pbrt/directives.h"

namespace abbe::doors {
namespace pbrt {

const std::map<std::string, Reader::Directive>& Reader::directives() {
  static const std::map<std::string, Directive> kDirectives{
      {"LookAt", &Reader::transform},
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
  return kDirectives;
}

bool Reader::read() {
  while (const auto word = tokens_.next()) {
    if (word->ends_import()) {
      if (!end_import()) return false;
      continue;
    }
    const auto known = word->quoted ? directives().end() : directives().find(word->text);
    if (known == directives().end()) {
      std::vector<std::string> names;
      for (const auto& [name, directive] : directives()) names.push_back(name);
      return door_.refuse(word->where, unknown_name("directive", word->text, names));
    }
    if (!(this->*known->second)(*word)) return false;
  }
  if (tokens_.failed()) return false;
  if (!blocks_ended()) return false;
  if (object_) return door_.refuse(object_->where, "an object begins here and does not end");
  if (!in_world_) return door_.refuse(tokens_.end(), "the file ends before WorldBegin");
  return !door_.diagnostics.has_errors();
}

bool Reader::texts(std::size_t least, std::size_t most, const Token& word, std::vector<std::string>& to) {
  while (to.size() < most && tokens_.peek() && tokens_.peek()->quoted) to.push_back(tokens_.next()->text);
  if (to.size() >= least || tokens_.failed()) return !tokens_.failed();
  const auto& next = tokens_.peek();
  return door_.refuse(next ? next->where : tokens_.end(),
                      fmt::format("expected a quoted name after {} (got {})", word.text,
                                  next ? fmt::format("\"{}\"", next->text) : "the end of the file"));
}

bool Reader::made(const Token& word, Made& to) {
  std::vector<std::string> type;
  if (!texts(1, 1, word, type)) return false;
  auto parameters = Parameters::read(tokens_, door_);
  if (!parameters) return false;
  to = {type[0], *std::move(parameters), word.where};
  return true;
}

// A thing whose type is among its parameters.
bool Reader::named(const Token& word, const Parameters& attributes, std::map<std::string, Made>& to) {
  Made thing;
  if (!made(word, thing)) return false;
  thing.parameters.complete(attributes);
  const std::string name = std::exchange(thing.type, thing.parameters.text("type", "", door_));
  if (thing.type.empty())
    door_.diagnostics.error(word.where, fmt::format("{} needs \"string type\"", word.text));
  to[name] = std::move(thing);
  return true;
}

}  // namespace pbrt

bool read_pbrt(const std::filesystem::path& file, Door& door) {
  return pbrt::Reader(file, door).read();
}

}  // namespace abbe::doors
