#include "importers/mitsuba/xml.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

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
      if (value.size() + entry->second.size() > kMaxValueBytes) {
        importer_.diagnostics.error(
            where,
            fmt::format("a value is longer than {} after replacing \"${}\" and others",
                        bytes_text(kMaxValueBytes), entry->first),
            ErrorCode::resource);
        return std::nullopt;
      }
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

}  // namespace

const std::string& Element::operator[](std::string_view name) const {
  static const std::string kEmpty;
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return kEmpty;
}

std::optional<Element> read_xml(const std::filesystem::path& file, SceneImporter& importer) {
  Element root;
  if (!XmlReader(file.parent_path(), importer).read(file, root, 0)) return std::nullopt;
  return root;
}

}  // namespace abbe::importers::mitsuba
