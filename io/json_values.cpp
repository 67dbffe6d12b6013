#include "io/json_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace abbe {
namespace {

std::string bound(double x) {
  if (std::abs(x) == std::numeric_limits<double>::max()) return x < 0 ? "-inf" : "inf";
  return fmt::format("{}", x);
}

/// The value if it is short, otherwise its type.
std::string value_text(const JsonValue& value) {
  if (const auto* number = std::get_if<double>(&value.value)) return fmt::format("{}", *number);
  if (const auto* boolean = std::get_if<bool>(&value.value)) return *boolean ? "true" : "false";
  if (const auto* string = std::get_if<std::string>(&value.value))
    return string->size() <= 40 ? fmt::format("\"{}\"", *string) : "a long string";
  return std::string(value.type_name());
}

std::nullopt_t mismatch(const JsonValue& value, std::string_view expected, std::string_view allowed,
                        Diagnostics& diagnostics) {
  return diagnostics.refuse(
      value.where, fmt::format("expected {} (got {}, allowed {})", expected, value_text(value), allowed));
}

}  // namespace

bool Range::contains(double x) const {
  return (open_low ? x > low : x >= low) && (open_high ? x < high : x <= high);
}

std::string Range::text() const {
  const bool no_low = low == std::numeric_limits<double>::lowest();
  const bool no_high = high == std::numeric_limits<double>::max();
  return fmt::format("{}{}, {}{}", open_low || no_low ? '(' : '[', bound(low), bound(high),
                     open_high || no_high ? ')' : ']');
}

std::optional<double> read_number(const JsonValue& value, Range allowed, Diagnostics& diagnostics) {
  const auto* number = std::get_if<double>(&value.value);
  if (!number || !allowed.contains(*number)) return mismatch(value, "a number", allowed.text(), diagnostics);
  if (std::abs(*number) > kLargestFloat)
    return mismatch(value, "a number of single precision", fmt::format("magnitudes to {:.6g}", kLargestFloat),
                    diagnostics);
  return *number;
}

std::optional<std::int64_t> read_integer(const JsonValue& value, Range allowed, Diagnostics& diagnostics) {
  const auto* number = std::get_if<double>(&value.value);
  if (number && std::abs(*number) > kLargestInteger)
    return mismatch(value, "an integer", fmt::format("magnitudes to {:.0f}", kLargestInteger), diagnostics);
  if (!number || *number != std::floor(*number) || !allowed.contains(*number))
    return mismatch(value, "an integer", allowed.text(), diagnostics);
  return static_cast<std::int64_t>(*number);
}

std::optional<std::string> read_string(const JsonValue& value, Diagnostics& diagnostics) {
  if (const auto* string = std::get_if<std::string>(&value.value)) return *string;
  return mismatch(value, "a string", "text in double quotes", diagnostics);
}

std::optional<std::size_t> read_choice(const JsonValue& value, std::string_view kind,
                                       std::span<const char* const> names, Diagnostics& diagnostics) {
  const std::optional<std::string> word = read_string(value, diagnostics);
  if (!word) return std::nullopt;
  const auto found = std::ranges::find(names, *word);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  return diagnostics.refuse(value.where,
                            unknown_name(kind, *word, std::vector<std::string>(names.begin(), names.end())));
}

std::optional<bool> read_boolean(const JsonValue& value, Diagnostics& diagnostics) {
  if (const auto* boolean = std::get_if<bool>(&value.value)) return *boolean;
  return mismatch(value, "a boolean", "true or false", diagnostics);
}

std::optional<std::vector<double>> read_numbers(const JsonValue& value, std::size_t count, Range allowed,
                                                Diagnostics& diagnostics) {
  const auto* array = std::get_if<JsonValue::Array>(&value.value);
  if (!array) return mismatch(value, "an array of numbers", allowed.text(), diagnostics);
  if (count != 0 && array->size() != count)
    return diagnostics.refuse(
        value.where, fmt::format("wrong number of elements (got {}, allowed {})", array->size(), count));
  std::vector<double> numbers;
  for (const JsonValue& element : *array)
    if (const auto number = read_number(element, allowed, diagnostics)) numbers.push_back(*number);
  if (numbers.size() != array->size()) return std::nullopt;
  return numbers;
}

const JsonValue::Array* read_array(const JsonValue& value, std::string_view what, std::size_t min_size,
                                   Diagnostics& diagnostics) {
  const auto* array = std::get_if<JsonValue::Array>(&value.value);
  if (array && array->size() >= min_size) return array;
  diagnostics.error(value.where,
                    fmt::format("expected an array of {} (got {})", what,
                                array ? fmt::format("{} of them, allowed [{}, inf)", array->size(), min_size)
                                      : std::string(value.type_name())));
  return nullptr;
}

const JsonValue::Object* read_object(const JsonValue& value, Diagnostics& diagnostics) {
  const auto* object = std::get_if<JsonValue::Object>(&value.value);
  if (!object) mismatch(value, "an object", "{...}", diagnostics);
  return object;
}

std::optional<std::string_view> choose_key(const JsonValue& object, std::span<const std::string_view> keys,
                                           Diagnostics& diagnostics) {
  std::vector<std::string_view> present;
  for (const std::string_view key : keys)
    if (object.find(key)) present.push_back(key);
  if (present.size() == 1) return present.front();
  const auto* members = std::get_if<JsonValue::Object>(&object.value);
  if (!members) return std::nullopt;
  const std::vector<std::string> names(keys.begin(), keys.end());
  // A misspelt key is more specific than the absence of all keys.
  if (present.empty())
    for (const auto& [key, member] : *members)
      if (nearest_name(key, names))
        return diagnostics.refuse(member.key_position(), unknown_name("key", key, names));
  return diagnostics.refuse(
      object.where, fmt::format("expected exactly one key (got {}, allowed {})",
                                present.empty() ? "none" : fmt::format("{}", fmt::join(present, ", ")),
                                fmt::join(names, ", ")));
}

}  // namespace abbe
