#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "sensor/response/stokes_channels.h"
#include "spectral/packet.h"
#include "spectral/stokes.h"

namespace abbe {

/// What paths expose the film with in all, by the group that each light belongs to.
struct ExposureByLight {
  std::vector<std::uint32_t> group;  ///< Of each light of the scene.
  std::vector<double> weight;        ///< Of each channel's film value; of a mosaic, of its plane's.
  std::vector<double> exposure;      ///< Of each group: the sum of |film value| times its weight.

  void add(std::uint32_t light, std::span<const double> values) {
    for (std::size_t k = 0; k < values.size(); ++k)
      if (std::isfinite(values[k])) exposure[group[light]] += weight[k] * std::abs(values[k]);
  }
};

/// Where and when light meets the film: the pixel, the cosine of the angle of incidence, and the time as rays
/// have it.
struct FilmPoint {
  int x = 0;
  int y = 0;
  float cos_film = 1;
  float time = 0;
  const LaneImages* images = nullptr;  ///< Where each lane falls, behind a lens that displaces them.
};

/// What light of each lane that comes to the film then counts, by the rows on which the lanes fall; see
/// `Shutter::weight`.
[[nodiscard]] inline SampledSpectrum lane_openings(const Shutter& shutter, const LaneImages& images,
                                                   float time) {
  SampledSpectrum::Values open{};
  for (int lane = 0; lane < kLanes; ++lane)
    open[static_cast<std::size_t>(lane)] = shutter.weight(static_cast<int>(images.y[lane]), time);
  return SampledSpectrum(open);
}

/// What of a contribution comes through the shutter, the point's time being one of all those of the span.
[[nodiscard]] inline SampledSpectrum let_through(const Shutter& shutter, const FilmPoint& at,
                                                 const SampledSpectrum& contribution) {
  if (at.images != nullptr) return contribution * lane_openings(shutter, *at.images, at.time);
  return contribution * shutter.weight(at.y, at.time);
}

[[nodiscard]] inline StokesSpectrum let_through(const Shutter& shutter, const FilmPoint& at,
                                                const StokesSpectrum& contribution) {
  StokesSpectrum through = contribution;
  through *= let_through(shutter, at, SampledSpectrum(1.0F));
  return through;
}

/// Where the time was drawn by the opening of the point's own row, as `Shutter::draw` does, so that light
/// which falls on that row counts the same at any time: by how much more each lane counts, and how much more
/// densely it would have drawn the time. Zero if that row is closed.
[[nodiscard]] inline SampledSpectrum openings_over_own(const Shutter& shutter, const FilmPoint& at) {
  const float own = shutter.weight(at.y, at.time);
  return own > 0 ? lane_openings(shutter, *at.images, at.time) / SampledSpectrum(own) : SampledSpectrum();
}

/// By which way light came: from which light of the scene, and by how many events between it and the camera,
/// or the meter.
struct LightHistory {
  std::uint32_t light;
  int events;
  /// Its density by path tracing over that of all strategies by which it was joined.
  float by_path_tracing = 1;
  std::uint32_t branch = 0;  ///< `LightPath::branch`, of photons that light tracing follows.
};

/// Receives the film values, one per plane, that the path of that number adds to a pixel.
using Deposit = std::function<void(std::uint32_t path, const FilmPoint& at, std::span<const double> values)>;

/// Receives those of each of its contributions by itself.
using ContributionDeposit = std::function<void(std::uint32_t path, const FilmPoint& at,
                                               const LightHistory& of, std::span<const double> values)>;

/// What light does to the film: a contribution c at the wavelengths lambda_j, drawn with the density p,
/// exposes channel k by sum_j c_j weight_k(lambda_j) / p(lambda_j). With a mosaic there is one value, that of
/// the pixel's own channel. Where the sensor tells polarised light from unpolarised light, c_j is what the
/// channel's analyser measures of a Stokes vector told in the frame of the film: x is the picture's right
/// (`film_right`), made perpendicular to the way of the light. A contribution without polarisation is a
/// vector (c_j, 0, 0, 0).
class FilmResponse {
 public:
  explicit FilmResponse(std::span<const Channel> channels, const Mosaic* mosaic = nullptr)
      : sensor_(channels),
        mosaic_(mosaic),
        angular_(std::any_of(channels.begin(), channels.end(),
                             [](const Channel& channel) { return channel.angular.has_value(); })),
        polarised_(any_analyser(channels)),
        plain_(!angular_ && !polarised_),
        values_(planes()),
        told_(planes()) {}

  /// How many values a contribution makes.
  [[nodiscard]] std::size_t planes() const { return mosaic_ == nullptr ? sensor_.size() : 1; }
  /// Whether the values depend on the angle of incidence.
  [[nodiscard]] bool angular() const { return angular_; }
  /// Whether some value depends on how the light is polarised.
  [[nodiscard]] bool polarised() const { return polarised_; }

  /// Tells `deposit` of each pixel on which lanes of a contribution, already divided by its balance over
  /// lanes and techniques, fall, and of the values, as many as `planes`, that these expose there: once in any
  /// case, where no lane has anything.
  template <typename Contribution, typename DepositAt>
  void expose(const FilmPoint& at, const SampledWavelengths& wavelengths, const Contribution& contribution,
              DepositAt deposit) {
    if (at.images != nullptr) return expose_apart(at, wavelengths, contribution, deposit);
    for (std::size_t k = 0; k < values_.size(); ++k)
      values_[k] = static_cast<double>(told(k, at, wavelengths, contribution).sum());
    deposit(at, std::span<const double>(values_));
  }

 private:
  // Lanes of one pixel, and of one angle where that matters, expose it together.
  template <typename Contribution, typename DepositAt>
  [[gnu::noinline]] void expose_apart(const FilmPoint& at, const SampledWavelengths& wavelengths,
                                      const Contribution& contribution, DepositAt deposit) {
    const auto tell = [&](const FilmPoint& pixel) {
      for (std::size_t k = 0; k < told_.size(); ++k) told_[k] = told(k, pixel, wavelengths, contribution);
    };
    const bool same_everywhere = mosaic_ == nullptr && !angular_;
    if (same_everywhere) tell(at);
    std::array<bool, kLanes> done{};
    bool any = false;
    for (int first = 0; first < kLanes; ++first) {
      if (done[static_cast<std::size_t>(first)] || intensity(contribution)[first] == 0) continue;
      const FilmPoint pixel = image_of(at, first);
      SampledSpectrum::Values falling{};
      for (int lane = first; lane < kLanes; ++lane) {
        const FilmPoint other = image_of(at, lane);
        if (other.x != pixel.x || other.y != pixel.y || (angular_ && other.cos_film != pixel.cos_film))
          continue;
        falling[static_cast<std::size_t>(lane)] = 1;  // not multiplied by: others need not be finite
        done[static_cast<std::size_t>(lane)] = true;
      }
      if (!same_everywhere) tell(pixel);
      for (std::size_t k = 0; k < values_.size(); ++k)
        values_[k] = static_cast<double>(only(told_[k], SampledSpectrum(falling)).sum());
      deposit(pixel, std::span<const double>(values_));
      any = true;
    }
    if (any) return;
    std::fill(values_.begin(), values_.end(), 0.0);
    deposit(FilmPoint{at.x, at.y, at.cos_film, at.time}, std::span<const double>(values_));
  }
  [[nodiscard]] static const SampledSpectrum& intensity(const SampledSpectrum& of) { return of; }
  [[nodiscard]] static const SampledSpectrum& intensity(const StokesSpectrum& of) { return of.i; }
  [[nodiscard]] static SampledSpectrum only(const SampledSpectrum& of, const SampledSpectrum& lanes) {
    return SampledSpectrum::map(of, lanes, [](float value, float kept) { return kept > 0 ? value : 0; });
  }
  [[nodiscard]] static FilmPoint image_of(const FilmPoint& at, int lane) {
    return {static_cast<int>(at.images->x[lane]), static_cast<int>(at.images->y[lane]),
            at.images->cos_film[lane], at.time};
  }

  // What each lane exposes plane k with.
  [[nodiscard]] SampledSpectrum told(std::size_t k, const FilmPoint& at,
                                     const SampledWavelengths& wavelengths,
                                     const SampledSpectrum& contribution) const {
    return contribution / wavelengths.pdf * weight(channel(k, at), at, wavelengths.lambda_nm);
  }
  [[nodiscard]] SampledSpectrum told(std::size_t k, const FilmPoint& at,
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
    const SampledSpectrum weight = weight_at(channel, wavelengths_nm, cos_film);  // out of the others' way
    return channel.analyser ? weight * channel.analyser->i : weight;
  }

  std::span<const Channel> sensor_;
  const Mosaic* mosaic_;
  bool angular_;
  bool polarised_;
  bool plain_;
  std::vector<double> values_;         // of one deposit
  std::vector<SampledSpectrum> told_;  // lane by lane
};

/// The response of the scene's sensor; refers to the scene, which must outlive it.
[[nodiscard]] inline FilmResponse film_response_of(const Scene& scene) {
  return FilmResponse(scene.channels, scene.mosaic ? &*scene.mosaic : nullptr);
}

}  // namespace abbe
