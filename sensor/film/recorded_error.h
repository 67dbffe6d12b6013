#pragma once

#include <map>
#include <string>

namespace abbe {

/// Attribute of a film with the relative error of its mean over the frame (`frame_mean_error`). "inf" means
/// unknown. An example is a film with pixels whose samples are in fewer than two replicates, where variances
/// of 0 mean nothing.
inline constexpr const char* kFrameMeanErrorKey = "frame_mean_error";

/// Attribute of a film with too few effective samples to estimate its error: the effective number of samples
/// that carry half of the variance of its mean (`few_samples`). Absent for other films.
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
