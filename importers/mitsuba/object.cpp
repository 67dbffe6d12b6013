#include "importers/mitsuba/object.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

#include "importers/shared/placement.h"
#include "io/text.h"

namespace abbe::importers::mitsuba {
namespace {

constexpr std::size_t kMaxDepth = 64;  // Includes nesting through included files.
/// Longest attribute value after `$name` is replaced [bytes]. Defaults that contain others can grow
/// exponentially.
constexpr std::size_t kMaxValueBytes = std::size_t{1} << 20;

// Memory of pugixml's document [bytes]: a copy of the text, 64 bytes for each element or text node and 40 for
// each attribute.
std::size_t document_bytes(const std::string& text) {
  const auto count = [&text](char c) { return static_cast<std::size_t>(std::ranges::count(text, c)); };
  return text.size() + 2 * 64 * count('<') + 40 * count('=');
}

/// Reads the elements of a file and of the files it includes.
class XmlReader {
 public:
  XmlReader(std::filesystem::path folder, SceneImporter& importer)
      : folder_(std::move(folder)), importer_(importer) {}

  // Adds the children of the file's root to `to`. If `to` is empty, it becomes that root.
  bool read(const std::filesystem::path& file, Element& to, std::size_t depth) {
    const auto source = importer_.read(file);
    if (!source) return false;
    MemoryReservation parsed(importer_.inputs, 0);
    parsed.reserve(file.string(), document_bytes(source->text));
    pugi::xml_document document;
    const auto result = document.load_buffer(source->text.data(), source->text.size());
    if (!result)
      return importer_.refuse({source, static_cast<std::size_t>(result.offset), ""},
                              fmt::format("malformed XML: {}", result.description()));
    const pugi::xml_node root = document.document_element();
    if (std::string_view(root.name()) != "scene")
      return importer_.refuse(position_of(root, source),
                              fmt::format("expected <scene> (got <{}>)", root.name()));
    if (to.tag.empty()) {
      to.tag = root.name();
      to.where = position_of(root, source);
    }
    return add_children(root, source, to, depth);
  }

 private:
  // Reserves memory for an element of a growing list, whose capacity may be twice its size, and for the text
  // that it owns.
  void reserve_list_element(std::size_t element_bytes, std::size_t text_bytes) const {
    importer_.reserve_memory(2 * element_bytes + text_bytes);
  }

  static SourcePosition position_of(const pugi::xml_node& node,
                                    const std::shared_ptr<const SourceText>& source) {
    return {source, static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)), ""};
  }

  bool add_children(const pugi::xml_node& node, const std::shared_ptr<const SourceText>& source, Element& to,
                    std::size_t depth) {
    if (depth > kMaxDepth)
      return importer_.refuse(position_of(node, source),
                              fmt::format("elements or files are nested deeper than {} levels", kMaxDepth));
    for (const pugi::xml_node& child : node) {
      if (child.type() != pugi::node_element) continue;
      reserve_list_element(sizeof(Element), 0);
      Element element{child.name(), {}, {}, position_of(child, source), ++count_};
      for (const pugi::xml_attribute& attribute : child.attributes()) {
        auto value = expand_defaults(attribute.value(), element.where);
        if (!value) return false;
        reserve_list_element(sizeof element.attributes[0], value->size());
        element.attributes.emplace_back(attribute.name(), *std::move(value));
      }
      if (!add(child, source, std::move(element), to, depth)) return false;
    }
    return true;
  }

  bool add(const pugi::xml_node& node, const std::shared_ptr<const SourceText>& source, Element element,
           Element& to, std::size_t depth) {
    if (element.tag == "default") {
      defaults_.try_emplace(element["name"], element["value"]);
      return true;
    }
    if (element.tag == "include") {
      const auto file = folder_ / element["filename"];
      return importer_.count_include(element.where) && is_file(file, element.where, importer_.diagnostics) &&
             read(file, to, depth + 1);
    }
    if (!add_children(node, source, element, depth + 1)) return false;
    element.last_index = count_;
    to.children.push_back(std::move(element));
    return true;
  }

  // The <default> with the longest name that `text` begins with; nullptr if there is none.
  const std::pair<const std::string, std::string>* default_at(std::string_view text) const {
    const std::pair<const std::string, std::string>* best = nullptr;
    for (const auto& entry : defaults_)
      if (!entry.first.empty() && text.starts_with(entry.first) &&
          (best == nullptr || entry.first.size() > best->first.size()))
        best = &entry;
    return best;
  }

  // The text with each `$name` replaced by the value of its <default>.
  std::optional<std::string> expand_defaults(std::string_view text, const SourcePosition& where) {
    std::string value;
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t dollar = std::min(text.find('$', from), text.size());
      value += text.substr(from, dollar - from);
      if (dollar == text.size()) break;
      const auto* entry = default_at(text.substr(dollar + 1));
      if (entry == nullptr) {
        importer_.refuse(where, fmt::format("no <default> gives a value to \"{}\"", text.substr(dollar)));
        return std::nullopt;
      }
      if (value.size() + entry->second.size() > kMaxValueBytes)
        return importer_.fail(where,
                              fmt::format("a value is longer than {} after replacing \"${}\" and others",
                                          bytes_text(kMaxValueBytes), entry->first),
                              ErrorCode::resource);
      value += entry->second;
      from = dollar + 1 + entry->first.size();
    }
    return value;
  }

  std::filesystem::path folder_;
  SceneImporter& importer_;
  std::map<std::string, std::string> defaults_{};
  std::size_t count_ = 0;
};

using Imath::M44d;
using Imath::V3d;

// The number of an attribute. Reports an absent, empty or malformed one, and returns `fallback`.
double number_attribute(const Element& element, std::string_view name, double fallback,
                        const ImportState& state) {
  const std::string& text = element[name];
  const auto number = parse_number(split(text, '\n').front());
  if (!number)
    state.importer.fail(element.where, fmt::format("expected a number as \"{}\" of <{}> (got \"{}\")", name,
                                                   element.tag, text));
  return number.value_or(fallback);
}

// The camera-to-world matrix of <lookat>, with x to the left, y up and z forward.
std::optional<M44d> look_at(const Element& element, const ImportState& state) {
  const auto three = [&](std::string_view name, const V3d& fallback) {
    const auto numbers = numbers_of(element[name]);
    if (element.has(name) && (!numbers || numbers->size() != 3))
      state.importer.fail(element.where, fmt::format("expected three numbers as \"{}\" of <lookat> (got "
                                                     "\"{}\")",
                                                     name, element[name]));
    return numbers && numbers->size() == 3 ? V3d((*numbers)[0], (*numbers)[1], (*numbers)[2]) : fallback;
  };
  const V3d from = three("origin", {0, 0, 0});
  const V3d target = three("target", {0, 0, 1});
  const auto matrix = looking_at(from, target, three("up", {0, 1, 0}));
  if (!matrix) state.importer.fail(element.where, "the view direction is zero or parallel to up");
  return matrix;
}

std::optional<M44d> matrix(const Element& element, const ImportState& state) {
  auto numbers = numbers_of(element["value"]);
  if (numbers && numbers->size() == 9) {  // A two-dimensional transform, with three rows and columns.
    const std::vector<double>& n = *numbers;
    return from_rows({n[0], n[1], 0, n[2], n[3], n[4], 0, n[5], 0, 0, 1, 0, 0, 0, 0, 1});
  }
  if (numbers && numbers->size() == 16) return from_rows(*numbers);
  return state.importer.fail(element.where, "a matrix takes 9 or 16 numbers");
}

std::optional<M44d> transform_step(const Element& step, const ImportState& state) {
  if (step.tag == "translate") return translation(vector_of(step, {0, 0, 0}, state));
  if (step.tag == "lookat" || step.tag == "look_at") return look_at(step, state);
  if (step.tag == "matrix") return matrix(step, state);
  if (step.tag == "scale") {
    const V3d by = vector_of(step, {1, 1, 1}, state);
    if (by.x * by.y * by.z != 0) return scaling(by);
    return state.importer.fail(step.where, "a scale factor must not be 0");
  }
  if (step.tag == "rotate") {
    const V3d axis = vector_of(step, {0, 0, 0}, state);
    if (axis.length2() > 0) return rotation(axis, number_attribute(step, "angle", 0, state));
    return state.importer.fail(step.where, "the axis of a rotation must not be 0");
  }
  return state.importer.fail(
      step.where, unknown_name("step of a transform", step.tag,
                               std::vector<std::string>{"lookat", "matrix", "rotate", "scale", "translate"}));
}

}  // namespace

const std::string& Element::operator[](std::string_view name) const {
  static const std::string kEmpty;
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return kEmpty;
}

bool Element::has(std::string_view name) const {
  return std::ranges::find(attributes, name, &std::pair<std::string, std::string>::first) != attributes.end();
}

std::optional<Element> read_xml(const std::filesystem::path& file, SceneImporter& importer) {
  Element root;
  if (!XmlReader(file.parent_path(), importer).read(file, root, 0)) return std::nullopt;
  return root;
}

std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::string spaced = text;
  std::ranges::replace_if(
      spaced, [](char c) { return c == ',' || c == '\n' || c == '\t' || c == '\r'; }, ' ');
  std::vector<double> numbers;
  for (const std::string& word : split(spaced, ' ')) {
    if (word.empty()) continue;
    const auto number = parse_number(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

V3d vector_of(const Element& element, const V3d& fallback, const ImportState& state) {
  const auto coordinate = [&](std::string_view name, double otherwise) {
    return element.has(name) ? number_attribute(element, name, otherwise, state) : otherwise;
  };
  if (!element.has("value"))
    return {coordinate("x", fallback.x), coordinate("y", fallback.y), coordinate("z", fallback.z)};
  const std::string& value = element["value"];
  const auto numbers = numbers_of(value);
  if (numbers && numbers->size() == 1) return V3d(numbers->front());
  if (numbers && numbers->size() == 3) return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  state.importer.fail(element.where,
                      fmt::format("expected one number or three of <{}> (got \"{}\")", element.tag, value));
  return fallback;
}

const Element* resolve(const Element& element, const ImportState& state) {
  if (element.tag != "ref") return &element;
  const auto found = state.ids.find(element["id"]);
  if (found != state.ids.end() && found->second->last_index < element.first_index) return found->second;
  std::vector<std::string> names;
  for (const auto& [id, target] : state.ids)
    if (target->last_index < element.first_index) names.push_back(id);
  state.importer.fail(element.where, unknown_name("reference", element["id"], names));
  return nullptr;
}

const Element* Object::find(std::string_view name, std::initializer_list<std::string_view> tags) const {
  for (const Element& child : element_->children) {
    if (child["name"] != name) continue;
    child.used = true;
    const Element* found = resolve(child, *import_);
    if (found == nullptr || std::ranges::find(tags, found->tag) != tags.end()) return found;
    import_->importer.fail(child.where, fmt::format("\"{}\" has a wrong type (got <{}>, allowed {})", name,
                                                    found->tag, fmt::join(tags, ", ")));
    return nullptr;
  }
  return nullptr;
}

bool Object::has(std::string_view name) const {
  return std::ranges::any_of(element_->children, [&](const Element& child) { return child["name"] == name; });
}

const SourcePosition& Object::position_of(std::string_view name) const {
  const auto child = std::ranges::find_if(element_->children,
                                          [&](const Element& property) { return property["name"] == name; });
  return child == element_->children.end() ? where() : child->where;
}

double Object::number(std::string_view name, double fallback) const {
  const Element* found = find(name, {"float", "integer"});
  return found ? number_attribute(*found, "value", fallback, *import_) : fallback;
}

bool Object::boolean(std::string_view name, bool fallback) const {
  const Element* found = find(name, {"boolean"});
  if (found == nullptr) return fallback;
  const std::string& value = (*found)["value"];
  if (value == "true" || value == "false") return value == "true";
  import_->importer.fail(found->where, fmt::format("expected true or false (got \"{}\")", value));
  return fallback;
}

std::string Object::text(std::string_view name, const std::string& fallback) const {
  const Element* found = find(name, {"string"});
  return found ? (*found)["value"] : fallback;
}

V3d Object::point(std::string_view name, const V3d& fallback) const {
  const Element* found = find(name, {"point", "vector"});
  return found ? vector_of(*found, V3d(0), *import_) : fallback;
}

M44d Object::transform(std::string_view name) const {
  M44d all;
  const Element* found = find(name, {"transform"});
  if (found == nullptr) return all;
  for (const Element& step : found->children)
    if (const auto by = transform_step(step, *import_)) all = all * *by;
  if (all.determinant() != 0) return all;
  import_->importer.fail(found->where, "a transform is singular");
  return M44d();
}

std::vector<const Element*> Object::all(std::string_view tag) const {
  std::vector<const Element*> found;
  for (const Element& child : element_->children) {
    if (child.tag != tag && child.tag != "ref") continue;
    const Element* target = resolve(child, *import_);
    const bool matches = target != nullptr && target->tag == tag;
    child.used = child.used || matches || target == nullptr;
    if (matches) found.push_back(target);
  }
  return found;
}

void Object::ignore(std::initializer_list<std::string_view> names) const {
  for (const Element& child : element_->children)
    child.used = child.used || std::ranges::find(names, child["name"]) != names.end();
}

void Object::note_unused() const {
  for (const Element& child : element_->children) {
    if (child.used) continue;
    const std::string name = child["name"].empty() ? fmt::format("<{}>", child.tag) : child["name"];
    import_->importer.note(child.where, fmt::format("\"{}\" of {} \"{}\" is not supported: dropped", name,
                                                    element_->tag, type()));
  }
}

}  // namespace abbe::importers::mitsuba
