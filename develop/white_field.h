#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/matrix3.h"

namespace abbe {

/// The attribute of a film with its `WhiteField`: rows from the centre to the corner, with ';' between rows
/// and ',' between channels.
inline constexpr const char* kWhiteFieldKey = "white_over_field";

/// A sensor's response to its white over the field, as interference filters change it with the angle of
/// incidence. Row i is for the distance i/(rows - 1) from the centre of the picture to its corner: the value
/// of each channel per irradiance, relative to the centre. Vignetting has no part in it.
struct WhiteField {
  std::vector<std::vector<double>> relative;  ///< Two rows or more, of positive numbers.
};

[[nodiscard]] std::string to_text(const WhiteField& field);
/// Nothing for text that is no such field of so many channels.
[[nodiscard]] std::optional<WhiteField> parse_white_field(const std::string& text, std::size_t channels);

/// The largest CIEDE2000 between the perfect diffuser at the centre and elsewhere in the field, in colours
/// balanced at the centre by `to_xyz_d65`, at equal luminance.
[[nodiscard]] double neutral_shift(const WhiteField& field, const Matrix3& to_xyz_d65);
/// A warning for a `neutral_shift` above 1 that ends with `remedy`; nothing for a smaller one.
[[nodiscard]] std::optional<std::string> tinted_corners(double neutral_shift, const std::string& remedy);

/// Divides the named channels of a picture by the field, so that they respond to white as at the centre.
void flatten(Image& planes, std::span<const std::string> channels, const WhiteField& field);
/// The largest response of each channel over the field, relative to the centre.
[[nodiscard]] std::vector<double> largest_response(const WhiteField& field);

}  // namespace abbe
