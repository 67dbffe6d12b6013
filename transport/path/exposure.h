#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "spectral/packet.h"

namespace abbe {

/// What paths expose the film with in all, by the group that each light belongs to.
struct ExposureByLight {
  std::vector<std::uint32_t> group;  ///< Of each light of the scene.
  std::vector<double> weight;        ///< Of each channel's film value; of a mosaic, of its plane's.
  std::vector<double> exposure;      ///< Of each group: the sum of |film value| times its weight.

  void add(std::uint32_t light, std::size_t channel, double value) {
    if (std::isfinite(value)) exposure[group[light]] += weight[channel] * std::abs(value);
  }
};

/// What the path in hand adds to a film value, channel by channel: a contribution c exposes channel k by
/// sum_j c_j weight_k(lambda_j) / p(lambda_j). With a mosaic there is one value, that of the pixel's own
/// channel. One of these serves all paths of a thread.
class PathExposure {
 public:
  explicit PathExposure(std::span<const Channel> channels, const Mosaic* mosaic = nullptr)
      : sensor_(channels),
        mosaic_(mosaic),
        angular_(std::any_of(channels.begin(), channels.end(),
                             [](const Channel& channel) { return channel.angular.has_value(); })),
        channels_(mosaic == nullptr ? channels : channels.first(1)),
        weights_(channels_.size()),
        values_(channels_.size()) {}

  /// Starts a path: nothing exposed yet. `scale` multiplies everything, exposure time and what the camera
  /// asks.
  void begin(const SampledWavelengths& wavelengths, float scale) {
    wavelengths_ = wavelengths;
    scale_ = scale;
    weighed_ = false;
    clear();
  }
  /// What is deposited from now on arrives at this pixel: before the first deposit of a path, and wherever
  /// the path reaches the film elsewhere.
  void at_pixel(int x, int y) {
    if (mosaic_ == nullptr) return;
    channels_ = sensor_.subspan(static_cast<std::size_t>(mosaic_->at(x, y)), 1);
    weighed_ = false;
  }
  /// What is deposited from now on arrives under an angle of this cosine; at the same moments.
  void at_angle(float cos_film) {
    if (!angular_) return;
    cos_film_ = cos_film;
    weighed_ = false;
  }
  /// From now on also adds up what each light deposits.
  void tell_lights_apart(ExposureByLight& by_light) { by_light_ = &by_light; }
  /// Forgets what was exposed, within the same path.
  void clear() { std::fill(values_.begin(), values_.end(), 0.0); }

  /// Adds `contribution`, already divided by its balance over lanes and techniques.
  void deposit(const SampledSpectrum& contribution) {
    if (!weighed_)
      weigh();  // many paths end without reaching the film, and the responses cost more than a ray
    for (std::size_t k = 0; k < weights_.size(); ++k)
      values_[k] += static_cast<double>((contribution * weights_[k]).sum());
  }

  /// The same of what comes from that light of the scene.
  void deposit(const SampledSpectrum& contribution, std::uint32_t light) {
    deposit(contribution);
    if (by_light_ != nullptr) [[unlikely]]
      attribute(contribution, light);
  }

  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  void weigh() {
    const SampledSpectrum share = SampledSpectrum(scale_) / wavelengths_.pdf;
    if (angular_)
      weigh_by_angle(share);
    else
      for (std::size_t k = 0; k < weights_.size(); ++k)
        weights_[k] = share * channels_[k].weight(wavelengths_.lambda_nm);
    weighed_ = true;
  }
  [[gnu::noinline]] void attribute(const SampledSpectrum& contribution, std::uint32_t light) const {
    for (std::size_t k = 0; k < weights_.size(); ++k)
      by_light_->add(light, k, static_cast<double>((contribution * weights_[k]).sum()));
  }
  [[gnu::noinline]] void weigh_by_angle(const SampledSpectrum& share) {  // out of the way of the others
    for (std::size_t k = 0; k < weights_.size(); ++k)
      weights_[k] = share * weight_at(channels_[k], wavelengths_.lambda_nm, cos_film_);
  }

  std::span<const Channel> sensor_;
  const Mosaic* mosaic_;
  bool angular_;
  std::span<const Channel> channels_;  // of the pixel
  std::vector<SampledSpectrum> weights_;
  std::vector<double> values_;
  ExposureByLight* by_light_ = nullptr;
  SampledWavelengths wavelengths_;
  float scale_ = 1;
  float cos_film_ = 1;
  bool weighed_ = false;
};

/// That of the scene's sensor.
[[nodiscard]] inline PathExposure exposure_of(const Scene& scene) {
  return PathExposure(scene.channels, scene.mosaic ? &*scene.mosaic : nullptr);
}

}  // namespace abbe
