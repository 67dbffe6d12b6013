#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "io/diagnostics.h"

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

/// Type-erased access to the value of a member, whose address is the argument. The value may be in a wrapper,
/// an optional or a shared pointer.
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
