#include "io/json.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <rapidjson/reader.h>
#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/replace.hpp>

#include "io/text.h"

namespace abbe {

namespace {
constexpr unsigned kFlags = rapidjson::kParseIterativeFlag | rapidjson::kParseInsituFlag |
                            rapidjson::kParseCommentsFlag | rapidjson::kParseTrailingCommasFlag |
                            rapidjson::kParseNumbersAsStringsFlag;

// Token of a JSON pointer as a key [RFC6901, sec. 3].
std::string unescaped(std::string_view token) {
  std::string key(token);
  boost::replace_all(key, "~1", "/");
  boost::replace_all(key, "~0", "~");
  return key;
}

/// Builds the tree from the parser's events. Parsing in place makes strings and numbers point into the copy
/// of the text, from which their offsets follow.
class JsonTreeBuilder : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, JsonTreeBuilder> {
 public:
  JsonTreeBuilder(rapidjson::InsituStringStream& stream, ValueTree& tree) : stream_(stream), tree_(tree) {}

  bool Null() { return tree_.add(nullptr, stream_.Tell() - std::string_view("null").size()); }
  bool Bool(bool b) { return tree_.add(b, stream_.Tell() - std::string_view(b ? "true" : "false").size()); }
  bool StartObject() { return tree_.open(JsonValue::Object{}, stream_.Tell()); }
  bool StartArray() { return tree_.open(JsonValue::Array{}, stream_.Tell()); }
  bool EndObject(rapidjson::SizeType) { return close(); }
  bool EndArray(rapidjson::SizeType) { return close(); }

  bool RawNumber(const char* text, rapidjson::SizeType size, bool) {
    const std::size_t offset = offset_of(text);
    const std::string_view digits(text, size);
    if (const auto number = parse_number(digits)) return tree_.add(*number, offset);
    return tree_.refuse(
        offset, fmt::format("number out of range (got {}, allowed magnitudes from 4.94e-324 to 1.797e308)",
                            digits.substr(0, 40)));
  }

  bool String(const char* text, rapidjson::SizeType size, bool) {
    const std::size_t offset = offset_of(text) - 1;
    return is_text({text, size}, offset) && tree_.add(std::string(text, size), offset);
  }

  bool Key(const char* text, rapidjson::SizeType size, bool) {
    const std::size_t offset = offset_of(text) - 1;
    tree_.key(std::string(text, size), offset);
    return is_text({text, size}, offset);
  }

 private:
  [[nodiscard]] std::size_t offset_of(const char* text) const {
    return static_cast<std::size_t>(text - stream_.head_);
  }

  bool is_text(std::string_view text, std::size_t offset) {
    return valid_prefix(text) == text.size() ||
           tree_.refuse(offset, "invalid string (got NUL or half a surrogate pair)", tree_.pointer());
  }

  bool close() {
    tree_.close();
    return true;
  }

  rapidjson::InsituStringStream& stream_;
  ValueTree& tree_;
};

/// Token that the grammar expects where the parser stopped.
std::string_view expectation(rapidjson::ParseErrorCode code) {
  using enum rapidjson::ParseErrorCode;
  static const std::map<rapidjson::ParseErrorCode, std::string_view> kExpected{
      {kParseErrorDocumentRootNotSingular, "the end of the text"},
      {kParseErrorObjectMissName, "a key in double quotes or '}'"},
      {kParseErrorObjectMissColon, "':'"},
      {kParseErrorObjectMissCommaOrCurlyBracket, "',' or '}'"},
      {kParseErrorArrayMissCommaOrSquareBracket, "',' or ']'"},
      {kParseErrorStringUnicodeEscapeInvalidHex, "four hexadecimal digits after \\u"},
      {kParseErrorStringUnicodeSurrogateInvalid, "a complete surrogate pair"},
      {kParseErrorStringEscapeInvalid, "a printable character or a JSON escape"},
      {kParseErrorStringMissQuotationMark, "'\"' at the end of the string"},
      {kParseErrorNumberMissFraction, "a digit after the decimal point"},
      {kParseErrorNumberMissExponent, "a digit in the exponent"},
      {kParseErrorUnspecificSyntaxError, "a complete comment"}};
  const auto found = kExpected.find(code);
  return found == kExpected.end() ? "a value" : found->second;
}

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.' || c == '_';
}

bool names_not_finite(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return boost::iequals(word, "nan") || boost::iequals(word, "inf") || boost::iequals(word, "infinity");
}

// Reports the position and the reason at which the parser stopped, with the word found there.
void report(const rapidjson::ParseResult& result, SourcePosition where, Diagnostics& diagnostics) {
  const std::string_view text = where.source->text;
  where.offset = std::min(result.Offset(), text.size());
  if (where.offset == text.size() && text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    return diagnostics.error({where.source, 0, ""}, "expected a value (got an empty text)");
  if (result.Code() ==
      // The parser stops inside the word, or after the sign of "-Infinity".
      rapidjson::kParseErrorValueInvalid)
    while (where.offset > 0 && in_word(text[where.offset - 1])) --where.offset;
  if (where.offset == text.size())
    return diagnostics.error(
        where, fmt::format("expected {} (got the end of the text)", expectation(result.Code())));

  const std::string_view rest = text.substr(where.offset, 40);
  std::size_t size =
      static_cast<std::size_t>(std::find_if_not(rest.begin(), rest.end(), in_word) - rest.begin());
  if (size == 0)  // Show one whole character instead.
    for (size = 1; size < rest.size() && valid_prefix(rest.substr(0, size)) < size;) ++size;
  const std::string_view word = rest.substr(0, size);
  if (result.Code() == rapidjson::kParseErrorNumberTooBig)
    return diagnostics.error(
        where, fmt::format("number out of range (got {}, allowed magnitudes to 1.797e308)", word));
  if (names_not_finite(word))
    return diagnostics.error(where, fmt::format("expected a value (got {}, allowed finite numbers)", word));
  diagnostics.error(where, fmt::format("expected {} (got {})", expectation(result.Code()), word));
}

// Parses a text whose value has the JSON pointer `pointer`.
std::optional<JsonValue> parse(const std::shared_ptr<const SourceText>& source, const std::string& pointer,
                               Diagnostics& diagnostics, MemoryReservation* memory = nullptr) {
  if (memory != nullptr) memory->reserve(source->file, source->text.size());
  std::string scratch = source->text;
  rapidjson::InsituStringStream stream(scratch.data());
  ValueTree tree(source, pointer, ErrorCode::scene, diagnostics, memory);
  JsonTreeBuilder builder(stream, tree);
  rapidjson::Reader reader;
  const rapidjson::ParseResult result = reader.Parse<kFlags>(stream, builder);
  if (result.IsError() && result.Code() != rapidjson::kParseErrorTermination)
    report(result, {source, 0, tree.pointer()}, diagnostics);
  else if (!tree.refused() && stream.Tell() != source->text.size())
    diagnostics.error({source, stream.Tell(), ""}, "NUL byte in a text");
  else if (!tree.refused())
    return tree.take();
  return std::nullopt;
}

/// The array element that a token of a pointer names; created if it is the one after the last. nullptr if the
/// token is no such index.
JsonValue* element(JsonValue::Array& array, const std::string& token) {
  const bool digits = !token.empty() && token.find_first_not_of("0123456789") == std::string::npos;
  const bool leading_zero = token.size() > 1 && token.starts_with('0');
  if (token != "-" && (!digits || leading_zero || token.size() > 9)) return nullptr;
  const std::size_t index = token == "-" ? array.size() : std::stoul(token);
  if (index > array.size()) return nullptr;
  if (index == array.size()) array.emplace_back();
  return &array[index];
}

/// The value at `pointer`, created with the objects on the path if missing. nullptr if the path passes
/// through another value.
JsonValue* find_or_create(JsonValue& root, const std::string& pointer,
                          const std::shared_ptr<const SourceText>& source) {
  JsonValue* at = &root;
  for (std::size_t begin = 0; begin < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', begin + 1), pointer.size());
    const std::string token = unescaped(std::string_view(pointer).substr(begin + 1, end - begin - 1));
    if (auto* array = std::get_if<JsonValue::Array>(&at->value)) {
      at = element(*array, token);
    } else if (auto* object = std::get_if<JsonValue::Object>(&at->value)) {
      JsonValue* member = at->find(token);
      if (!member) object->push_back({token, {}});
      at = member ? member : &object->back().second;
    } else {
      return nullptr;
    }
    if (!at) return nullptr;
    if (!at->where.source) *at = {JsonValue::Object{}, {source, 0, pointer.substr(0, end)}};
    begin = end;
  }
  return at;
}

using TextWriter = rapidjson::Writer<rapidjson::StringBuffer>;

void put(TextWriter& writer, std::string_view text) {
  writer.String(text.data(), static_cast<rapidjson::SizeType>(text.size()));
}

void write(TextWriter& writer, const JsonValue& json) {
  if (const auto* array = std::get_if<JsonValue::Array>(&json.value)) {
    writer.StartArray();
    for (const JsonValue& element : *array) write(writer, element);
    writer.EndArray();
  } else if (const auto* object = std::get_if<JsonValue::Object>(&json.value)) {
    writer.StartObject();
    for (const auto& [key, member] : *object) {
      put(writer, key);
      write(writer, member);
    }
    writer.EndObject();
  } else if (const auto* text = std::get_if<std::string>(&json.value)) {
    put(writer, *text);
  } else if (const auto* number = std::get_if<double>(&json.value)) {
    const std::string digits = fmt::format("{}", *number);
    writer.RawValue(digits.data(), digits.size(), rapidjson::kNumberType);
  } else if (const auto* boolean = std::get_if<bool>(&json.value)) {
    writer.Bool(*boolean);
  } else {
    writer.Null();
  }
}

constexpr std::size_t kOneLine = std::string::npos;

// The value from a column on. A value that does not fit into `width` takes several lines; every value fits
// into `kOneLine`.
std::string lines_of(const JsonValue& json, std::size_t column, std::size_t indent, std::size_t width) {
  const auto* array = std::get_if<JsonValue::Array>(&json.value);
  const auto* object = std::get_if<JsonValue::Object>(&json.value);
  if (!array && !object) return to_text(json);
  if (width != kOneLine)
    if (std::string line = lines_of(json, 0, 0, kOneLine); column + line.size() + 1 <= width)  // 1: a comma.
      return line;
  const std::string margin = width == kOneLine ? "" : '\n' + std::string(indent + 2, ' ');
  std::string out(1, array ? '[' : '{');
  for (std::size_t i = 0; i < (array ? array->size() : object->size()); ++i) {
    const std::string key = object ? to_text({(*object)[i].first, {}}) + ": " : "";
    out += (i == 0 ? "" : width == kOneLine ? ", " : ",") + margin + key;
    const JsonValue& element = array ? (*array)[i] : (*object)[i].second;
    out += lines_of(element, indent + 2 + key.size(), indent + 2, width);
  }
  if (width != kOneLine) out += '\n' + std::string(indent, ' ');
  return out + (array ? ']' : '}');
}
}  // namespace

std::string escaped_key(std::string_view key) {
  std::string token(key);
  boost::replace_all(token, "~", "~0");
  boost::replace_all(token, "/", "~1");
  return token;
}

std::string to_lines(const JsonValue& value, std::size_t width) {
  return lines_of(value, 0, 0, width) + '\n';
}

std::string to_text(const JsonValue& value) {
  rapidjson::StringBuffer buffer;
  TextWriter writer(buffer);
  write(writer, value);
  return {buffer.GetString(), buffer.GetSize()};
}

std::string_view JsonValue::type_name() const {
  constexpr std::array<std::string_view, 6> kNames{"null",     "a boolean", "a number",
                                                   "a string", "an array",  "an object"};
  return kNames[value.index()];
}

const JsonValue* JsonValue::find(std::string_view key) const {
  if (const auto* object = std::get_if<Object>(&value))
    for (const Member& member : *object)
      if (member.first == key) return &member.second;
  return nullptr;
}

JsonValue* JsonValue::find(std::string_view key) {
  return const_cast<JsonValue*>(std::as_const(*this).find(key));
}

std::optional<JsonValue> parse_json(const std::shared_ptr<const SourceText>& source, Diagnostics& diagnostics,
                                    MemoryReservation* memory) {
  return parse(source, "", diagnostics, memory);
}

void set_json(JsonValue& root, std::string_view pointer, std::string_view text, Diagnostics& diagnostics,
              std::string_view option_name) {
  const auto source =
      std::make_shared<const SourceText>(SourceText{std::string(option_name), std::string(text)});
  const SourcePosition where{source, 0, std::string(pointer)};
  if (valid_prefix(text) < text.size() || valid_prefix(pointer) < pointer.size())
    return diagnostics.error({}, std::string(option_name) + ": invalid UTF-8", ErrorCode::usage);
  Diagnostics parse_diagnostics;
  std::optional<JsonValue> value = parse(source, where.pointer, parse_diagnostics);
  if (!value && text.find_first_of("[{\"") == 0) {
    const Diagnostic& first = parse_diagnostics.all().front();
    return diagnostics.error(first.where, first.message, ErrorCode::usage);
  }
  if (!value) value = JsonValue{std::string(text), where};

  JsonValue* target =
      pointer.empty() || pointer.starts_with('/') ? find_or_create(root, where.pointer, source) : nullptr;
  if (!target) return diagnostics.error(where, "no value can be set at this pointer", ErrorCode::usage);
  *target = std::move(*value);
}

ValueTree::ValueTree(std::shared_ptr<const SourceText> source, std::string pointer, ErrorCode code,
                     Diagnostics& diagnostics, MemoryReservation* memory)
    : source_(std::move(source)),
      pointer_(std::move(pointer)),
      code_(code),
      diagnostics_(diagnostics),
      memory_(memory) {}

bool ValueTree::add(decltype(JsonValue::value) value, std::size_t offset) {
  std::string pointer = next_pointer();
  if (pointer.size() > kMaxPointer)
    return refuse(
        offset,
        fmt::format("keys too long (got a path of {} bytes, allowed {})", pointer.size(), kMaxPointer),
        this->pointer());
  if (memory_ != nullptr) count(value, pointer);
  last_ = insert({std::move(value), {source_, offset, std::move(pointer)}});
  return true;
}

// The factor 2 allows for the spare capacity of growing lists.
void ValueTree::count(const decltype(JsonValue::value)& value, const std::string& pointer) {
  const bool in_object = !open_.empty() && std::holds_alternative<JsonValue::Object>(open_.back()->value);
  const auto* text = std::get_if<std::string>(&value);
  memory_->reserve(source_->file, 2 * (in_object ? sizeof(JsonValue::Member) : sizeof(JsonValue)) +
                                      pointer.size() + key_.size() + (text != nullptr ? text->size() : 0));
}

bool ValueTree::open(decltype(JsonValue::value) container, std::size_t offset) {
  if (open_.size() == kMaxDepth)
    return refuse(offset, fmt::format("nesting too deep (allowed {} levels)", kMaxDepth), "");
  if (!add(std::move(container), offset)) return false;
  open_.push_back(last_);
  return true;
}

void ValueTree::close() {
  if (const auto* object = std::get_if<JsonValue::Object>(&open_.back()->value)) report_duplicates(*object);
  open_.pop_back();
}

void ValueTree::report_duplicates(const JsonValue::Object& object) {
  if (object.size() < 2) return;
  std::vector<const JsonValue::Member*> members;
  members.reserve(object.size());
  for (const auto& member : object) members.push_back(&member);
  std::ranges::sort(members, [](auto* a, auto* b) { return std::tie(a->first, a) < std::tie(b->first, b); });
  for (std::size_t i = 1; i < members.size(); ++i)
    if (members[i]->first == members[i - 1]->first)
      refuse(members[i]->second.key_offset, fmt::format("duplicate key \"{}\"", members[i]->first),
             members[i]->second.where.pointer);
}

bool ValueTree::refuse(std::size_t offset, std::string message, std::string pointer) {
  diagnostics_.error({source_, offset, std::move(pointer)}, std::move(message), code_);
  refused_ = true;
  return false;
}

bool ValueTree::refuse(std::size_t offset, std::string message) {
  return refuse(offset, std::move(message), next_pointer());
}

std::string ValueTree::pointer() const {
  return open_.empty() ? pointer_ : open_.back()->where.pointer;
}

std::string ValueTree::next_pointer() const {
  if (open_.empty()) return pointer_;
  const JsonValue& parent = *open_.back();
  const auto* array = std::get_if<JsonValue::Array>(&parent.value);
  const std::string token = array ? std::to_string(array->size()) : escaped_key(key_);
  std::string pointer;
  pointer.reserve(parent.where.pointer.size() + 1 + token.size());
  return pointer.append(parent.where.pointer).append("/").append(token);
}

// The returned pointer stays valid while the value is open: its parent grows again only after it has been
// closed.
JsonValue* ValueTree::insert(JsonValue value) {
  if (open_.empty()) return &(root_ = std::move(value));
  JsonValue& parent = *open_.back();
  if (auto* array = std::get_if<JsonValue::Array>(&parent.value))
    return &array->emplace_back(std::move(value));
  value.key_offset = key_offset_;
  auto& object = std::get<JsonValue::Object>(parent.value);
  object.push_back({std::move(key_), std::move(value)});
  return &object.back().second;
}

}  // namespace abbe
