#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/diagnostics.h"
#include "io/schema/value_type.h"

// Access to the values of struct members through wrappers, optionals and shared pointers.
namespace abbe::schema {

/// Wraps a value. A type derived from it gives a meaning to the value, so that a variant can distinguish two
/// lengths.
template <typename T>
struct Value {
  using Wrapped = T;
  T value{};
};
/// A value with its source position, for later diagnostics. A struct needs no such wrapper: `read` also sets
/// its own member called `where`, if it has one.
template <typename T>
struct Located : Value<T> {
  SourcePosition where{};
};
/// A value with a name that the user chose.
template <typename T>
struct Named {
  std::string name;
  T value{};
  SourcePosition where{};  ///< Position of the value.
};

/// Type-erased access to the value of a member, whose address is the argument.
struct MemberFunctions {
  void* (*open)(void* member);             ///< Creates a value if the member may be empty; its address.
  const void* (*get)(const void* member);  ///< Address of the value; nullptr if the member is empty.
  void (*close)(void* member);             ///< Empties the member after an error, if it may be empty.
  /// Address at which to store the source position; nullptr if the member has none.
  SourcePosition* (*where)(void* member);
};

/// Presence of a key in its object.
enum class Presence { required, optional };

namespace detail {

template <typename M>
SourcePosition* where_of(M& member) {
  if constexpr (requires { member.where; })
    return &member.where;
  else
    return nullptr;
}

// Members that are the value or wrap it.
template <typename M>
struct MemberAccess {
  static auto& value(auto& member) {
    if constexpr (requires { typename M::Wrapped; })
      return member.value;
    else
      return member;
  }
  using Value = std::remove_cvref_t<decltype(value(std::declval<M&>()))>;
  static Value* open(M& member) { return &value(member); }
  static const Value* get(const M& member) { return &value(member); }
  static void close(M&) {}
  static SourcePosition* where(M& member) {
    if constexpr (requires { typename M::Wrapped; })
      return where_of(member);
    else
      return nullptr;
  }
  static constexpr Presence kPresence = Presence::required;
};
// Members that may be empty: std::optional, or std::shared_ptr for structs that contain their own type.
template <typename M>
requires requires(M m) {
  m.reset();
}
struct MemberAccess<M> {
  using Inner = std::remove_cvref_t<decltype(*std::declval<M&>())>;
  using Value = typename MemberAccess<Inner>::Value;
  static Value* open(M& member) {
    if constexpr (std::is_same_v<M, std::optional<Inner>>)
      member.emplace();
    else
      member = std::make_shared<Inner>();
    return MemberAccess<Inner>::open(*member);
  }
  static const Value* get(const M& member) { return member ? MemberAccess<Inner>::get(*member) : nullptr; }
  static void close(M& member) { member.reset(); }
  static SourcePosition* where(M& member) { return member ? MemberAccess<Inner>::where(*member) : nullptr; }
  static constexpr Presence kPresence =
      std::is_same_v<M, std::optional<Inner>> ? Presence::optional : Presence::required;
};

/// Type of the value in a member of type M.
template <typename M>
using ValueOf = typename MemberAccess<M>::Value;

/// Creates a value in `member` and stores its source position.
template <typename M>
void* open_at(M& member, const SourcePosition& where) {
  void* value = MemberAccess<M>::open(member);
  if (SourcePosition* position = MemberAccess<M>::where(member)) *position = where;
  return value;
}

template <typename M>
MemberFunctions access() {
  using H = MemberAccess<M>;
  return {[](void* m) -> void* { return H::open(*static_cast<M*>(m)); },
          [](const void* m) -> const void* { return H::get(*static_cast<const M*>(m)); },
          [](void* m) { H::close(*static_cast<M*>(m)); },
          [](void* m) { return H::where(*static_cast<M*>(m)); }};
}

}  // namespace detail
}  // namespace abbe::schema

// Declarative field tables of user files. A plain struct has its defaults as member initialisers, and a
// function returns its table:
//
//   Fields fields(Tag<Circle>) {
//     return describe("circle", "A flat circle.",
//                     {field("center", &Circle::center, point(), "Its center."),
//                      field("radius", &Circle::radius, kLength, "Its radius.")});
//   }
//
// `read`, `write`, `json_schema`, the guide and help use these tables. The value type is omitted if the
// member's type implies it: a bool, a string, a struct, or a type V with a function `ValueType
// value_type(Tag<V>)`.
//
// Keys and texts are string literals: tables refer to them. The builders throw Error{internal} if a declared
// type differs from that of its member; such an error is a bug of the table.
namespace abbe::schema {

/// Selects the table of a type: `fields(Tag<Circle>{})`.
template <typename T>
struct Tag {};

/// A value with a key, a group of keys, or the fields of another struct.
using FieldContent = std::variant<ValueType, OneOf, Inlined>;

/// One key of a struct, or one group of keys.
struct Field {
  std::string_view key;  ///< Empty for groups and inlined structs.
  std::shared_ptr<const FieldContent> content;
  /// Meaning, as a sentence; empty if the text of the struct that is its value suffices.
  std::string_view text;
  Presence presence;
  std::ptrdiff_t offset;        ///< Offset of the member in its struct [bytes].
  MemberFunctions access;       ///< Access to the value in the member.
  const std::type_info* owner;  ///< Type of the struct that has the member.

  /// Address of the member in the struct at `instance`.
  [[nodiscard]] void* member(void* instance) const { return static_cast<char*>(instance) + offset; }
  /// Address of the value in that member; nullptr if it is empty.
  [[nodiscard]] const void* get(const void* instance) const {
    return access.get(static_cast<const char*>(instance) + offset);
  }
  /// This field with another presence.
  [[nodiscard]] Field with(Presence other) const;
};

/// An array that may replace the object of a struct. Its values belong to the first keys of the table, in its
/// order; null omits a key.
struct ArrayForm {
  std::size_t min_size;
  std::size_t max_size;
};

/// The field table of a struct.
struct Fields {
  /// Name of the definition in the JSON schema, also for the guide; unique among the structs of a file.
  std::string_view name;
  std::string_view text;  ///< Meaning of the struct, as a sentence.
  /// Fields, in the order of reading, writing and description.
  std::vector<Field> fields;
  /// Keys, or paths of keys ("sun/irradiance"), at least one of which must be present; no such rule if empty.
  std::vector<std::string_view> any_of = {};
  /// True if at most one of `any_of` may be present.
  bool exclusive = false;
  std::optional<ArrayForm> array_form = {};  ///< Allowed for tables of optional single keys only.
  /// Address of a default-constructed struct; set by `fields_of`.
  const void* defaults = nullptr;
  /// Address of the member `where` of the struct at `instance`; nullptr if it has none. Set by `fields_of`.
  SourcePosition* (*where)(void* instance) = nullptr;

  /// This table for a struct that may be written as an array (`ArrayForm`).
  [[nodiscard]] Fields or_array(std::size_t min_size, std::size_t max_size) const;
  /// The keys that the values of the array belong to; empty without an array form.
  [[nodiscard]] std::vector<std::string_view> array_keys() const;
};

namespace detail {

template <typename T>
const T& defaults() {
  static const T kDefaults{};
  return kDefaults;
}

/// Throws Error{internal} if a table declares another type than a member has.
void require_same(const std::type_info& declared, const std::type_info& actual, std::string_view what);

/// The table with the members that depend on the type T. Throws like `require_same` if it contains a field of
/// another struct.
template <typename T>
Fields completed(Fields table) {
  for (const Field& field : table.fields) require_same(*field.owner, typeid(T), table.name);
  table.defaults = &defaults<T>();
  table.where = [](void* instance) { return where_of(*static_cast<T*>(instance)); };
  return table;
}

// Defined in the source file: moved here, GCC warns of alternatives that are not set.
[[nodiscard]] std::shared_ptr<const FieldContent> content(ValueType&& type);
[[nodiscard]] std::shared_ptr<const FieldContent> content(OneOf&& group);
[[nodiscard]] std::shared_ptr<const FieldContent> content(Inlined inlined);

template <typename T, typename M>
Field make_field(std::string_view key, std::shared_ptr<const FieldContent> content, std::string_view text,
                 M T::*member) {
  const T& instance = defaults<T>();
  const auto offset =
      reinterpret_cast<const char*>(&(instance.*member)) - reinterpret_cast<const char*>(&instance);
  return {key, std::move(content), text, MemberAccess<M>::kPresence, offset, access<M>(), &typeid(T)};
}

template <typename V, typename A>
Alternative alternative(ValueType type) {
  require_same(*type.cpp_type, typeid(ValueOf<A>), "an alternative");
  return {std::make_shared<const ValueType>(std::move(type)),
          [](void* variant, const SourcePosition& where) -> void* {
            return open_at(static_cast<V*>(variant)->template emplace<A>(), where);
          },
          [](const void* variant) -> const void* {
            const A* value = std::get_if<A>(static_cast<const V*>(variant));
            return value ? MemberAccess<A>::get(*value) : nullptr;
          }};
}

/// A choice or form whose variant is not known yet.
template <typename A>
struct LooseChoice {
  std::string_view key;
  ValueType type;
  std::string_view text;
  bool nested;
};
template <typename A>
struct LooseForm {
  Json json;
  std::vector<std::string_view> keys;
  ValueType type;
};

template <typename T, typename V, typename... A>
Field group(V T::*member, bool required, std::string_view conflict, LooseChoice<A>... choice) {
  return make_field("",
                    content(OneOf{required,
                                  conflict,
                                  {Choice{choice.key, choice.text, choice.nested,
                                          alternative<V, A>(std::move(choice.type))}...},
                                  [](void* variant) { static_cast<V*>(variant)->template emplace<0>(); }}),
                    "", member);
}

}  // namespace detail

/// The field table of T, built at the first call and valid until the program ends. Thread-safe. Throws
/// Error{internal} if the table contains a field of another struct.
template <typename T>
[[nodiscard]] const Fields& fields_of() {
  static const Fields kFields = detail::completed<T>(fields(Tag<T>{}));
  return kFields;
}

// The argument `what` of the functions below names the value in errors: an enumeration's, such as "filter",
// or the elements of a container, such as "layers". A `Range` applies to each number.

/// An enum E whose values 0, 1, 2 … are written as `names`. If `accepts_numbers`, the number 4 may replace
/// the name "4".
template <typename E>
[[nodiscard]] ValueType enumeration(std::string_view what, std::vector<const char*> names,
                                    bool accepts_numbers = false) {
  return {
      Enumeration{what, std::move(names), accepts_numbers,
                  [](void* value, std::size_t to) { *static_cast<E*>(value) = static_cast<E>(to); },
                  [](const void* value) { return static_cast<std::size_t>(*static_cast<const E*>(value)); }},
      &typeid(E)};
}
/// A fixed-size array or vector V of numbers, each within `range`, written as an array of that length.
/// `nonzero` excludes the zero vector.
template <typename V>
[[nodiscard]] ValueType vector(Range range, bool nonzero = false) {
  using Number = std::remove_cvref_t<decltype(std::declval<V&>()[0])>;
  return {Vector{sizeof(V) / sizeof(Number), range, nonzero, std::is_integral_v<Number>,
                 [](void* value, std::size_t i, double to) {
                   (&(*static_cast<V*>(value))[0])[i] = static_cast<Number>(to);
                 },
                 [](const void* value, std::size_t i) {
                   return static_cast<double>((&(*static_cast<const V*>(value))[0])[i]);
                 }},
          &typeid(V)};
}
/// An object with the field table of T.
template <typename T>
[[nodiscard]] ValueType structure() {
  return {Struct{fields_of<T>}, &typeid(T)};
}
/// A std::vector<T> of at least `min_size` elements of the type `element`. If `allows_single`, one element
/// may be written without brackets.
template <typename T>
[[nodiscard]] ValueType list(ValueType element, std::string_view what, std::size_t min_size,
                             bool allows_single = false) {
  using L = std::vector<T>;
  detail::require_same(*element.cpp_type, typeid(detail::ValueOf<T>), what);
  return {List{std::make_shared<const ValueType>(std::move(element)), what, min_size, allows_single,
               [](void* l, std::size_t count) { static_cast<L*>(l)->reserve(count); },
               [](void* l, const SourcePosition& where) -> void* {
                 return detail::open_at(static_cast<L*>(l)->emplace_back(), where);
               },
               [](const void* l) { return static_cast<const L*>(l)->size(); },
               [](const void* l, std::size_t i) -> const void* {
                 return detail::MemberAccess<T>::get((*static_cast<const L*>(l))[i]);
               }},
          &typeid(L)};
}
/// A std::vector of `Named<T>`, written as an object with at least `min_size` names that the user chooses, in
/// its order. `element` is the type of its values.
template <typename T>
[[nodiscard]] ValueType by_name(ValueType element, std::string_view what, std::size_t min_size) {
  using L = std::vector<Named<T>>;
  detail::require_same(*element.cpp_type, typeid(detail::ValueOf<T>), what);
  return {ByName{std::make_shared<const ValueType>(std::move(element)), what, min_size,
                 [](void* l, const std::string& name, const SourcePosition& where) -> void* {
                   Named<T>& named = static_cast<L*>(l)->emplace_back();
                   named.name = name;
                   named.where = where;
                   return detail::open_at(named.value, where);
                 },
                 [](const void* l) { return static_cast<const L*>(l)->size(); },
                 [](const void* l, std::size_t i) -> const void* {
                   return detail::MemberAccess<T>::get((*static_cast<const L*>(l))[i].value);
                 },
                 [](const void* l, std::size_t i) -> const std::string& {
                   return (*static_cast<const L*>(l))[i].name;
                 }},
          &typeid(L)};
}

/// A V within a range: a number, an integer, or a vector or list of numbers that all are.
template <typename V>
[[nodiscard]] ValueType within(Range range) {
  if constexpr (std::is_same_v<V, double>)
    return {Number{range}, &typeid(V)};
  else if constexpr (std::is_same_v<V, std::vector<double>>)
    return {Numbers{range}, &typeid(V)};
  else if constexpr (std::is_integral_v<V>)
    return {
        Integer{range, [](void* value, std::int64_t to) { *static_cast<V*>(value) = static_cast<V>(to); },
                [](const void* value) { return static_cast<std::int64_t>(*static_cast<const V*>(value)); }},
        &typeid(V)};
  else
    return vector<V>(range);
}

/// The value type that V implies: a bool, a string, the result of `value_type(Tag<V>)`, or a struct.
template <typename V>
[[nodiscard]] ValueType value_type_of() {
  if constexpr (std::is_same_v<V, bool>)
    return {Boolean{}, &typeid(V)};
  else if constexpr (std::is_same_v<V, std::string>)
    return {Text{}, &typeid(V)};
  else if constexpr (requires { value_type(Tag<V>{}); })
    return value_type(Tag<V>{});
  else
    return structure<V>();
}

// Overloads for elements of the type that T implies (`value_type_of`).
template <typename T>
[[nodiscard]] ValueType list(std::string_view what, std::size_t min_size, bool allows_single = false) {
  return list<T>(value_type_of<detail::ValueOf<T>>(), what, min_size, allows_single);
}
template <typename T>
[[nodiscard]] ValueType by_name(std::string_view what, std::size_t min_size) {
  return by_name<T>(value_type_of<detail::ValueOf<T>>(), what, min_size);
}

/// A number, or an array of numbers.
template <typename V>
concept Numeric = std::is_arithmetic_v<V> || requires(V v) {
  requires std::is_arithmetic_v<std::remove_cvref_t<decltype(v[0])>>;
};

/// A value type or a range, as an argument of table entries. A range is for numeric members only.
struct TypeOrRange {
  std::variant<Range, ValueType> value;

  TypeOrRange(Range range) : value(range) {}
  TypeOrRange(double low, double high, bool open_low = false, bool open_high = false)
      : value(Range{low, high, open_low, open_high}) {}
  TypeOrRange(ValueType type) : value(std::move(type)) {}

  /// The value type for a V: the given one, or `within` the range. Throws std::bad_variant_access for a range
  /// and a V that is not numeric.
  template <typename V>
  [[nodiscard]] ValueType as() const {
    if constexpr (Numeric<V>)
      if (const auto* range = std::get_if<Range>(&value)) return within<V>(*range);
    return std::get<ValueType>(value);
  }
};

/// The alternative A of a variant, written as a value of the JSON type `json`. `value` is the type or range
/// of A; without it A implies the type. If `keys` are given, an object must have one of them to select A.
template <typename A>
[[nodiscard]] detail::LooseForm<A> form(Json json, const TypeOrRange& value) {
  return {json, {}, value.as<detail::ValueOf<A>>()};
}
template <typename A>
[[nodiscard]] detail::LooseForm<A> form(Json json, std::vector<std::string_view> keys = {}) {
  return {json, std::move(keys), value_type_of<detail::ValueOf<A>>()};
}
/// A variant V whose alternative is the first one in `form` that the JSON value fits. `name` is its
/// definition in the JSON schema, or empty. Errors call it `expected`, such as "a curve: a number or a name".
template <typename V, typename... A>
[[nodiscard]] ValueType forms(std::string_view name, std::string_view expected,
                              detail::LooseForm<A>... form) {
  return {Forms{name,
                expected,
                {Form{form.json, std::move(form.keys), detail::alternative<V, A>(std::move(form.type))}...}},
          &typeid(V)};
}

/// The alternative A of a variant as the value of its own `key`. `value` is the type or range of A; without
/// it A implies the type. `text` is the meaning; if empty, that of the struct A.
template <typename A>
[[nodiscard]] detail::LooseChoice<A> under(std::string_view key, const TypeOrRange& value,
                                           std::string_view text) {
  return {key, value.as<detail::ValueOf<A>>(), text, true};
}
template <typename A>
[[nodiscard]] detail::LooseChoice<A> under(std::string_view key, std::string_view text = {}) {
  return {key, value_type_of<detail::ValueOf<A>>(), text, true};
}
/// The alternative A of a variant, a struct with its fields in the surrounding object. The presence of `key`,
/// which is one of them, selects it.
template <typename A>
[[nodiscard]] detail::LooseChoice<A> inlined_by(std::string_view key) {
  return {key, structure<A>(), {}, false};
}

/// A member with a key. The key is required unless the member is a std::optional. `value` is the type or
/// range of the member; without it the member implies the type.
template <typename T, typename M>
[[nodiscard]] Field field(std::string_view key, M T::*member, const TypeOrRange& value,
                          std::string_view text) {
  ValueType type = value.as<detail::ValueOf<M>>();
  detail::require_same(*type.cpp_type, typeid(detail::ValueOf<M>), key);
  return detail::make_field(key, detail::content(std::move(type)), text, member);
}
template <typename T, typename M>
[[nodiscard]] Field field(std::string_view key, M T::*member, std::string_view text = {}) {
  return field(key, member, value_type_of<detail::ValueOf<M>>(), text);
}
/// A member with an optional key; the other arguments are those of `field`. Without the key the member is
/// unchanged.
template <typename T, typename M>
[[nodiscard]] Field defaulted(std::string_view key, M T::*member, const TypeOrRange& value,
                              std::string_view text) {
  return field(key, member, value, text).with(Presence::optional);
}
template <typename T, typename M>
[[nodiscard]] Field defaulted(std::string_view key, M T::*member, std::string_view text) {
  return field(key, member, text).with(Presence::optional);
}
/// A member that is a struct, with its fields in the same object.
template <typename T, typename M>
[[nodiscard]] Field inlined(M T::*member) {
  return detail::make_field("", detail::content(Inlined{fields_of<M>}), "", member);
}
/// A group of keys, exactly one of which is present. The member is a variant of std::monostate, which is
/// first, and the alternatives. `choice` are results of `under` and `inlined_by`.
template <typename T, typename V, typename... A>
[[nodiscard]] Field one_of(V T::*member, detail::LooseChoice<A>... choice) {
  return detail::group(member, true, "", std::move(choice)...);
}
/// A group of keys, at most one of which is present. `conflict` is the error for two; if it is empty, the
/// error lists the allowed keys. The member is a variant as for `one_of`; without a key it is std::monostate.
template <typename T, typename V, typename... A>
[[nodiscard]] Field at_most_one(V T::*member, std::string_view conflict, detail::LooseChoice<A>... choice) {
  return detail::group(member, false, conflict, std::move(choice)...);
}

/// Builds a field table; the arguments are the members of `Fields` of these names.
[[nodiscard]] Fields describe(std::string_view name, std::string_view text, std::vector<Field> fields,
                              std::vector<std::string_view> any_of = {}, bool exclusive = false);

}  // namespace abbe::schema
