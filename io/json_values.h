#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/json.h"

namespace abbe {

/// The largest magnitude of a number, and of an integer: 2^53 - 1, up to which no two are read as one double.
inline constexpr double kLargestFloat = std::numeric_limits<float>::max();
inline constexpr double kLargestInteger = 9007199254740991;

/// The numbers a field accepts. `text()` is how an error names them, e.g. "(0, 180)" or "[0, inf)".
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool open_low = false;
  bool open_high = false;
  std::string_view measured_in = {};  ///< Of the numbers, for guides.

  [[nodiscard]] bool contains(double x) const;
  [[nodiscard]] std::string text() const;

  /// The same numbers in a unit.
  [[nodiscard]] constexpr Range in(std::string_view of) const { return {low, high, open_low, open_high, of}; }

  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return {0, std::numeric_limits<double>::max(), true, false}; }
  static constexpr Range non_negative() { return {0, std::numeric_limits<double>::max(), false, false}; }
  static constexpr Range unit() { return {0, 1, false, false}; }
};

/// Typed reading of single values; a mismatch is reported as `expected <type> (got <kind or value>, allowed
/// <range>)`.
[[nodiscard]] std::optional<double> read_number(const JsonValue& value, Range allowed,
                                                Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::int64_t> read_integer(const JsonValue& value, Range allowed,
                                                       Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::string> read_string(const JsonValue& value, Diagnostics& diagnostics);
/// The number of a string among `names`; another one is reported as an unknown `kind`.
[[nodiscard]] std::optional<std::size_t> read_choice(const JsonValue& value, std::string_view kind,
                                                     std::span<const char* const> names,
                                                     Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::size_t> read_choice(const JsonValue& value, std::string_view kind,
                                                     std::initializer_list<const char*> names,
                                                     Diagnostics& diagnostics);
[[nodiscard]] std::optional<bool> read_boolean(const JsonValue& value, Diagnostics& diagnostics);
/// An array of numbers, each in `allowed`; of exactly `count` of them unless `count` is 0.
[[nodiscard]] std::optional<std::vector<double>> read_numbers(const JsonValue& value, std::size_t count,
                                                              Range allowed, Diagnostics& diagnostics);

/// The elements of an array of `least` or more; anything else is reported, `what` naming them.
[[nodiscard]] const JsonValue::Array* read_array(const JsonValue& value, std::string_view what,
                                                 std::size_t least, Diagnostics& diagnostics);
/// The members of an object; anything else is reported.
[[nodiscard]] const JsonValue::Object* read_object(const JsonValue& value, Diagnostics& diagnostics);
/// The one of `keys` that an object has; none (or a misspelt one), or more than one, is reported.
[[nodiscard]] std::optional<std::string_view> choose_key(const JsonValue& object,
                                                         std::span<const std::string_view> keys,
                                                         Diagnostics& diagnostics);

}  // namespace abbe
