#include "description/doors/mitsuba/xml.h"

#include <algorithm>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "io/text.h"

namespace abbe::doors::mitsuba {
namespace {

constexpr std::size_t kMaxDepth = 64;  // of elements within one another, included ones too

/// Copies the elements of files.
class XmlReader {
 public:
  XmlReader(std::filesystem::path folder, Door& door) : folder_(std::move(folder)), door_(door) {}

  // Adds the elements within the file's root to `to`, which becomes that root.
  bool read(const std::filesystem::path& file, Element& to, std::size_t depth) {
    const auto source = read_text(file, door_.diagnostics);
    if (!source) return false;
    if (door_.inputs != nullptr) door_.inputs->add_file(file);
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
      Element element{child.name(), {}, {}, place(child, source), ++count_};
      for (const pugi::xml_attribute& attribute : child.attributes()) {
        auto value = replaced(attribute.value(), element.where);
        if (!value) return false;
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

  // The text with the values of names behind $, the longest name that fits first.
  std::optional<std::string> replaced(std::string text, const SourcePosition& where) {
    for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$', at)) {
      const std::pair<const std::string, std::string>* best = nullptr;
      for (const auto& entry : defaults_)
        if (text.compare(at + 1, entry.first.size(), entry.first) == 0 && !entry.first.empty() &&
            (best == nullptr || entry.first.size() > best->first.size()))
          best = &entry;
      if (best == nullptr) {
        door_.refuse(where, fmt::format("no <default> gives a value to \"{}\"", text.substr(at)));
        return std::nullopt;
      }
      text.replace(at, best->first.size() + 1, best->second);
      at += best->second.size();
    }
    return text;
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
