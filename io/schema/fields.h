#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/schema/held.h"
#include "io/schema/kind.h"

// The declarative tables of a user's file. A thing is a plain struct whose members hold its defaults; beside
// it stands its table,
//
//   Fields fields(Tag<Disc>) {
//     return describe("disc", "A flat disc.",
//                     {field("center", &Disc::center, point(), "Its middle."),
//                      field("radius", &Disc::radius, kLength, "Its radius.")});
//   }
//
// from which `read`, `write`, `json_schema` and the guide work. Of a member whose type says all, such as a
// bool, a string, a thing, or a type V with a `Kind kind(Tag<V>)` beside it, no kind is said.
namespace abbe::schema {

/// Chooses the table of a thing: `fields(Tag<Disc>{})`.
template <typename T>
struct Tag {};

/// A value under a key, a group of keys, or the fields of another thing.
using Part = std::variant<Kind, OneOf, Lent>;

/// One key of a thing, or one group of keys.
struct Field {
  std::string_view key;  ///< Empty unless a value stands under it.
  std::shared_ptr<const Part> part;
  std::string_view
      text;  ///< What it means, as a whole sentence; empty where that of the thing it holds does.
  Presence presence;
  std::ptrdiff_t offset;  ///< Of the member in its thing.
  Holder holder;
  const std::type_info* owner;

  [[nodiscard]] void* member(void* thing) const { return static_cast<char*>(thing) + offset; }
  [[nodiscard]] const void* look(const void* thing) const {
    return holder.look(static_cast<const char*>(thing) + offset);
  }
  /// The same, but for whether it must be there.
  [[nodiscard]] Field with(Presence other) const;
};

/// A list that may stand in the place of a thing's object: the values of its first keys, of so many at least
/// and at most, null where a key is not said.
struct Row {
  std::size_t least;
  std::size_t most;
};

/// The table of a thing.
struct Fields {
  std::string_view name;  ///< That of a definition of the JSON schema.
  std::string_view text;  ///< What it is, as a whole sentence.
  std::vector<Field> fields;
  /// Keys, or paths of keys ("sun/irradiance"), one of which must be there; the first is asked for.
  std::vector<std::string_view> any_of = {};
  bool exclusive = false;       ///< Whether no two of them may be there.
  std::optional<Row> row = {};  ///< Of keys alone, each of which may be absent.
  // What the type of the thing tells.
  const void* defaults = nullptr;                   ///< A thing as its members' initialisers make it.
  SourcePosition* (*where)(void* thing) = nullptr;  ///< Where it keeps its place, nullptr when it does not.

  /// The same table of a thing that may be written as a row.
  [[nodiscard]] Fields or_row(std::size_t least, std::size_t most) const;
  /// The keys of the row.
  [[nodiscard]] std::vector<std::string_view> row_keys() const;
};

namespace detail {

template <typename T>
const T& defaults() {
  static const T kDefaults{};
  return kDefaults;
}

/// Throws Error{internal} where a table is wrong about the type of a member.
void require_same(const std::type_info& said, const std::type_info& is, std::string_view what);

/// The table with what the type T tells; throws as `require_same` for the field of another thing.
template <typename T>
Fields completed(Fields table) {
  for (const Field& field : table.fields) require_same(*field.owner, typeid(T), table.name);
  table.defaults = &defaults<T>();
  table.where = [](void* thing) { return where_of(*static_cast<T*>(thing)); };
  return table;
}

// Not in line, where the compiler loses its way among the alternatives.
[[nodiscard]] std::shared_ptr<const Part> part(Kind&& kind);
[[nodiscard]] std::shared_ptr<const Part> part(OneOf&& group);
[[nodiscard]] std::shared_ptr<const Part> part(Lent lent);

template <typename T, typename M>
Field make_field(std::string_view key, std::shared_ptr<const Part> part, std::string_view text,
                 M T::*member) {
  const T& thing = defaults<T>();
  const auto offset = reinterpret_cast<const char*>(&(thing.*member)) - reinterpret_cast<const char*>(&thing);
  return {key, std::move(part), text, Held<M>::kPresence, offset, holder<M>(), &typeid(T)};
}

template <typename V, typename A>
Alternative alternative(Kind kind) {
  require_same(*kind.type, typeid(ValueOf<A>), "an alternative");
  return {std::make_shared<const Kind>(std::move(kind)),
          [](void* variant, const SourcePosition& where) -> void* {
            return open_at(static_cast<V*>(variant)->template emplace<A>(), where);
          },
          [](const void* variant) -> const void* {
            const A* held = std::get_if<A>(static_cast<const V*>(variant));
            return held ? Held<A>::look(*held) : nullptr;
          }};
}

/// A choice or form before it is known whose alternative it is.
template <typename A>
struct LooseChoice {
  std::string_view key;
  Kind kind;
  std::string_view text;
  bool inside;
};
template <typename A>
struct LooseForm {
  Json json;
  std::vector<std::string_view> keys;
  Kind kind;
};

template <typename T, typename V, typename... A>
Field group(V T::*member, bool required, std::string_view several, LooseChoice<A>... choice) {
  return make_field("",
                    part(OneOf{required,
                               several,
                               {Choice{choice.key, choice.text, choice.inside,
                                       alternative<V, A>(std::move(choice.kind))}...},
                               [](void* variant) { static_cast<V*>(variant)->template emplace<0>(); }}),
                    "", member);
}

}  // namespace detail

/// What the table of T says.
template <typename T>
[[nodiscard]] const Fields& fields_of() {
  static const Fields kFields = detail::completed<T>(fields(Tag<T>{}));
  return kFields;
}

template <typename E>
[[nodiscard]] Kind word(std::string_view what, std::vector<const char*> names, bool numbers = false) {
  return {Word{what, std::move(names), numbers,
               [](void* value, std::size_t to) { *static_cast<E*>(value) = static_cast<E>(to); },
               [](const void* value) { return static_cast<std::size_t>(*static_cast<const E*>(value)); }},
          &typeid(E)};
}
/// As many numbers as V holds: an array or a vector of geometry.
template <typename V>
[[nodiscard]] Kind vector(Range range, bool direction = false) {
  using Number = std::remove_cvref_t<decltype(std::declval<V&>()[0])>;
  return {Vector{sizeof(V) / sizeof(Number), range, direction, std::is_integral_v<Number>,
                 [](void* value, std::size_t i, double to) {
                   (&(*static_cast<V*>(value))[0])[i] = static_cast<Number>(to);
                 },
                 [](const void* value, std::size_t i) {
                   return static_cast<double>((&(*static_cast<const V*>(value))[0])[i]);
                 }},
          &typeid(V)};
}
template <typename T>
[[nodiscard]] Kind thing() {
  return {Thing{fields_of<T>}, &typeid(T)};
}
template <typename T>
[[nodiscard]] Kind list(Kind element, std::string_view what, std::size_t least, bool bare = false) {
  using L = std::vector<T>;
  detail::require_same(*element.type, typeid(detail::ValueOf<T>), what);
  return {List{std::make_shared<const Kind>(std::move(element)), what, least, bare,
               [](void* l, std::size_t count) { static_cast<L*>(l)->reserve(count); },
               [](void* l, const SourcePosition& where) -> void* {
                 return detail::open_at(static_cast<L*>(l)->emplace_back(), where);
               },
               [](const void* l) { return static_cast<const L*>(l)->size(); },
               [](const void* l, std::size_t i) -> const void* {
                 return detail::Held<T>::look((*static_cast<const L*>(l))[i]);
               }},
          &typeid(L)};
}
/// A std::vector of `Named<T>`.
template <typename T>
[[nodiscard]] Kind by_name(Kind element, std::string_view what, std::size_t least) {
  using L = std::vector<Named<T>>;
  detail::require_same(*element.type, typeid(detail::ValueOf<T>), what);
  return {ByName{std::make_shared<const Kind>(std::move(element)), what, least,
                 [](void* l, const std::string& name, const SourcePosition& where) -> void* {
                   Named<T>& named = static_cast<L*>(l)->emplace_back();
                   named.name = name;
                   named.where = where;
                   return detail::open_at(named.value, where);
                 },
                 [](const void* l) { return static_cast<const L*>(l)->size(); },
                 [](const void* l, std::size_t i) -> const void* {
                   return detail::Held<T>::look((*static_cast<const L*>(l))[i].value);
                 },
                 [](const void* l, std::size_t i) -> const std::string& {
                   return (*static_cast<const L*>(l))[i].name;
                 }},
          &typeid(L)};
}

/// A V in that range: a number, an integer, or a point or list of numbers which are.
template <typename V>
[[nodiscard]] Kind within(Range range) {
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

/// What a V is when no more is said: a bool, a string, what `kind(Tag<V>)` says, or a thing.
template <typename V>
[[nodiscard]] Kind kind_of() {
  if constexpr (std::is_same_v<V, bool>)
    return {Boolean{}, &typeid(V)};
  else if constexpr (std::is_same_v<V, std::string>)
    return {Text{}, &typeid(V)};
  else if constexpr (requires { kind(Tag<V>{}); })
    return kind(Tag<V>{});
  else
    return thing<V>();
}

template <typename T>
[[nodiscard]] Kind list(std::string_view what, std::size_t least, bool bare = false) {
  return list<T>(kind_of<detail::ValueOf<T>>(), what, least, bare);
}
template <typename T>
[[nodiscard]] Kind by_name(std::string_view what, std::size_t least) {
  return by_name<T>(kind_of<detail::ValueOf<T>>(), what, least);
}

/// A number, or several.
template <typename V>
concept Numeric = std::is_arithmetic_v<V> || requires(V v) {
  requires std::is_arithmetic_v<std::remove_cvref_t<decltype(v[0])>>;
};

/// What a table says of a value: its kind or its range.
struct Saying {
  std::variant<Range, Kind> said;

  Saying(Range range) : said(range) {}
  Saying(double low, double high, bool open_low = false, bool open_high = false)
      : said(Range{low, high, open_low, open_high}) {}
  Saying(Kind kind) : said(std::move(kind)) {}

  template <typename V>
  [[nodiscard]] Kind of() const {
    if constexpr (Numeric<V>)
      if (const auto* range = std::get_if<Range>(&said)) return within<V>(*range);
    return std::get<Kind>(said);
  }
};

/// The alternative A of a variant, written as that type of JSON; objects perhaps only with one of `keys`.
template <typename A>
[[nodiscard]] detail::LooseForm<A> form(Json json, const Saying& said) {
  return {json, {}, said.of<detail::ValueOf<A>>()};
}
template <typename A>
[[nodiscard]] detail::LooseForm<A> form(Json json, std::vector<std::string_view> keys = {}) {
  return {json, std::move(keys), kind_of<detail::ValueOf<A>>()};
}
/// A variant V that is told by how it is written; `name` is that of its definition in the JSON schema, if it
/// is to have one, and errors say that it is `expected`.
template <typename V, typename... A>
[[nodiscard]] Kind forms(std::string_view name, std::string_view expected, detail::LooseForm<A>... form) {
  return {Forms{name,
                expected,
                {Form{form.json, std::move(form.keys), detail::alternative<V, A>(std::move(form.kind))}...}},
          &typeid(V)};
}

/// The alternative A of a variant under a key of its own.
template <typename A>
[[nodiscard]] detail::LooseChoice<A> under(std::string_view key, const Saying& said, std::string_view text) {
  return {key, said.of<detail::ValueOf<A>>(), text, true};
}
template <typename A>
[[nodiscard]] detail::LooseChoice<A> under(std::string_view key, std::string_view text = {}) {
  return {key, kind_of<detail::ValueOf<A>>(), text, true};
}
/// The alternative A of a variant as fields of the same object, told by the one of them under `key`.
template <typename A>
[[nodiscard]] detail::LooseChoice<A> beside(std::string_view key) {
  return {key, thing<A>(), {}, false};
}

/// The member under a key. It must be there unless the member is optional.
template <typename T, typename M>
[[nodiscard]] Field field(std::string_view key, M T::*member, const Saying& said, std::string_view text) {
  Kind kind = said.of<detail::ValueOf<M>>();
  detail::require_same(*kind.type, typeid(detail::ValueOf<M>), key);
  return detail::make_field(key, detail::part(std::move(kind)), text, member);
}
template <typename T, typename M>
[[nodiscard]] Field field(std::string_view key, M T::*member, std::string_view text = {}) {
  return field(key, member, kind_of<detail::ValueOf<M>>(), text);
}
/// The same that may be absent: then the member's initialiser holds.
template <typename T, typename M>
[[nodiscard]] Field defaulted(std::string_view key, M T::*member, const Saying& said, std::string_view text) {
  return field(key, member, said, text).with(Presence::optional);
}
template <typename T, typename M>
[[nodiscard]] Field defaulted(std::string_view key, M T::*member, std::string_view text) {
  return field(key, member, text).with(Presence::optional);
}
/// The fields of a member that is a thing, in the same object.
template <typename T, typename M>
[[nodiscard]] Field lent(M T::*member) {
  return detail::make_field("", detail::part(Lent{fields_of<M>}), "", member);
}
/// Keys of which exactly one is there; the member is a variant of std::monostate and their alternatives.
template <typename T, typename V, typename... A>
[[nodiscard]] Field one_of(V T::*member, detail::LooseChoice<A>... choice) {
  return detail::group(member, true, "", std::move(choice)...);
}
/// Keys of which one at most is there; `several` says what is wrong with two.
template <typename T, typename V, typename... A>
[[nodiscard]] Field at_most_one(V T::*member, std::string_view several, detail::LooseChoice<A>... choice) {
  return detail::group(member, false, several, std::move(choice)...);
}

/// The table of a thing. Its name is that of a definition of the JSON schema.
[[nodiscard]] Fields describe(std::string_view name, std::string_view text, std::vector<Field> fields,
                              std::vector<std::string_view> any_of = {}, bool exclusive = false);

}  // namespace abbe::schema
