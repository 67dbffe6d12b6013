#pragma once

#include <map>
#include <optional>
#include <string>

#include "io/image.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// Where a scene asks for a white, as does who develops its film.
inline constexpr const char* kWhitePointer = "/output/white";
/// Attributes of a film that name its white and tell its chromaticity, x and y with a blank between them.
inline constexpr const char* kWhiteKey = "white";
inline constexpr const char* kWhiteXyKey = "white_xy";
/// The attribute of a film whose scene asks for its white, "yes"; others show their main light as white, or
/// what they are developed for.
inline constexpr const char* kWhiteAskedKey = "white_asked";
/// The attribute with the chromaticities of the scene's lights: a JSON object of [x, y] by name, null for a
/// name that several lights have.
inline constexpr const char* kLightsXyKey = "lights_xy";
/// The attribute that says why no picture can be made of a film, in place of the matrix of its pictures.
inline constexpr const char* kNoPictureKey = "no_picture";

/// Adds a white to what a film tells, in the place of another, and whether the scene asks for it.
void record_white(const std::string& name, const Chromaticity& xy, bool asked,
                  std::map<std::string, std::string>& metadata);

/// The chromaticity of the white that a film tells; nothing for a film that does not tell its name too.
/// Throws Error{input} when it makes no sense.
[[nodiscard]] std::optional<Chromaticity> recorded_white(const Image& film);

}  // namespace abbe
