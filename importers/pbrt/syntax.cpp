#include "importers/pbrt/syntax.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "importers/shared/placement.h"
#include "io/text.h"

namespace abbe::importers::pbrt {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";
constexpr std::size_t kMaxFiles = 64;  // Largest depth of inclusion.

using Imath::M44d;
using Imath::V3d;

// The matrix of a transform directive, or an error.
struct Step {
  std::optional<M44d> matrix;
  const char* fault = "";
};

// World-to-camera matrix of LookAt, for a camera with x to the right, y up and z forward.
Step look_at(const std::vector<double>& n) {
  const auto camera = looking_at({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, V3d(n[6], n[7], n[8]).normalized());
  if (!camera) return {{}, "the view direction is zero or parallel to up"};
  return {camera->inverse()};
}

Step translate(const std::vector<double>& n) {
  return {translation({n[0], n[1], n[2]})};
}

Step scale(const std::vector<double>& n) {
  if (n[0] * n[1] * n[2] == 0) return {{}, "a scale factor must not be 0"};
  return {scaling({n[0], n[1], n[2]})};
}

Step rotate(const std::vector<double>& n) {
  const V3d axis(n[1], n[2], n[3]);
  if (axis.length2() == 0) return {{}, "the axis of a rotation must not be 0"};
  return {rotation(axis, n[0])};
}

// The file has matrices column by column, which for row vectors is row by row.
Step matrix(const std::vector<double>& n) {
  const M44d by = from_rows(n).transposed();
  if (by.determinant() == 0) return {{}, "a matrix is singular"};
  return {by};
}

Step identity(const std::vector<double>& /*n*/) {
  return {M44d()};
}

struct TransformDirective {
  std::string_view word;
  std::size_t count;
  Step (*step)(const std::vector<double>& numbers);
  bool replaces;  // True if it replaces the current transform.
};
constexpr std::array<TransformDirective, 7> kTransformDirectives{{{"Identity", 0, identity, true},
                                                                  {"LookAt", 9, look_at, false},
                                                                  {"Translate", 3, translate, false},
                                                                  {"Scale", 3, scale, false},
                                                                  {"Rotate", 4, rotate, false},
                                                                  {"Transform", 16, matrix, true},
                                                                  {"ConcatTransform", 16, matrix, false}}};

enum class Values { numbers, integers, texts, booleans, either };
// Nouns for messages, in the order of `Values`.
constexpr std::array<const char*, 5> kExpected{"a number", "an integer", "a quoted text", "true or false",
                                               "a number or a quoted text"};
struct Type {
  const char* name;
  Values values;
  std::size_t multiple;  // The number of values is a multiple of it.
};
constexpr std::array<Type, 17> kParameterTypes{{{"float", Values::numbers, 1},
                                                {"integer", Values::integers, 1},
                                                {"point2", Values::numbers, 2},
                                                {"vector2", Values::numbers, 2},
                                                {"point3", Values::numbers, 3},
                                                {"point", Values::numbers, 3},
                                                {"vector3", Values::numbers, 3},
                                                {"vector", Values::numbers, 3},
                                                {"normal3", Values::numbers, 3},
                                                {"normal", Values::numbers, 3},
                                                {"bool", Values::booleans, 1},
                                                {"string", Values::texts, 1},
                                                {"texture", Values::texts, 1},
                                                {"rgb", Values::numbers, 3},
                                                {"color", Values::numbers, 3},
                                                {"blackbody", Values::numbers, 1},
                                                {"spectrum", Values::either, 1}}};

const Type* type_of(const std::string& name) {
  const auto* type = std::ranges::find_if(kParameterTypes, [&](const Type& t) { return name == t.name; });
  return type == kParameterTypes.end() ? nullptr : type;
}

bool add(const Token& token, Values values, Parameter& parameter) {
  const bool boolean = token.text == "true" || token.text == "false";
  if (values == Values::booleans) {
    if (boolean) parameter.texts.push_back(token.text);
    return boolean;
  }
  if (token.quoted) {
    parameter.texts.push_back(token.text);
    return values == Values::texts || values == Values::either;
  }
  const auto number = values == Values::texts ? std::nullopt : parse_number(token.text);
  if (!number || (values == Values::integers && *number != std::floor(*number))) return false;
  parameter.numbers.push_back(*number);
  return true;
}

bool read_head(const Token& token, Parameter& parameter, SceneImporter& importer) {
  const auto gap = token.text.find_first_of(" \t");
  const auto name = gap == std::string::npos ? gap : token.text.find_first_not_of(" \t", gap);
  if (name == std::string::npos)
    return importer.refuse(token.where,
                           fmt::format("expected a parameter as \"type name\" (got \"{}\")", token.text));
  parameter.type = token.text.substr(0, gap);
  parameter.name = token.text.substr(name);
  while (parameter.name.ends_with(' ')) parameter.name.pop_back();
  parameter.where = token.where;
  if (type_of(parameter.type) != nullptr) return true;
  std::vector<std::string> names;
  for (const Type& type : kParameterTypes) names.emplace_back(type.name);
  return importer.is_known("type of parameter", parameter.type, names, token.where);
}

std::size_t bytes_of_lists(const Parameter& parameter) {
  return parameter.numbers.capacity() * sizeof(double) + parameter.texts.capacity() * sizeof(std::string);
}

bool read_values(Tokens& tokens, Parameter& parameter, SceneImporter& importer) {
  parameter.memory = OwnedReservation(importer, sizeof(Parameter));
  const Type& type = *type_of(parameter.type);
  const auto take = [&](const std::optional<Token>& token) {
    if (!token)
      return tokens.failed() ||
             importer.refuse(tokens.end(),
                             fmt::format("the file ends before a value of \"{}\"", parameter.name));
    const std::size_t before = bytes_of_lists(parameter);
    const bool added = add(*token, type.values, parameter);
    parameter.memory.grow_by(bytes_of_lists(parameter) - before + (token->quoted ? token->text.size() : 0));
    return added ||
           importer.refuse(token->where, fmt::format("expected {} of \"{} {}\" (got \"{}\")",
                                                     kExpected.at(static_cast<std::size_t>(type.values)),
                                                     parameter.type, parameter.name, token->text));
  };
  std::optional<Token> token = tokens.next();
  if (!token || !token->is("[")) {
    if (!take(token)) return false;
  } else {
    for (token = tokens.next(); token && !token->is("]"); token = tokens.next())
      if (!take(token)) return false;
    if (!token)
      return importer.refuse(parameter.where,
                             fmt::format("the values of \"{}\" have no closing ]", parameter.name));
  }
  const std::size_t count = parameter.numbers.size() + parameter.texts.size();
  if (tokens.failed() || (count > 0 && count % type.multiple == 0)) return !tokens.failed();
  return importer.refuse(parameter.where, fmt::format("\"{} {}\" takes multiples of {} values (got {})",
                                                      parameter.type, parameter.name, type.multiple, count));
}

}  // namespace

Tokens::Tokens(const std::filesystem::path& file, SceneImporter& importer) : importer_(importer) {
  open(file);
}

void Tokens::open(const std::filesystem::path& file) {
  auto source = importer_.read(file);
  if (!source) {
    failed_ = true;
    return;
  }
  files_.push_back({std::move(source)});
}

void Tokens::include(const std::filesystem::path& file, const SourcePosition& where) {
  if (files_.size() == kMaxFiles) {
    importer_.fail(where, fmt::format("files are included more than {} levels deep", kMaxFiles));
    failed_ = true;
  } else if (!importer_.count_include(where) || !is_file(file, where, importer_.diagnostics)) {
    failed_ = true;
  } else {
    open(file);
  }
}

void Tokens::import_file(const std::filesystem::path& file, const SourcePosition& where) {
  include(file, where);
  if (!failed_) files_.back().imported = true;
}

std::optional<Token> Tokens::next() {
  if (!peeked_) return read();
  return std::exchange(peeked_, std::nullopt);
}

const std::optional<Token>& Tokens::peek() {
  if (!peeked_) peeked_ = read();
  return peeked_;
}

std::optional<Token> Tokens::read() {
  while (!failed_ && !files_.empty()) {
    OpenFile& file = files_.back();
    const std::string& text = file.source->text;
    file.at = std::min(text.find_first_not_of(kBlanks, file.at), text.size());
    end_ = {file.source, file.at, ""};
    if (file.at == text.size()) {
      const bool imported = file.imported;
      files_.pop_back();
      if (imported) return Token{"", false, end_};
    } else if (text[file.at] == '#') {
      file.at = std::min(text.find('\n', file.at), text.size());
    } else if (text[file.at] == '"') {
      return read_quoted(file);
    } else if (text[file.at] == '[' || text[file.at] == ']') {
      ++file.at;
      return Token{text.substr(file.at - 1, 1), false, end_};
    } else {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n\f\v\"[]#", file.at), text.size());
      const std::size_t from = std::exchange(file.at, end);
      return Token{text.substr(from, end - from), false, end_};
    }
  }
  return std::nullopt;
}

std::optional<Token> Tokens::read_quoted(OpenFile& file) {
  const std::string& text = file.source->text;
  std::string word;
  for (std::size_t i = file.at + 1; i < text.size() && text[i] != '\n'; ++i) {
    if (text[i] == '"') {
      file.at = i + 1;
      return Token{word, true, end_};
    }
    if (text[i] == '\\' && i + 1 < text.size()) ++i;
    word += text[i];
  }
  importer_.fail(end_, "a quoted text without its closing quote");
  failed_ = true;
  return std::nullopt;
}

bool read_numbers(std::size_t count, const Token& word, Tokens& tokens, std::vector<double>& to,
                  SceneImporter& importer) {
  const bool bracketed = count > 0 && tokens.peek() && tokens.peek()->is("[");
  if (bracketed) (void)tokens.next();
  for (std::size_t i = 0; i < count + (bracketed ? 1 : 0); ++i) {
    const auto token = tokens.next();
    if (!token)
      return !tokens.failed() &&
             importer.refuse(tokens.end(), fmt::format("the file ends within {}", word.text));
    if (i == count)
      return token->is("]") ||
             importer.refuse(token->where, fmt::format("expected ] (got \"{}\")", token->text));
    const auto number = token->quoted ? std::nullopt : parse_number(token->text);
    if (!number)
      return importer.refuse(token->where, fmt::format("expected number {} of {} of {} (got \"{}\")", i + 1,
                                                       count, word.text, token->text));
    to.push_back(*number);
  }
  return true;
}

bool apply_transform(const Token& word, Tokens& tokens, M44d& to_world, SceneImporter& importer) {
  for (const TransformDirective& directive : kTransformDirectives) {
    if (directive.word != word.text) continue;
    std::vector<double> numbers;
    if (!read_numbers(directive.count, word, tokens, numbers, importer)) return false;
    const Step step = directive.step(numbers);
    if (!step.matrix) return importer.refuse(word.where, step.fault);
    to_world = directive.replaces ? *step.matrix : *step.matrix * to_world;
    return true;
  }
  throw Error(ErrorCode::internal, "pbrt", "not a transform directive: " + word.text);
}

std::optional<Parameters> Parameters::read(Tokens& tokens, SceneImporter& importer) {
  Parameters parameters(importer);
  while (tokens.peek() && tokens.peek()->quoted) {
    Parameter parameter;
    if (!read_head(*tokens.next(), parameter, importer) || !read_values(tokens, parameter, importer))
      return std::nullopt;
    parameters.list_.push_back(std::move(parameter));
  }
  if (tokens.failed()) return std::nullopt;
  return parameters;
}

void Parameters::add_defaults(const Parameters& defaults) {
  for (const Parameter& parameter : defaults.list_)
    if (!has(parameter.name)) list_.push_back(parameter);
}

bool Parameters::has(std::string_view name) const {
  return std::ranges::find(list_, name, &Parameter::name) != list_.end();
}

const Parameter* Parameters::find(std::string_view name, std::initializer_list<const char*> types) const {
  const auto found = std::ranges::find(list_, name, &Parameter::name);
  if (found == list_.end()) return nullptr;
  found->used = true;
  if (std::ranges::find(types, found->type) != types.end()) return &*found;
  importer_->fail(found->where, fmt::format("\"{}\" has a wrong type (got {}, allowed {})", name, found->type,
                                            fmt::join(types, ", ")));
  return nullptr;
}

// The parameter called `name` if it has `count` values; others are reported.
const Parameter* Parameters::single(std::string_view name, std::initializer_list<const char*> types,
                                    std::size_t count) const {
  const Parameter* found = find(name, types);
  if (found == nullptr) return nullptr;
  const std::size_t values = found->numbers.size() + found->texts.size();
  if (values == count) return found;
  importer_->fail(found->where,
                  fmt::format("\"{}\" takes {} (got {})", name,
                              count == 1 ? "one value" : fmt::format("{} values", count), values));
  return nullptr;
}

double Parameters::number(std::string_view name, double fallback) const {
  const Parameter* found = single(name, {"float"}, 1);
  return found ? found->numbers.front() : fallback;
}

int Parameters::integer(std::string_view name, int fallback) const {
  const Parameter* found = single(name, {"integer"}, 1);
  return found ? static_cast<int>(std::clamp(found->numbers.front(), -1e9, 1e9)) : fallback;
}

bool Parameters::boolean(std::string_view name, bool fallback) const {
  const Parameter* found = single(name, {"bool"}, 1);
  return found ? found->texts.front() == "true" : fallback;
}

std::string Parameters::text(std::string_view name, const std::string& fallback) const {
  const Parameter* found = single(name, {"string", "texture"}, 1);
  return found ? found->texts.front() : fallback;
}

Imath::V3d Parameters::point(std::string_view name, const Imath::V3d& fallback) const {
  const Parameter* found = single(name, {"point3", "point", "vector3", "vector"}, 3);
  return found ? Imath::V3d(found->numbers[0], found->numbers[1], found->numbers[2]) : fallback;
}

std::vector<double> Parameters::numbers(std::string_view name) const {
  const Parameter* found = find(name, {"float", "integer", "point2", "vector2", "point3", "point", "vector3",
                                       "vector", "normal3", "normal"});
  return found ? found->numbers : std::vector<double>{};
}

void Parameters::ignore(std::initializer_list<std::string_view> names) const {
  for (const Parameter& parameter : list_)
    parameter.used = parameter.used || std::ranges::find(names, parameter.name) != names.end();
}

void Parameters::note_unused(const std::string& of) const {
  for (const Parameter& parameter : list_)
    if (!parameter.used)
      importer_->note(parameter.where,
                      fmt::format("\"{}\" of {} is not supported: dropped", parameter.name, of));
}

}  // namespace abbe::importers::pbrt
