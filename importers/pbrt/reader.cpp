#include "importers/pbrt/reader.h"

#include <fmt/format.h>

#include "importers/pbrt/directives.h"

namespace abbe::importers {
namespace pbrt {

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

// Reads a directive whose type is one of its parameters.
bool Reader::read_named_directive(const Token& word, const Parameters& attributes,
                                  std::map<std::string, Directive>& to) {
  Directive directive;
  if (!read_directive(word, directive)) return false;
  directive.parameters.add_defaults(attributes);
  const std::string name = std::exchange(directive.type, directive.parameters.text("type", "", importer_));
  if (directive.type.empty())
    importer_.diagnostics.error(word.where, fmt::format("{} needs \"string type\"", word.text));
  to[name] = std::move(directive);
  return true;
}

}  // namespace pbrt

bool read_pbrt(const std::filesystem::path& file, SceneImporter& importer) {
  return pbrt::Reader(file, importer).read();
}

}  // namespace abbe::importers
