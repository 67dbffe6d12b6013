#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <typeinfo>
#include <variant>
#include <vector>

#include "io/json_values.h"

// What a value of a user's file may be. A kind says it once, for reading, writing and describing values; what
// it needs to know of the C++ value it fills are plain functions over its address.
namespace abbe::schema {

struct Kind;
struct Fields;

/// The element of a list or group, wherever its container keeps it.
using Element = std::shared_ptr<const Kind>;

/// A double.
struct Number {
  Range range;
};
struct Integer {
  Range range;
  void (*set)(void* value, std::int64_t to);
  std::int64_t (*get)(const void* value);
};
/// A bool.
struct Boolean {};
/// A std::string.
struct Text {};
/// An enumeration whose values have these names, from 0 on.
struct Word {
  std::string_view what;  ///< As an error calls it, e.g. "filter".
  std::vector<const char*> names;
  bool numbers;  ///< A number stands for its digits as well.
  void (*set)(void* value, std::size_t to);
  std::size_t (*get)(const void* value);
};
/// So many numbers, such as a point's.
struct Vector {
  std::size_t count;
  Range range;
  bool direction;  ///< Which is of any length but zero.
  bool whole;      ///< Numbers that are integers.
  void (*set)(void* value, std::size_t i, double to);
  double (*get)(const void* value, std::size_t i);
};
/// A std::vector<double>.
struct Numbers {
  Range range;
};
/// An object with fields of its own.
struct Thing {
  const Fields& (*fields)();
};
/// A list of values of one kind.
struct List {
  Element element;
  std::string_view what;  ///< As an error calls them, e.g. "layers".
  std::size_t least;
  bool bare;  ///< A single one may stand without brackets.
  void (*reserve)(void* list, std::size_t count);
  void* (*append)(void* list, const SourcePosition& where);
  std::size_t (*size)(const void* list);
  const void* (*at)(const void* list, std::size_t i);
};
/// Values of one kind, each under a name that the user chooses.
struct ByName {
  Element element;
  std::string_view what;  ///< As an error calls them, e.g. "channels by name".
  std::size_t least;
  void* (*append)(void* list, const std::string& name, const SourcePosition& where);
  std::size_t (*size)(const void* list);
  const void* (*at)(const void* list, std::size_t i);
  const std::string& (*name)(const void* list, std::size_t i);
};

/// What of JSON a form is told by.
enum class Json { number, text, list, object, any };

/// An alternative of a variant: `emplace` makes the variant hold it, `get` gives nullptr when another is
/// held.
struct Alternative {
  Element kind;
  void* (*emplace)(void* variant, const SourcePosition& where);
  const void* (*get)(const void* variant);
};
/// An alternative told by how it is written: by the type of JSON, and of objects by a key they have.
struct Form {
  Json json;
  std::vector<std::string_view> keys;  ///< One of which an object has; any object when there are none.
  Alternative alternative;
};
/// A value that may be written in several ways, of which the first that fits is taken.
struct Forms {
  std::string_view name;      ///< That of a definition of the JSON schema; empty where it has none.
  std::string_view expected;  ///< As an error calls them, e.g. "a curve: a number, a name or an object".
  std::vector<Form> forms;
};
/// An alternative told by its key.
struct Choice {
  std::string_view key;
  std::string_view text;
  bool inside;  ///< Whether it stands under its key; else it is fields of the same object, its key's among
                ///< them.
  Alternative alternative;
};
/// Keys of which exactly one is there, or at most one. After an error the variant holds its first
/// alternative, which is std::monostate.
struct OneOf {
  bool required;
  std::string_view
      several;  ///< What is wrong with two, if that has a name, e.g. "an emission has one scale".
  std::vector<Choice> choices;
  void (*clear)(void* variant);
};
/// The fields of another thing, in the same object.
struct Lent {
  const Fields& (*fields)();
};

struct Kind {
  std::variant<Number, Integer, Boolean, Text, Word, Vector, Numbers, Thing, List, ByName, Forms> of;
  const std::type_info* type;  ///< Of the C++ value.
};

}  // namespace abbe::schema
