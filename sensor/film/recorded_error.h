#pragma once

#include <map>
#include <string>

namespace abbe {

/// Attribute of a film with the relative error of its mean over the frame. It is infinite if the error is
/// unknown, for example if some pixels have samples in fewer than two replicates, so that their variances are
/// 0.
inline constexpr const char* kFrameMeanErrorKey = "frame_mean_error";

/// Attribute of a film whose error is not yet known: the number of samples that carry half of the variance of
/// its mean.
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

}  // namespace abbe
