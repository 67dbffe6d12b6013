#include "description/doors/mitsuba/xml.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "io/text.h"

namespace abbe::doors::mitsuba {
namespace {

constexpr std::size_t kMaxDepth = 64;  // of elements within one another, included ones too
/// Longest value of an attribute once names are replaced [bytes]; defaults that name others may multiply.
constexpr std::size_t kMaxValueBytes = std::size_t{1} << 20;

// Memory of pugixml's document [bytes]: a copy of the text, 64 for each element or text node and 40 for each
// attribute.
std::size_t document_bytes(const std::string& text) {
  const auto count = [&text](char c) { return static_cast<std::size_t>(std::ranges::count(text, c)); };
  return text.size() + 2 * 64 * count('<') + 40 * count('=');
}

/// Copies the elements of files.
class XmlReader {
 public:
  XmlReader(std::filesystem::path folder, Door& door) : folder_(std::move(folder)), door_(door) {}

  // Adds the elements within the file's root to `to`, which becomes that root.
  bool read(const std::filesystem::path& file, Element& to, std::size_t depth) {
    const auto source = door_.read(file);
    if (!source) return false;
    HeldMemory parsed(door_.inputs, 0);
    parsed.take_more(file.string(), document_bytes(source->text));
    pugi::xml_document document;
    const auto result = document.load_buffer(source->text.data(), source->text.size());
    if (!result)
      return door_.refuse({source, static_cast<std::size_t>(result.offset), ""},
                          fmt::format("no XML: {}", result.description()));
    const pugi::xml_node root = document.document_element();
    if (std::string_view(root.name()) != "scene")
      return door_.refuse(place(root, source), fmt::format("expected <scene> (got <{}>)", root.name()));
    if (to.tag.empty()) {
      to.tag = root.name();
      to.where = place(root, source);
    }
    return add_children(root, source, to, depth);
  }

 private:
  // Counts an element of a list, which has up to twice the room that it needs, and the text that it owns.
  void take_twice(std::size_t element_bytes, std::size_t text_bytes) const {
    door_.take_memory(2 * element_bytes + text_bytes);
  }

  static SourcePosition place(const pugi::xml_node& node, const std::shared_ptr<const SourceText>& source) {
    return {source, static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)), ""};
  }

  bool add_children(const pugi::xml_node& node, const std::shared_ptr<const SourceText>& source, Element& to,
                    std::size_t depth) {
    if (depth > kMaxDepth)
      return door_.refuse(place(node, source),
                          fmt::format("elements or files nested deeper than {}", kMaxDepth));
    for (const pugi::xml_node& child : node) {
      if (child.type() != pugi::node_element) continue;
      take_twice(sizeof(Element), 0);
      Element element{child.name(), {}, {}, place(child, source), ++count_};
      for (const pugi::xml_attribute& attribute : child.attributes()) {
        auto value = replaced(attribute.value(), element.where);
        if (!value) return false;
        take_twice(sizeof element.attributes[0], value->size());
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
      return door_.take_included(element.where) && is_file(file, element.where, door_.diagnostics) &&
             read(file, to, depth + 1);
    }
    if (!add_children(node, source, element, depth + 1)) return false;
    element.last = count_;
    to.children.push_back(std::move(element));
    return true;
  }

  // The value of the longest <default> name that the text begins with, nullptr without one.
  const std::pair<const std::string, std::string>* default_at(std::string_view text) const {
    const std::pair<const std::string, std::string>* best = nullptr;
    for (const auto& entry : defaults_)
      if (!entry.first.empty() && text.starts_with(entry.first) &&
          (best == nullptr || entry.first.size() > best->first.size()))
        best = &entry;
    return best;
  }

  // The text with the values of names behind $.
  std::optional<std::string> replaced(std::string_view text, const SourcePosition& where) {
    std::string value;
    for (std::size_t from = 0; from < text.size();) {
      const std::size_t dollar = std::min(text.find('$', from), text.size());
      value += text.substr(from, dollar - from);
      if (dollar == text.size()) break;
      const auto* named = default_at(text.substr(dollar + 1));
      if (named == nullptr) {
        door_.refuse(where, fmt::format("no <default> gives a value to \"{}\"", text.substr(dollar)));
        return std::nullopt;
      }
      if (value.size() + named->second.size() > kMaxValueBytes) {
        door_.diagnostics.error(
            where,
            fmt::format("a value is longer than {} with those of \"${}\" and others in it",
                        bytes_text(kMaxValueBytes), named->first),
            ErrorCode::resource);
        return std::nullopt;
      }
      value += named->second;
      from = dollar + 1 + named->first.size();
    }
    return value;
  }

  std::filesystem::path folder_;
  Door& door_;
  std::map<std::string, std::string> defaults_{};
  std::size_t count_ = 0;
};

}  // namespace

const std::string& Element::operator[](std::string_view name) const {
  static const std::string kNothing;
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return kNothing;
}

std::optional<Element> read_xml(const std::filesystem::path& file, Door& door) {
  Element root;
  if (!XmlReader(file.parent_path(), door).read(file, root, 0)) return std::nullopt;
  return root;
}

}  // namespace abbe::doors::mitsuba
