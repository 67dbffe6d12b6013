#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/sampled_spectrum.h"
#include "spectral/stokes.h"

namespace abbe {

/// Total exposure of the film, by group of lights.
struct ExposureByLight {
  std::vector<std::uint32_t> group;  ///< Group of each light of the scene.
  /// Weight of each channel's film value; with a mosaic, of the value of the pixel's only plane.
  std::vector<double> weight;
  std::vector<double> exposure;  ///< Per group: sum of |film value| times its weight.

  /// Adds the film values of one contribution of a light, one per weight. Values that are not finite are
  /// ignored.
  void add(std::uint32_t light, std::span<const double> values) {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (std::isfinite(values[k])) exposure[group[light]] += weight[k] * std::abs(values[k]);
  }
};

/// Point and time at which light arrives at the film.
struct FilmPoint {
  int x = 0;           ///< Column of the pixel, from the left edge of the whole film.
  int y = 0;           ///< Row of the pixel, from the top edge of the whole film.
  float cos_film = 1;  ///< Cosine of the angle of incidence.
  float time = 0;      ///< Fraction of the exposure of the whole film; see `BasicRay`.
  /// Film position of each wavelength sample; nullptr unless the lens disperses them.
  const WavelengthImages* images = nullptr;
};

/// Weight of the shutter at the time `time` (see `BasicRay`), per wavelength, at the film row on which that
/// wavelength falls; see `Shutter::weight`.
[[nodiscard]] inline SampledSpectrum shutter_weights(const Shutter& shutter, const WavelengthImages& images,
                                                     float time) {
  SampledSpectrum::Values open{};
  for (int lane = 0; lane < kLanes; ++lane)
    open[static_cast<std::size_t>(lane)] = shutter.weight(static_cast<int>(images.y[lane]), time);
  return SampledSpectrum(open);
}

/// Multiplies a contribution by the shutter's weight. The time of `at` must be uniform over the whole
/// exposure.
[[nodiscard]] inline SampledSpectrum apply_shutter(const Shutter& shutter, const FilmPoint& at,
                                                   const SampledSpectrum& contribution) {
  if (at.images != nullptr) return contribution * shutter_weights(shutter, *at.images, at.time);
  return contribution * shutter.weight(at.y, at.time);
}

[[nodiscard]] inline StokesSpectrum apply_shutter(const Shutter& shutter, const FilmPoint& at,
                                                  const StokesSpectrum& contribution) {
  StokesSpectrum through = contribution;
  through *= apply_shutter(shutter, at, SampledSpectrum(1.0F));
  return through;
}

/// Corrects the sampled time for a lens that disperses wavelengths. The time was drawn with the opening of
/// the point's own row as its pdf (`Shutter::sample`). Returns, per wavelength, the shutter weight of its row
/// over that of the own row. The ratio is both the weight and the relative pdf of the time. Zero if the own
/// row is closed. `at.images` must not be null.
[[nodiscard]] inline SampledSpectrum relative_shutter_weights(const Shutter& shutter, const FilmPoint& at) {
  const float own = shutter.weight(at.y, at.time);
  return own > 0 ? shutter_weights(shutter, *at.images, at.time) / SampledSpectrum(own) : SampledSpectrum();
}

/// Origin of a contribution to the film.
struct ContributionInfo {
  std::uint32_t light;  ///< Index into `Scene::lights`.
  int depth;            ///< Number of scattering events between the light and the camera or probe.
  /// Pdf of the path by path tracing over the summed pdfs of all strategies that can sample it. May exceed 1;
  /// see `StrategyWeights::path_tracing_fraction`.
  float path_tracing_fraction = 1;
  std::uint32_t branch = 0;  ///< `LightPath::branch` of the photon; 0 for other integrators.
};

/// Receives the film values, one per plane, that a path adds to the pixel of `at`. `path` is the index of the
/// sample or photon in the list that the integrator traces. `values` and `at.images` are valid during the
/// call only.
using Deposit = std::function<void(std::uint32_t path, const FilmPoint& at, std::span<const double> values)>;

/// Receives the film values of each contribution separately; arguments as for `Deposit`.
using ContributionDeposit = std::function<void(std::uint32_t path, const FilmPoint& at,
                                               const ContributionInfo& info, std::span<const double> values)>;

/// Base of tracers that can report each contribution separately, for the layers of a film.
class LayerSource {
 public:
  /// Sets a callback that receives every contribution separately, in addition to the deposited sums. An empty
  /// function removes it.
  void set_layer_sink(ContributionDeposit deposit) { layer_sink_ = std::move(deposit); }

 protected:
  ContributionDeposit layer_sink_;  // may be empty
};

/// Converts spectral contributions to film values. A contribution c at the wavelengths lambda_j, sampled with
/// the pdf p, adds sum_j c_j weight_k(lambda_j) / p(lambda_j) to channel k. With a mosaic there is one value,
/// that of the pixel's channel.
///
/// If the sensor distinguishes polarisation, c_j is the value that the channel's analyser measures of a
/// Stokes vector in the frame of the film. The x axis of that frame is the picture's right (`film_right`),
/// made perpendicular to the direction of the light. An unpolarised contribution is the vector (c_j, 0, 0,
/// 0).
class FilmResponse {
 public:
  /// Response of these channels; channels and mosaic must outlive it. Without a mosaic (nullptr), each
  /// channel is a plane of every pixel.
  explicit FilmResponse(std::span<const Channel> channels, const Mosaic* mosaic = nullptr)
      : sensor_(channels),
        mosaic_(mosaic),
        angular_(std::any_of(channels.begin(), channels.end(),
                             [](const Channel& channel) { return channel.angular.has_value(); })),
        polarised_(any_analyser(channels)),
        plain_(!angular_ && !polarised_),
        values_(planes()),
        lane_values_(planes()) {}

  /// Number of film values per contribution.
  [[nodiscard]] std::size_t planes() const { return mosaic_ == nullptr ? sensor_.size() : 1; }
  /// True if the values depend on the angle of incidence.
  [[nodiscard]] bool angular() const { return angular_; }
  /// True if a value depends on the polarisation of the light.
  [[nodiscard]] bool polarised() const { return polarised_; }

  /// Calls `deposit` for each pixel on which wavelengths of a contribution fall, with its `planes()` film
  /// values. `contribution` is a `SampledSpectrum` or a `StokesSpectrum`, already weighted by the balance
  /// over wavelengths and techniques. It is not yet divided by the pdf of the wavelengths. If every
  /// wavelength is zero, `deposit` is called once, with zeros. `deposit` takes the arguments of `Deposit`
  /// except `path`.
  template <typename Contribution, typename DepositAt>
  void expose(const FilmPoint& at, const SampledWavelengths& wavelengths, const Contribution& contribution,
              DepositAt deposit) {
    if (at.images != nullptr) return expose_per_lane(at, wavelengths, contribution, deposit);
    for (std::size_t k = 0; k < values_.size(); ++k)
      values_[k] = static_cast<double>(lane_values(k, at, wavelengths, contribution).sum());
    deposit(at, std::span<const double>(values_));
  }

 private:
  // Wavelengths that fall on the same pixel, at the same angle if the response depends on it, are added
  // together.
  template <typename Contribution, typename DepositAt>
  [[gnu::noinline]] void expose_per_lane(const FilmPoint& at, const SampledWavelengths& wavelengths,
                                         const Contribution& contribution, DepositAt deposit) {
    const auto evaluate = [&](const FilmPoint& pixel) {
      for (std::size_t k = 0; k < lane_values_.size(); ++k)
        lane_values_[k] = lane_values(k, pixel, wavelengths, contribution);
    };
    const bool independent_of_pixel = mosaic_ == nullptr && !angular_;
    if (independent_of_pixel) evaluate(at);
    std::array<bool, kLanes> done{};
    bool any = false;
    for (int first = 0; first < kLanes; ++first) {
      if (done[static_cast<std::size_t>(first)] || intensity(contribution)[first] == 0) continue;
      const FilmPoint pixel = image_of(at, first);
      SampledSpectrum::Values mask{};
      for (int lane = first; lane < kLanes; ++lane) {
        const FilmPoint other = image_of(at, lane);
        if (other.x != pixel.x || other.y != pixel.y || (angular_ && other.cos_film != pixel.cos_film))
          continue;
        // selects a lane without multiplying, as the other values may be infinite or NaN
        mask[static_cast<std::size_t>(lane)] = 1;
        done[static_cast<std::size_t>(lane)] = true;
      }
      if (!independent_of_pixel) evaluate(pixel);
      for (std::size_t k = 0; k < values_.size(); ++k)
        values_[k] = static_cast<double>(masked(lane_values_[k], SampledSpectrum(mask)).sum());
      deposit(pixel, std::span<const double>(values_));
      any = true;
    }
    if (any) return;
    std::fill(values_.begin(), values_.end(), 0.0);
    deposit(FilmPoint{at.x, at.y, at.cos_film, at.time}, std::span<const double>(values_));
  }
  [[nodiscard]] static const SampledSpectrum& intensity(const SampledSpectrum& of) { return of; }
  [[nodiscard]] static const SampledSpectrum& intensity(const StokesSpectrum& of) { return of.i; }
  [[nodiscard]] static SampledSpectrum masked(const SampledSpectrum& values, const SampledSpectrum& mask) {
    return SampledSpectrum::map(values, mask,
                                [](float value, float selected) { return selected > 0 ? value : 0; });
  }
  [[nodiscard]] static FilmPoint image_of(const FilmPoint& at, int lane) {
    return {static_cast<int>(at.images->x[lane]), static_cast<int>(at.images->y[lane]),
            at.images->cos_film[lane], at.time};
  }

  // Contribution of each wavelength to plane k.
  [[nodiscard]] SampledSpectrum lane_values(std::size_t k, const FilmPoint& at,
                                            const SampledWavelengths& wavelengths,
                                            const SampledSpectrum& contribution) const {
    return contribution / wavelengths.pdf * weight(channel(k, at), at, wavelengths.lambda_nm);
  }
  [[nodiscard]] SampledSpectrum lane_values(std::size_t k, const FilmPoint& at,
                                            const SampledWavelengths& wavelengths,
                                            const StokesSpectrum& contribution) const {
    const Channel& of = channel(k, at);
    const SampledSpectrum& nm = wavelengths.lambda_nm;
    const SampledSpectrum measured_here =
        of.analyser ? measured(row_of(*of.analyser, nm), contribution) : contribution.i;
    return measured_here / wavelengths.pdf * weight_at(of, nm, at.cos_film);
  }
  [[nodiscard]] const Channel& channel(std::size_t k, const FilmPoint& at) const {
    return sensor_[mosaic_ == nullptr ? k : static_cast<std::size_t>(mosaic_->at(at.x, at.y))];
  }

  [[nodiscard]] SampledSpectrum weight(const Channel& channel, const FilmPoint& at,
                                       const SampledSpectrum& wavelengths_nm) const {
    return plain_ ? channel.weight(wavelengths_nm) : weight_unpolarised(channel, at.cos_film, wavelengths_nm);
  }
  [[gnu::noinline]] static SampledSpectrum weight_unpolarised(const Channel& channel, float cos_film,
                                                              const SampledSpectrum& wavelengths_nm) {
    // not inlined for speed
    const SampledSpectrum weight = weight_at(channel, wavelengths_nm, cos_film);
    return channel.analyser ? weight * channel.analyser->i : weight;
  }

  std::span<const Channel> sensor_;
  const Mosaic* mosaic_;
  bool angular_;
  bool polarised_;
  bool plain_;
  std::vector<double> values_;                // values of one deposit
  std::vector<SampledSpectrum> lane_values_;  // per wavelength
};

/// Response of the scene's sensor. The scene must outlive it.
[[nodiscard]] inline FilmResponse film_response_of(const Scene& scene) {
  return FilmResponse(scene.channels, scene.mosaic ? &*scene.mosaic : nullptr);
}

}  // namespace abbe
