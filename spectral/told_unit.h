#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spectral/unit.h"

namespace abbe {

/// What a table's line `# unit:` tells of its values: "spectral irradiance, mW/m2/nm (FEL); wavelength in
/// nm". All but the unit is in small letters. What stands behind the first ";" is a remark.
struct ToldUnit {
  /// What comes before the first comma or remark in parentheses, as "spectral irradiance".
  std::string quantity;
  /// What stands behind those, before the first ";", as "mw/m2/nm" and "fel".
  std::vector<std::string> additions;
  /// The whole line.
  std::string line;
  /// The first that reads as a unit: within the quantity, or an addition from its beginning. A length alone
  /// is that of the wavelengths, and a number alone none.
  std::optional<Unit> unit;
};

[[nodiscard]] ToldUnit told_unit(std::string_view line);

/// Whether a word or a phrase of the list stands in the text, with no letter beside it.
using Phrases = std::vector<std::string_view>;
[[nodiscard]] bool says(std::string_view text, const Phrases& phrases);
/// Whether the quantity begins with one of the phrases, or ends with one and says no more of something else,
/// as "optical density" does and "reflectance of a plastic of high density" does not, or an addition is one.
/// With a number before or behind it a phrase is an amount, as "50 dB".
[[nodiscard]] bool is_told_as(const ToldUnit& told, const Phrases& phrases);
/// Whether it is told in percent, per mille or from 0 to 100.
[[nodiscard]] bool is_told_in_percent(const ToldUnit& told);

}  // namespace abbe
