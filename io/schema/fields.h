#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "io/schema/kind.h"

// The declarative tables of a user's file. A thing is a plain struct whose members hold its defaults; beside
// it stands its table,
//
//   const Fields& fields(Tag<Disc>) {
//     static const Fields kFields = describe<Disc>("disc", "A flat disc.", {
//         field("center", &Disc::center, vector<Imath::V3d>(kCoordinate), "Its middle."),
//         field("radius", &Disc::radius, number(kLength), "Its radius."),
//     });
//     return kFields;
//   }
//
// from which `read`, `write`, `json_schema`, `guide` and `help` work.
namespace abbe::schema {

/// Chooses the table of a thing: `fields(Tag<Disc>{})`.
template <typename T>
struct Tag {};

/// What holds a value only: a type of its own derives from it, so that a variant can tell two lengths apart.
template <typename T>
struct Value {
  using Wrapped = T;
  T value{};
};
/// A value with its place, for complaints that come later. A thing may have a member `where` instead.
template <typename T>
struct Located : Value<T> {
  SourcePosition where{};
};
/// A value under a name that the user chose.
template <typename T>
struct Named {
  std::string name;
  T value{};
  SourcePosition where{};
};

/// How a member holds its value: `open` makes room for one, `look` gives nullptr when there is none, `close`
/// takes it away again after an error.
struct Holder {
  void* (*open)(void* member);
  const void* (*look)(const void* member);
  void (*close)(void* member);
  SourcePosition* (*where)(void* member);  ///< Where it keeps the place, nullptr when it does not.
};

/// Whether a key must be there.
enum class Presence { required, optional };

/// A value under a key, a group of keys, or the fields of another thing.
using Part = std::variant<Kind, OneOf, Lent>;

/// One key of a thing, or one group of keys.
struct Field {
  std::string_view key;  ///< Empty unless a value stands under it.
  std::shared_ptr<const Part> part;
  std::string_view text;  ///< What it means, as a whole sentence.
  Presence presence;
  std::ptrdiff_t offset;  ///< Of the member in its thing.
  Holder holder;
  const std::type_info* owner;

  [[nodiscard]] void* member(void* thing) const { return static_cast<char*>(thing) + offset; }
  [[nodiscard]] const void* look(const void* thing) const {
    return holder.look(static_cast<const char*>(thing) + offset);
  }
  /// The same, which may be absent: then the member's initialiser holds.
  [[nodiscard]] Field or_default() const;
  /// The same, which must be there though the member could be without.
  [[nodiscard]] Field required() const;
};

/// The table of a thing.
struct Fields {
  std::string_view name;
  std::string_view text;  ///< What it is, as a whole sentence.
  std::vector<Field> fields;
  const void* defaults;                       ///< A thing as its members' initialisers make it.
  SourcePosition* (*where)(void* thing);      ///< Where it keeps its place, nullptr when it does not.
  std::vector<std::string_view> any_of = {};  ///< Keys one of which must be there; the first is asked for.
};

namespace detail {

template <typename M>
struct Held {
  using Value = M;
  static Value* open(M& member) { return &member; }
  static const Value* look(const M& member) { return &member; }
  static void close(M&) {}
  static SourcePosition* where(M&) { return nullptr; }
  static constexpr Presence kPresence = Presence::required;
};
template <typename M>
requires requires {
  typename M::Wrapped;
}
struct Held<M> {
  using Value = typename M::Wrapped;
  static Value* open(M& member) { return &member.value; }
  static const Value* look(const M& member) { return &member.value; }
  static void close(M&) {}
  static SourcePosition* where(M& member) {
    if constexpr (requires { member.where; })
      return &member.where;
    else
      return nullptr;
  }
  static constexpr Presence kPresence = Presence::required;
};
template <typename M>
struct Held<std::optional<M>> {
  using Value = typename Held<M>::Value;
  static Value* open(std::optional<M>& member) { return Held<M>::open(member.emplace()); }
  static const Value* look(const std::optional<M>& member) {
    return member ? Held<M>::look(*member) : nullptr;
  }
  static void close(std::optional<M>& member) { member.reset(); }
  static SourcePosition* where(std::optional<M>& member) {
    return member ? Held<M>::where(*member) : nullptr;
  }
  static constexpr Presence kPresence = Presence::optional;
};

template <typename M>
struct Held<std::shared_ptr<M>> {
  using Value = typename Held<M>::Value;
  static Value* open(std::shared_ptr<M>& member) { return Held<M>::open(*(member = std::make_shared<M>())); }
  static const Value* look(const std::shared_ptr<M>& member) {
    return member ? Held<M>::look(*member) : nullptr;
  }
  static void close(std::shared_ptr<M>& member) { member.reset(); }
  static SourcePosition* where(std::shared_ptr<M>& member) {
    return member ? Held<M>::where(*member) : nullptr;
  }
  static constexpr Presence kPresence = Presence::required;
};

/// Makes room for a value that stands there.
template <typename M>
void* open_at(M& member, const SourcePosition& where) {
  void* value = Held<M>::open(member);
  if (SourcePosition* kept = Held<M>::where(member)) *kept = where;
  return value;
}

template <typename M>
Holder holder() {
  using H = Held<M>;
  return {[](void* m) -> void* { return H::open(*static_cast<M*>(m)); },
          [](const void* m) -> const void* { return H::look(*static_cast<const M*>(m)); },
          [](void* m) { H::close(*static_cast<M*>(m)); },
          [](void* m) { return H::where(*static_cast<M*>(m)); }};
}

template <typename T>
const T& defaults() {
  static const T kDefaults{};
  return kDefaults;
}

/// Throws Error{internal} where a table is wrong about the type of a member.
void require_same(const std::type_info& said, const std::type_info& is, std::string_view what);

template <typename T, typename M>
std::ptrdiff_t offset(M T::*member) {
  const T& thing = defaults<T>();
  return reinterpret_cast<const char*>(&(thing.*member)) - reinterpret_cast<const char*>(&thing);
}

template <typename V, typename A>
Alternative alternative(Kind kind) {
  require_same(*kind.type, typeid(typename Held<A>::Value), "an alternative");
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

// Not in line, where the compiler loses its way among the alternatives.
[[nodiscard]] std::shared_ptr<const Part> part(Kind&& kind);
[[nodiscard]] std::shared_ptr<const Part> part(OneOf&& group);
[[nodiscard]] std::shared_ptr<const Part> part(Lent lent);

template <typename T, typename M>
[[nodiscard]] Field make_field(std::string_view key, std::shared_ptr<const Part> part, std::string_view text,
                               Presence presence, M T::*member) {
  return {key, std::move(part), text, presence, offset(member), holder<M>(), &typeid(T)};
}

template <typename V, typename... A>
OneOf group(bool required, std::string_view several, LooseChoice<A>... choice) {
  return {required,
          several,
          {Choice{choice.key, choice.text, choice.inside, alternative<V, A>(std::move(choice.kind))}...},
          [](void* variant) { static_cast<V*>(variant)->template emplace<0>(); }};
}

}  // namespace detail

/// What the table of T says.
template <typename T>
[[nodiscard]] const Fields& fields_of() {
  return fields(Tag<T>{});
}

[[nodiscard]] inline Kind number(Range range) {
  return {Number{range}, &typeid(double)};
}
template <typename I>
[[nodiscard]] Kind integer(Range range) {
  return {Integer{range, [](void* value, std::int64_t to) { *static_cast<I*>(value) = static_cast<I>(to); },
                  [](const void* value) { return static_cast<std::int64_t>(*static_cast<const I*>(value)); }},
          &typeid(I)};
}
[[nodiscard]] inline Kind boolean() {
  return {Boolean{}, &typeid(bool)};
}
[[nodiscard]] inline Kind text() {
  return {Text{}, &typeid(std::string)};
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
  using Index = std::conditional_t < requires(V v) {
    v.setValue(v);
  }
  , int, std::size_t > ;
  using Number = std::remove_cvref_t<decltype(std::declval<V&>()[Index{}])>;
  return {Vector{sizeof(V) / sizeof(Number), range, direction, std::is_integral_v<Number>,
                 [](void* value, std::size_t i, double to) {
                   (*static_cast<V*>(value))[static_cast<Index>(i)] = static_cast<Number>(to);
                 },
                 [](const void* value, std::size_t i) {
                   return static_cast<double>((*static_cast<const V*>(value))[static_cast<Index>(i)]);
                 }},
          &typeid(V)};
}
[[nodiscard]] inline Kind numbers(Range range) {
  return {Numbers{range}, &typeid(std::vector<double>)};
}
template <typename T>
[[nodiscard]] Kind thing() {
  return {Thing{fields_of<T>}, &typeid(T)};
}
template <typename T>
[[nodiscard]] Kind list(Kind element, std::string_view what, std::size_t least, bool bare = false) {
  using L = std::vector<T>;
  detail::require_same(*element.type, typeid(typename detail::Held<T>::Value), what);
  return {List{std::make_shared<const Kind>(std::move(element)), what, least, bare,
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
  detail::require_same(*element.type, typeid(typename detail::Held<T>::Value), what);
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

/// The alternative A of a variant, written as that type of JSON; objects perhaps only with one of `keys`.
template <typename A>
[[nodiscard]] detail::LooseForm<A> form(Json json, Kind kind, std::vector<std::string_view> keys = {}) {
  return {json, std::move(keys), std::move(kind)};
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
[[nodiscard]] detail::LooseChoice<A> under(std::string_view key, Kind kind, std::string_view text) {
  return {key, std::move(kind), text, true};
}
/// The alternative A of a variant as fields of the same object, told by the one of them under `key`.
template <typename A>
[[nodiscard]] detail::LooseChoice<A> beside(std::string_view key) {
  return {key, thing<A>(), {}, false};
}

/// The member under a key. It must be there unless the member is optional.
template <typename T, typename M>
[[nodiscard]] Field field(std::string_view key, M T::*member, Kind kind, std::string_view text) {
  detail::require_same(*kind.type, typeid(typename detail::Held<M>::Value), key);
  return detail::make_field(key, detail::part(std::move(kind)), text, detail::Held<M>::kPresence, member);
}
/// The fields of a member that is a thing, in the same object.
template <typename T, typename M>
[[nodiscard]] Field lent(M T::*member) {
  return detail::make_field("", detail::part(Lent{fields_of<M>}), "", Presence::required, member);
}
/// Keys of which exactly one is there; the member is a variant of std::monostate and their alternatives.
template <typename T, typename V, typename... A>
[[nodiscard]] Field one_of(V T::*member, detail::LooseChoice<A>... choice) {
  return detail::make_field("", detail::part(detail::group<V>(true, "", std::move(choice)...)), "",
                            Presence::required, member);
}
/// Keys of which one at most is there; `several` says what is wrong with two.
template <typename T, typename V, typename... A>
[[nodiscard]] Field at_most_one(V T::*member, std::string_view several, detail::LooseChoice<A>... choice) {
  return detail::make_field("", detail::part(detail::group<V>(false, several, std::move(choice)...)), "",
                            Presence::required, member);
}

/// The table of T. Its name is that of a definition of the JSON schema.
template <typename T>
[[nodiscard]] Fields describe(std::string_view name, std::string_view text, std::vector<Field> fields,
                              std::vector<std::string_view> any_of = {}) {
  for (const Field& field : fields) detail::require_same(*field.owner, typeid(T), name);
  return {name,
          text,
          std::move(fields),
          &detail::defaults<T>(),
          [](void* thing) -> SourcePosition* {
            if constexpr (requires(T t) { t.where; })
              return &static_cast<T*>(thing)->where;
            else
              return nullptr;
          },
          std::move(any_of)};
}

}  // namespace abbe::schema
