#include "io/json.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <sstream>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {
namespace {

/// Thrown to end the parsing of a rejected document.
struct Refused {};

/// Builds the tree from the parser's events.
class YamlTreeBuilder : public YAML::EventHandler {
 public:
  YamlTreeBuilder(ValueTree& tree, std::size_t first) : tree_(tree), first_(first) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) refuse(mark, "expected the end of the text (got another document)");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    begin_value(mark, anchor);
    check(tree_.add(nullptr, offset(mark)));
    key_next_ = true;
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { refuse(mark, kNoAnchors); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& value) override {
    if (expects_key()) {
      refuse_anchor(mark, anchor);
      tree_.key(value, offset(mark));
      key_next_ = false;
      return;
    }
    begin_value(mark, anchor);
    check(tree_.add(value, offset(mark)));
    key_next_ = true;
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    begin_value(mark, anchor);
    check(tree_.open(JsonValue::Array{}, offset(mark)));
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    begin_value(mark, anchor);
    check(tree_.open(JsonValue::Object{}, offset(mark)));
    key_next_ = true;
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

  [[nodiscard]] std::size_t offset(const YAML::Mark& mark) const {
    return mark.is_null() ? SourcePosition::kWholeFile : first_ + static_cast<std::size_t>(mark.pos);
  }
  [[nodiscard]] int documents() const { return documents_; }

 private:
  static constexpr const char* kNoAnchors = "anchors and aliases are not read; write the value out";

  [[nodiscard]] bool expects_key() const {
    const JsonValue* parent = tree_.innermost();
    return parent != nullptr && std::holds_alternative<JsonValue::Object>(parent->value) && key_next_;
  }

  void begin_value(const YAML::Mark& mark, YAML::anchor_t anchor) {
    refuse_anchor(mark, anchor);
    if (expects_key()) refuse(mark, "expected a word as a key");
    if (++values_ > kMaxYamlValues) refuse(mark, fmt::format("too many values (allowed {})", kMaxYamlValues));
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) refuse(mark, kNoAnchors);
  }

  [[noreturn]] void refuse(const YAML::Mark& mark, std::string message) {
    tree_.refuse(offset(mark), std::move(message), tree_.pointer());
    throw Refused();
  }

  static void check(bool accepted) {
    if (!accepted) throw Refused();
  }

  void close() {
    tree_.close();
    key_next_ = true;
  }

  ValueTree& tree_;
  std::size_t first_;
  std::size_t values_ = 0;
  int documents_ = 0;
  bool key_next_ = true;
};

}  // namespace

std::optional<JsonValue> parse_yaml(const std::shared_ptr<const SourceText>& source,
                                    Diagnostics& diagnostics) {
  ValueTree tree(source, "", ErrorCode::input, diagnostics);
  // The parser's offsets do not include the byte order mark.
  YamlTreeBuilder builder(tree, source->text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
  std::istringstream text(source->text);
  try {
    YAML::Parser parser(text);
    while (parser.HandleNextDocument(builder)) {
    }
    if (builder.documents() == 0) tree.refuse(0, "expected a value (got an empty text)");
  } catch (const Refused&) {
  } catch (const YAML::Exception& error) {
    tree.refuse(builder.offset(error.mark), "not YAML: " + error.msg, tree.pointer());
  }
  if (tree.refused()) return std::nullopt;
  return tree.take();
}

}  // namespace abbe
