#pragma once

#include <map>
#include <string>

namespace abbe {

/// The attribute of a film with the relative error of the mean over all of it. It is infinite where nothing
/// is known of that error, as with samples of some pixels in fewer than two replicates: the variances of
/// these are 0 then.
inline constexpr const char* kFrameMeanErrorKey = "frame_mean_error";

/// The attribute of a film whose error is not yet known: how many samples carry half of the variance of its
/// mean.
inline constexpr const char* kHalfNoiseSamplesKey = "half_noise_samples";

/// Whether the attributes of a film, or of what was developed of it, say that nothing is known of its error.
[[nodiscard]] inline bool has_unknown_error(const std::map<std::string, std::string>& told) {
  const auto error = told.find(kFrameMeanErrorKey);
  return error != told.end() && error->second == "inf";
}

/// Says that nothing is known of a film's error.
inline void tell_unknown_error(std::map<std::string, std::string>& told) {
  told[kFrameMeanErrorKey] = "inf";
}

/// Drops what is said of the error of a film that is another now; that nothing is known of it stays true.
inline void forget_error(std::map<std::string, std::string>& told) {
  told.erase(kHalfNoiseSamplesKey);
  if (!has_unknown_error(told)) told.erase(kFrameMeanErrorKey);
}

}  // namespace abbe
