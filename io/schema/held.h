#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "io/diagnostics.h"

// How members of things hold their values.
namespace abbe::schema {

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

namespace detail {

template <typename M>
SourcePosition* where_of(M& member) {
  if constexpr (requires { member.where; })
    return &member.where;
  else
    return nullptr;
}

// A member that is its value, or wraps it.
template <typename M>
struct Held {
  static auto& value(auto& member) {
    if constexpr (requires { typename M::Wrapped; })
      return member.value;
    else
      return member;
  }
  using Value = std::remove_cvref_t<decltype(value(std::declval<M&>()))>;
  static Value* open(M& member) { return &value(member); }
  static const Value* look(const M& member) { return &value(member); }
  static void close(M&) {}
  static SourcePosition* where(M& member) {
    if constexpr (requires { typename M::Wrapped; })
      return where_of(member);
    else
      return nullptr;
  }
  static constexpr Presence kPresence = Presence::required;
};
// One that may be without a value: std::optional, or std::shared_ptr, which a thing needs to hold its like.
template <typename M>
requires requires(M m) {
  m.reset();
}
struct Held<M> {
  using Inner = std::remove_cvref_t<decltype(*std::declval<M&>())>;
  using Value = typename Held<Inner>::Value;
  static Value* open(M& member) {
    if constexpr (std::is_same_v<M, std::optional<Inner>>)
      member.emplace();
    else
      member = std::make_shared<Inner>();
    return Held<Inner>::open(*member);
  }
  static const Value* look(const M& member) { return member ? Held<Inner>::look(*member) : nullptr; }
  static void close(M& member) { member.reset(); }
  static SourcePosition* where(M& member) { return member ? Held<Inner>::where(*member) : nullptr; }
  static constexpr Presence kPresence =
      std::is_same_v<M, std::optional<Inner>> ? Presence::optional : Presence::required;
};

/// What a member of type M holds.
template <typename M>
using ValueOf = typename Held<M>::Value;

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

}  // namespace detail
}  // namespace abbe::schema
