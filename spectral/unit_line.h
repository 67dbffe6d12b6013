#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spectral/unit.h"

namespace abbe {

/// Parts of the line `# unit:` of a table, such as "spectral irradiance, mW/m2/nm (FEL); wavelength in nm".
/// All but the unit are in lower case. The text after the first ";" is a remark.
struct UnitLine {
  /// Text before the first comma or parenthesised remark, such as "spectral irradiance".
  std::string quantity;
  /// Further parts before the first ";", such as "mw/m2/nm" and "fel".
  std::vector<std::string> additions;
  /// The whole line in lower case, with Unicode signs of units replaced by ASCII.
  std::string text;
  /// First unit: inside the quantity, or at the beginning of an addition. A length alone is the unit of the
  /// wavelengths, and a number alone is no unit.
  std::optional<Unit> unit;
};

/// Parses the value of the line `# unit:`. Accepts any text and never throws; an empty line has empty parts
/// and no unit.
[[nodiscard]] UnitLine unit_line(std::string_view line);

/// Words or phrases in lower case.
using Phrases = std::vector<std::string_view>;
/// True if a word or phrase of the list occurs in the text with no letter next to it. The text must be in
/// lower case.
[[nodiscard]] bool contains_phrase(std::string_view text, const Phrases& phrases);
/// True if the line declares one of the phrases: an addition is one, or the quantity begins or ends with one.
/// Words such as "of" before a phrase at the end give it another meaning: "optical density" declares a
/// density, "reflectance of a plastic of high density" does not. A number before or after a phrase makes it
/// an amount, such as "50 dB".
[[nodiscard]] bool declares(const UnitLine& line, const Phrases& phrases);
/// True if the line declares percent, per mille or a scale from 0 to 100.
[[nodiscard]] bool declares_percent(const UnitLine& line);

}  // namespace abbe
