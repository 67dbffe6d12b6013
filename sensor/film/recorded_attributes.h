#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/response/mosaic.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// Value of an attribute of a film or picture; nothing if there is none.
[[nodiscard]] std::optional<std::string> attribute_of(const std::map<std::string, std::string>& attributes,
                                                      const std::string& key);
/// Value of an attribute that is a number; nothing if there is none or if it is not a number.
[[nodiscard]] std::optional<double> number_of(const std::map<std::string, std::string>& attributes,
                                              const std::string& key);

/// JSON pointer of the requested white, in a scene and in the options of development.
inline constexpr const char* kWhitePointer = "/output/white";
/// Attributes with the name of a film's white and with its x and y, separated by a blank.
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

/// Records a white, and if the scene requests it. Replaces an earlier one.
void record_white(const std::string& name, const Chromaticity& xy, bool requested,
                  std::map<std::string, std::string>& metadata);

/// Recorded chromaticity of a film's white; nothing if its name or the chromaticity is missing. Throws
/// Error{input} unless x and y are two positive numbers.
[[nodiscard]] std::optional<Chromaticity> recorded_white(const Image& film);

/// Attribute with the relative error of a film's mean over the frame (`frame_mean_error`); "inf" if unknown,
/// as with pixels whose samples are in fewer than two replicates.
inline constexpr const char* kFrameMeanErrorKey = "frame_mean_error";

/// Attribute with the result of `few_samples`; absent if there is none.
inline constexpr const char* kHalfNoiseSamplesKey = "half_noise_samples";

/// True if the attributes of a film or of a file developed from it record an unknown error.
[[nodiscard]] inline bool has_unknown_error(const std::map<std::string, std::string>& attributes) {
  const auto error = attributes.find(kFrameMeanErrorKey);
  return error != attributes.end() && error->second == "inf";
}

/// Records that the error of a film is unknown.
inline void record_unknown_error(std::map<std::string, std::string>& attributes) {
  attributes[kFrameMeanErrorKey] = "inf";
}

/// Removes the recorded error after a film has changed; an unknown error stays unknown.
inline void erase_error(std::map<std::string, std::string>& attributes) {
  attributes.erase(kHalfNoiseSamplesKey);
  if (!has_unknown_error(attributes)) attributes.erase(kFrameMeanErrorKey);
}

/// Unit that films record for the channels X, Y and Z of an observer, in the attribute `channel.X`.
[[nodiscard]] const char* photometric_unit(Observer observer);

/// Observer of a film's colours: the one whose X channel it records, otherwise the CIE 1931 observer, with
/// the bands of a spectral film. A single band, whose width is unknown, counts as none. Never throws.
[[nodiscard]] FilmObserver recorded_film_observer(const Image& film);

/// A mosaic, and the names of its channels, to which `Mosaic::channel` refers.
struct RecordedMosaic {
  Mosaic pattern;
  std::vector<std::string> channels;
};

/// Mosaic that the attributes `mosaic` and `mosaic_channels` of a film or of a file developed from it record.
/// Nothing if they record none or are malformed.
[[nodiscard]] std::optional<RecordedMosaic> recorded_mosaic(
    const std::map<std::string, std::string>& attributes);

}  // namespace abbe
