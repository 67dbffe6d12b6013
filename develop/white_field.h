#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Attribute that holds a film's `WhiteField`: rows from the centre to the corner, separated by ';', with
/// channels separated by ','.
inline constexpr const char* kWhiteFieldKey = "white_over_field";

/// Response of a sensor to its white over the field. It varies with interference filters, because they depend
/// on the angle of incidence. Row i is for the distance i/(rows - 1) from the centre of the picture towards
/// its corner. It holds each channel's value per irradiance, relative to the centre; vignetting is not
/// included.
struct WhiteField {
  std::vector<std::vector<double>> relative;  ///< At least two rows of positive numbers.
};

[[nodiscard]] std::string to_text(const WhiteField& field);
/// Parses a field with `channels` channels; empty if the text is malformed or does not have two rows.
[[nodiscard]] std::optional<WhiteField> parse_white_field(const std::string& text, std::size_t channels);

/// Largest CIEDE2000 difference between the perfect diffuser at the centre and elsewhere in the field, at
/// equal luminance. Colours are balanced at the centre by `to_xyz_d65`, an invertible matrix from three
/// channels to XYZ.
[[nodiscard]] double neutral_shift(const WhiteField& field, const Matrix3& to_xyz_d65);
/// A warning that ends with `remedy` if the result of `neutral_shift` exceeds 1; empty otherwise.
[[nodiscard]] std::optional<std::string> field_tint_warning(double neutral_shift, const std::string& remedy);

/// Divides the `channels` of a picture, which are those of the field in order, by the field. Others remain.
void flatten(Image& planes, std::span<const std::string> channels, const WhiteField& field);
/// The largest response of each channel over the field, relative to the centre.
[[nodiscard]] std::vector<double> largest_response(const WhiteField& field);

}  // namespace abbe
