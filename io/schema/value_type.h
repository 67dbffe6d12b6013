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

// Types of the values in a user's file. Reading, writing and describing values all use them. A type accesses
// the C++ value through plain functions, whose arguments `value`, `list` and `variant` are its address.
namespace abbe::schema {

struct ValueType;
struct Fields;

/// Type of the elements of a container; never nullptr.
using Element = std::shared_ptr<const ValueType>;

/// A double.
struct Number {
  Range range;
};
/// An integer of any C++ type.
struct Integer {
  Range range;
  void (*set)(void* value, std::int64_t to);
  std::int64_t (*get)(const void* value);
};
/// A bool.
struct Boolean {};
/// A std::string.
struct Text {};
/// An enumeration whose values 0, 1, 2 … have these names.
struct Enumeration {
  /// Noun for the value in errors, such as "filter".
  std::string_view what;
  std::vector<const char*> names;
  /// True if a number may replace the name that consists of its digits.
  bool accepts_numbers;
  void (*set)(void* value, std::size_t to);
  std::size_t (*get)(const void* value);
};
/// A fixed number of numbers, such as a point, written as an array.
struct Vector {
  std::size_t count;
  Range range;    ///< Range of each number.
  bool nonzero;   ///< True for a direction: not all numbers may be 0.
  bool integers;  ///< True if the numbers are integers.
  void (*set)(void* value, std::size_t i, double to);
  double (*get)(const void* value, std::size_t i);
};
/// A std::vector<double> of any length, each number within `range`.
struct Numbers {
  Range range;
};
/// An object with a field table.
struct Struct {
  const Fields& (*fields)();
};
/// A list of values of one type, written as an array.
struct List {
  Element element;
  std::string_view what;  ///< What the elements are, for errors, e.g. "layers".
  std::size_t min_size;
  bool allows_single;  ///< True if a single element may be written without brackets.
  void (*reserve)(void* list, std::size_t count);
  void* (*append)(void* list, const SourcePosition& where);  ///< Address of the value of a new last element.
  std::size_t (*size)(const void* list);
  const void* (*at)(const void* list, std::size_t i);
};
/// Values of one type, each with a name that the user chooses, written as an object.
struct ByName {
  Element element;
  std::string_view what;  ///< What the elements are, for errors, e.g. "channels by name".
  std::size_t min_size;
  /// Address of the value of a new last element.
  void* (*append)(void* list, const std::string& name, const SourcePosition& where);
  std::size_t (*size)(const void* list);
  const void* (*at)(const void* list, std::size_t i);
  const std::string& (*name)(const void* list, std::size_t i);
};

/// JSON type that selects a form; `any` fits every value.
enum class Json { number, text, list, object, any };

/// An alternative of a variant. `emplace` makes it the current alternative, with its source position, and
/// returns the address of its value. `get` returns that address, or nullptr if another one is current.
struct Alternative {
  Element type;
  void* (*emplace)(void* variant, const SourcePosition& where);
  const void* (*get)(const void* variant);
};
/// An alternative that is selected by the JSON type and, for objects, by one of several keys.
struct Form {
  Json json;
  std::vector<std::string_view> keys;  ///< Keys one of which the object has; any object if empty.
  Alternative alternative;
};
/// A value that may be written in several forms. The first form that fits is used; a misspelt key also
/// selects its form.
struct Forms {
  std::string_view name;      ///< Name of a definition in the JSON schema; empty for none.
  std::string_view expected;  ///< The forms, for errors, e.g. "a curve: a number, a name or an object".
  std::vector<Form> forms;
};
/// An alternative that is selected by its key.
struct Choice {
  std::string_view key;
  /// Meaning, as a sentence; empty if the text of the struct that is its value suffices.
  std::string_view text;
  bool nested;  ///< True if the alternative is the value of its key. False if its fields, among them the key,
                ///< are in the same object.
  Alternative alternative;
};
/// A group of keys, exactly one or at most one of which is present. After an error the variant holds its
/// first alternative, std::monostate.
struct OneOf {
  bool required;  ///< True if one key must be present.
  /// Error if two keys are present, e.g. "an emission has one scale"; empty for a list of the allowed keys.
  std::string_view conflict;
  std::vector<Choice> choices;
  void (*clear)(void* variant);  ///< Makes std::monostate the current alternative.
};
/// The fields of another struct, in the same object.
struct Inlined {
  const Fields& (*fields)();
};

/// Type of a value in a file and in C++.
struct ValueType {
  std::variant<Number, Integer, Boolean, Text, Enumeration, Vector, Numbers, Struct, List, ByName, Forms>
      variant;
  const std::type_info* cpp_type;  ///< Type of the C++ value.
};

}  // namespace abbe::schema
