#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/image.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// JSON pointer of the requested white, in a scene and in the options of development.
inline constexpr const char* kWhitePointer = "/output/white";
/// Attributes with the name of a film's white and with its chromaticity x, y, separated by a blank.
inline constexpr const char* kWhiteKey = "white";
inline constexpr const char* kWhiteXyKey = "white_xy";
/// Attribute of a film whose scene requests its white, "yes". Other films are displayed with their main light
/// as white, or with the white that development requests.
inline constexpr const char* kWhiteRequestedKey = "white_asked";
/// Attribute with the chromaticities of the lights of the scene: a JSON object of [x, y] by name, null for a
/// name that several lights have.
inline constexpr const char* kLightsXyKey = "lights_xy";
/// Attribute with the reason why a film cannot be displayed, instead of its display matrix.
inline constexpr const char* kNoPictureKey = "no_picture";

/// Records the name and chromaticity of a white, and if the scene requests it (`requested`). Replaces an
/// earlier one.
void record_white(const std::string& name, const Chromaticity& xy, bool requested,
                  std::map<std::string, std::string>& metadata);

/// Recorded chromaticity of a film's white; nothing if its name or the chromaticity is missing. Throws
/// Error{input} unless x and y are two positive numbers.
[[nodiscard]] std::optional<Chromaticity> recorded_white(const Image& film);

}  // namespace abbe
