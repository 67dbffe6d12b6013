#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "sensor/response/channel.h"
#include "spectral/packet.h"

namespace abbe {

/// What the path in hand adds to a film value, channel by channel: a contribution c exposes channel k by
/// sum_j c_j weight_k(lambda_j) / p(lambda_j). One of these serves all paths of a thread.
class PathExposure {
 public:
  explicit PathExposure(std::span<const Channel> channels)
      : channels_(channels), weights_(channels.size()), values_(channels.size()) {}

  /// Starts a path: nothing exposed yet. `scale` multiplies everything, exposure time and what the camera
  /// asks.
  void begin(const SampledWavelengths& wavelengths, float scale) {
    wavelengths_ = wavelengths;
    scale_ = scale;
    weighed_ = false;
    clear();
  }
  /// Forgets what was exposed, within the same path.
  void clear() { std::fill(values_.begin(), values_.end(), 0.0); }

  /// Adds `contribution`, already divided by its balance over lanes and techniques.
  void deposit(const SampledSpectrum& contribution) {
    if (!weighed_)
      weigh();  // many paths end without reaching the film, and the responses cost more than a ray
    for (std::size_t k = 0; k < weights_.size(); ++k)
      values_[k] += static_cast<double>((contribution * weights_[k]).sum());
  }

  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  void weigh() {
    const SampledSpectrum share = SampledSpectrum(scale_) / wavelengths_.pdf;
    for (std::size_t k = 0; k < weights_.size(); ++k)
      weights_[k] = share * channels_[k].weight(wavelengths_.lambda_nm);
    weighed_ = true;
  }

  std::span<const Channel> channels_;
  std::vector<SampledSpectrum> weights_;
  std::vector<double> values_;
  SampledWavelengths wavelengths_;
  float scale_ = 1;
  bool weighed_ = false;
};

}  // namespace abbe
