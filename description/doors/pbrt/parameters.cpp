#include "description/doors/pbrt/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/text.h"

namespace abbe::doors::pbrt {
namespace {

enum class Values { numbers, integers, texts, truths, either };
struct Type {
  const char* name;
  Values values;
  std::size_t multiple;  // of which as many values are there
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
                                                {"bool", Values::truths, 1},
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

std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const Type& type : kParameterTypes) names.emplace_back(type.name);
  return names;
}

std::string_view expected(Values values) {
  switch (values) {
    case Values::numbers:
      return "a number";
    case Values::integers:
      return "an integer";
    case Values::texts:
      return "a quoted text";
    case Values::truths:
      return "true or false";
    case Values::either:
      break;
  }
  return "a number or a quoted text";
}

// Adds a value to the parameter; false if it is none of its type.
bool add(const Token& token, Values values, Parameter& parameter) {
  const bool truth = token.text == "true" || token.text == "false";
  if (values == Values::truths) {
    if (truth) parameter.texts.push_back(token.text);
    return truth;
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

// "type name" without the values.
bool read_head(const Token& token, Parameter& parameter, Door& door) {
  const auto gap = token.text.find_first_of(" \t");
  const auto name = gap == std::string::npos ? gap : token.text.find_first_not_of(" \t", gap);
  if (name == std::string::npos)
    return door.refuse(token.where,
                       fmt::format("expected a parameter as \"type name\" (got \"{}\")", token.text));
  parameter.type = token.text.substr(0, gap);
  parameter.name = token.text.substr(name);
  while (parameter.name.ends_with(' ')) parameter.name.pop_back();
  parameter.where = token.where;
  if (type_of(parameter.type) != nullptr) return true;
  return door.refuse(token.where, unknown_name("type of parameter", parameter.type, type_names()));
}

std::size_t bytes_of_lists(const Parameter& parameter) {
  return parameter.numbers.capacity() * sizeof(double) + parameter.texts.capacity() * sizeof(std::string);
}

bool read_values(Tokens& tokens, Parameter& parameter, Door& door) {
  parameter.memory = OwnedMemory(door, sizeof(Parameter));
  const Type& type = *type_of(parameter.type);
  const auto take = [&](const std::optional<Token>& token) {
    if (!token)
      return tokens.failed() ||
             door.refuse(tokens.end(), fmt::format("the file ends before a value of \"{}\"", parameter.name));
    const std::size_t before = bytes_of_lists(parameter);
    const bool added = add(*token, type.values, parameter);
    parameter.memory.grow_by(bytes_of_lists(parameter) - before + (token->quoted ? token->text.size() : 0));
    return added || door.refuse(token->where,
                                fmt::format("expected {} of \"{} {}\" (got \"{}\")", expected(type.values),
                                            parameter.type, parameter.name, token->text));
  };
  std::optional<Token> token = tokens.next();
  if (!token || !token->is("[")) {
    if (!take(token)) return false;
  } else {
    for (token = tokens.next(); token && !token->is("]"); token = tokens.next())
      if (!take(token)) return false;
    if (!token)
      return door.refuse(parameter.where,
                         fmt::format("the values of \"{}\" have no closing ]", parameter.name));
  }
  const std::size_t count = parameter.numbers.size() + parameter.texts.size();
  if (tokens.failed() || (count > 0 && count % type.multiple == 0)) return !tokens.failed();
  return door.refuse(parameter.where, fmt::format("\"{} {}\" takes multiples of {} values (got {})",
                                                  parameter.type, parameter.name, type.multiple, count));
}

}  // namespace

std::optional<Parameters> Parameters::read(Tokens& tokens, Door& door) {
  Parameters parameters;
  while (tokens.peek() && tokens.peek()->quoted) {
    Parameter parameter;
    if (!read_head(*tokens.next(), parameter, door) || !read_values(tokens, parameter, door))
      return std::nullopt;
    parameters.list_.push_back(std::move(parameter));
  }
  if (tokens.failed()) return std::nullopt;
  return parameters;
}

void Parameters::complete(const Parameters& defaults) {
  for (const Parameter& parameter : defaults.list_)
    if (!has(parameter.name)) list_.push_back(parameter);
}

bool Parameters::has(std::string_view name) const {
  return std::ranges::find(list_, name, &Parameter::name) != list_.end();
}

const Parameter* Parameters::find(std::string_view name, std::initializer_list<const char*> types,
                                  Door& door) const {
  const auto found = std::ranges::find(list_, name, &Parameter::name);
  if (found == list_.end()) return nullptr;
  found->used = true;
  if (std::ranges::find(types, found->type) != types.end()) return &*found;
  door.diagnostics.error(found->where, fmt::format("\"{}\" is of another type (got {}, allowed {})", name,
                                                   found->type, fmt::join(types, ", ")));
  return nullptr;
}

// The parameter of one of the types, with as many values.
const Parameter* Parameters::single(std::string_view name, std::initializer_list<const char*> types,
                                    std::size_t count, Door& door) const {
  const Parameter* found = find(name, types, door);
  if (found == nullptr) return nullptr;
  const std::size_t values = found->numbers.size() + found->texts.size();
  if (values == count) return found;
  door.diagnostics.error(found->where,
                         fmt::format("\"{}\" takes {} (got {})", name,
                                     count == 1 ? "one value" : fmt::format("{} values", count), values));
  return nullptr;
}

double Parameters::number(std::string_view name, double absent, Door& door) const {
  const Parameter* found = single(name, {"float"}, 1, door);
  return found ? found->numbers.front() : absent;
}

double Parameters::integer(std::string_view name, double absent, Door& door) const {
  const Parameter* found = single(name, {"integer"}, 1, door);
  return found ? found->numbers.front() : absent;
}

bool Parameters::truth(std::string_view name, bool absent, Door& door) const {
  const Parameter* found = single(name, {"bool"}, 1, door);
  return found ? found->texts.front() == "true" : absent;
}

std::string Parameters::text(std::string_view name, const std::string& absent, Door& door) const {
  const Parameter* found = single(name, {"string", "texture"}, 1, door);
  return found ? found->texts.front() : absent;
}

Imath::V3d Parameters::point(std::string_view name, const Imath::V3d& absent, Door& door) const {
  const Parameter* found = single(name, {"point3", "point", "vector3", "vector"}, 3, door);
  return found ? Imath::V3d(found->numbers[0], found->numbers[1], found->numbers[2]) : absent;
}

std::vector<double> Parameters::numbers(std::string_view name, Door& door) const {
  const Parameter* found = find(
      name,
      {"float", "integer", "point2", "vector2", "point3", "point", "vector3", "vector", "normal3", "normal"},
      door);
  return found ? found->numbers : std::vector<double>{};
}

void Parameters::ignore(std::initializer_list<std::string_view> names) const {
  for (const Parameter& parameter : list_)
    parameter.used = parameter.used || std::ranges::find(names, parameter.name) != names.end();
}

void Parameters::note_unused(const std::string& of, Door& door) const {
  for (const Parameter& parameter : list_)
    if (!parameter.used)
      door.note(parameter.where,
                fmt::format("\"{}\" of {} has no counterpart here: dropped", parameter.name, of));
}

}  // namespace abbe::doors::pbrt
