#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/json.h"

namespace abbe {

/// Largest magnitude of a number that `read_number` accepts: values are used in single precision.
inline constexpr double kLargestFloat = std::numeric_limits<float>::max();
/// Largest magnitude of an integer: 2^53 - 1, up to which integers are exact in double.
inline constexpr double kLargestInteger = 9007199254740991;

/// An interval of allowed numbers; NaN is outside every interval.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool open_low = false;   ///< True if `low` itself is excluded.
  bool open_high = false;  ///< True if `high` itself is excluded.
  /// Unit of the numbers, such as "nm", for the guide; may be empty. Must outlive the range.
  std::string_view unit_name = {};

  [[nodiscard]] bool contains(double x) const;
  /// The interval in errors, such as "(0, 180)" or "[0, inf)". The unit is not included.
  [[nodiscard]] std::string text() const;

  /// This interval with the unit `of`.
  [[nodiscard]] constexpr Range in(std::string_view of) const { return {low, high, open_low, open_high, of}; }

  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return {0, std::numeric_limits<double>::max(), true, false}; }
  static constexpr Range non_negative() { return {0, std::numeric_limits<double>::max(), false, false}; }
  static constexpr Range unit() { return {0, 1, false, false}; }
};

/// Read a single value of a given type. A mismatch is reported at the value with the code `scene`, as
/// `expected <type> (got <type or value>, allowed <range>)`; nothing is returned then. `read_number` also
/// rejects magnitudes above kLargestFloat, `read_integer` fractions and magnitudes above kLargestInteger.
[[nodiscard]] std::optional<double> read_number(const JsonValue& value, Range allowed,
                                                Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::int64_t> read_integer(const JsonValue& value, Range allowed,
                                                       Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::string> read_string(const JsonValue& value, Diagnostics& diagnostics);
/// Index of the string `value` among `names`, case-sensitive. Reports any other string as an unknown `kind`,
/// with the nearest name.
[[nodiscard]] std::optional<std::size_t> read_choice(const JsonValue& value, std::string_view kind,
                                                     std::span<const char* const> names,
                                                     Diagnostics& diagnostics);
[[nodiscard]] std::optional<bool> read_boolean(const JsonValue& value, Diagnostics& diagnostics);
/// Reads an array of numbers, each as by `read_number`. Reports every wrong element, and any other length
/// than `count`; a `count` of 0 accepts every length, also none. Nothing after an error.
[[nodiscard]] std::optional<std::vector<double>> read_numbers(const JsonValue& value, std::size_t count,
                                                              Range allowed, Diagnostics& diagnostics);

/// The elements of an array with `min_size` elements or more. Reports anything else, calling the elements
/// `what`, and returns nullptr.
[[nodiscard]] const JsonValue::Array* read_array(const JsonValue& value, std::string_view what,
                                                 std::size_t min_size, Diagnostics& diagnostics);
/// The members of an object. Reports anything else and returns nullptr.
[[nodiscard]] const JsonValue::Object* read_object(const JsonValue& value, Diagnostics& diagnostics);
/// The only one of `keys` that `object` has. Reports if it has none, a misspelt one or several. Nothing,
/// without a report, if `object` is not an object.
[[nodiscard]] std::optional<std::string_view> choose_key(const JsonValue& object,
                                                         std::span<const std::string_view> keys,
                                                         Diagnostics& diagnostics);

}  // namespace abbe
