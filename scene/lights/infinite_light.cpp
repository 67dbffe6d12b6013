#include "scene/lights/infinite_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <ImathMatrix.h>

#include "materials/bsdf/warp.h"
#include "sampling/discrete.h"
#include "scene/shapes/basic.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

// Exposure by one unit of each primary, over all channels; responses may be negative.
LinearRgb exposures(const std::array<Curve, 3>& primaries, std::span<const Channel> channels) {
  LinearRgb exposed{};
  for (std::size_t c = 0; c < 3; ++c)
    for (const Channel& channel : channels)
      exposed.at(c) += std::abs(integral_of_product(primaries.at(c), envelope(channel)));
  return exposed;
}

std::span<const double> row_of(const std::vector<double>& texels, std::size_t row, std::size_t width) {
  return std::span(texels).subspan(row * width, width);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::optional<Imath::V3f> sample_direction(const EnvironmentLight& environment,
                                           const LightSampleContext& context, Imath::V2f u) {
  if (environment.image) return environment.image->sample(u);
  if (!context.side) return sample_area(Sphere{{0, 0, 0}, 1}, u).normal;
  return Basis<float>(*context.side).to_world(cosine_hemisphere(u));
}

float direction_pdf(const EnvironmentLight& environment, const LightSampleContext& context,
                    const Imath::V3f& wi) {
  if (environment.image) return environment.image->pdf(wi);
  return context.side ? std::max(0.0F, context.side->dot(wi)) / std::numbers::pi_v<float>
                      : 1 / (4 * std::numbers::pi_v<float>);
}

// Density on the disc of the scene's radius that is perpendicular to the direction.
float disc_pdf(float scene_radius_m) {
  return 1 / (std::numbers::pi_v<float> * scene_radius_m * scene_radius_m);
}

LightBounds bounds_at_infinity(const Imath::V3f& towards, double cap, double facing, double all_sides) {
  const Imath::V3d axis(towards);
  return {Imath::Box3d(axis), 0, 0, {axis, std::acos(1 - cap), 0}, facing, all_sides, true};
}

// Through the center of the scene, from 1.5 times its radius before it.
BasicRay<double> central_ray_from(const Imath::V3d& towards, const Ball& sphere) {
  return {sphere.center + 1.5 * sphere.radius * towards, -towards};
}

}  // namespace

EnvironmentFrame environment_frame(const Imath::V3d& up, double rotate_deg) {
  const Imath::V3d reference =
      up.cross(Imath::V3d(0, 1, 0)).length() > 1e-6 ? Imath::V3d(0, 1, 0) : Imath::V3d(1, 0, 0);
  const Imath::V3d horizontal = (reference - up * reference.dot(up)).normalized();
  const double angle = rotate_deg * std::numbers::pi / 180;
  return {up, horizontal * std::cos(angle) + up.cross(horizontal) * std::sin(angle)};
}

EnvironmentImage::EnvironmentImage(int width, int height, std::vector<std::array<float, 3>> texels,
                                   const EnvironmentFrame& frame, const Curve& emission,
                                   std::span<const Channel> channels)
    : width_(static_cast<std::size_t>(width)),
      height_(static_cast<std::size_t>(height)),
      texels_(std::move(texels)),
      up_(frame.up),
      forward_(frame.forward),
      right_(frame.forward.cross(frame.up)),
      primaries_{product(emission, rgb_basis().red), product(emission, rgb_basis().green),
                 product(emission, rgb_basis().blue)},
      row_cdf_(height_),
      column_cdf_(texels_.size()) {
  const LinearRgb exposed = exposures(primaries_, channels);
  double rows = 0;
  for (std::size_t row = 0; row < height_; ++row) {
    double columns = 0;
    for (std::size_t i = row * width_; i < (row + 1) * width_; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = static_cast<double>(texels_[i].at(c));
        columns += exposed.at(c) * value;
        mean_.at(c) += value * solid_angle(row) / (4 * std::numbers::pi);
      }
      column_cdf_[i] = columns;
    }
    rows += columns * solid_angle(row);
    row_cdf_[row] = rows;
    normalise_cdf(std::span(column_cdf_).subspan(row * width_, width_));
  }
  normalise_cdf(std::span(row_cdf_));
  if (!(rows > 0)) row_cdf_.clear();
}

double EnvironmentImage::row_top(std::size_t row) const {
  return std::cos(std::numbers::pi * static_cast<double>(row) / static_cast<double>(height_));
}

// Solid angle of one texel: the difference of the cosines at its edges, written as a product, times its
// azimuth.
double EnvironmentImage::solid_angle(std::size_t row) const {
  const double center_theta =
      std::numbers::pi * (static_cast<double>(row) + 0.5) / static_cast<double>(height_);
  return 2 * std::sin(center_theta) * std::sin(std::numbers::pi / (2 * static_cast<double>(height_))) * 2 *
         std::numbers::pi / static_cast<double>(width_);
}

std::size_t EnvironmentImage::texel_at(const Imath::V3f& wi) const {
  const Imath::V3d d = Imath::V3d(wi).normalized();
  const double radial = std::hypot(d.dot(forward_), d.dot(right_));
  const double theta = std::atan2(radial, d.dot(up_));
  const double azimuth_fraction = std::atan2(d.dot(right_), d.dot(forward_)) / (2 * std::numbers::pi) + 0.5;
  const auto row = static_cast<std::size_t>(theta / std::numbers::pi * static_cast<double>(height_));
  const auto column = static_cast<std::size_t>(azimuth_fraction * static_cast<double>(width_));
  return std::min(row, height_ - 1) * width_ + std::min(column, width_ - 1);
}

SampledSpectrum EnvironmentImage::radiance(const Imath::V3f& wi,
                                           const SampledSpectrum& wavelengths_nm) const {
  const std::array<float, 3>& texel = texels_[texel_at(wi)];
  return primaries_[0](wavelengths_nm) * texel[0] + primaries_[1](wavelengths_nm) * texel[1] +
         primaries_[2](wavelengths_nm) * texel[2];
}

std::optional<Imath::V3f> EnvironmentImage::sample(Imath::V2f u) const {
  if (row_cdf_.empty()) return std::nullopt;
  const auto row = invert_cdf(std::span(row_cdf_), static_cast<double>(u.y));
  const auto column = invert_cdf(row_of(column_cdf_, row.index, width_), static_cast<double>(u.x));
  // Uniform by solid angle within the texel, hence in azimuth and in the cosine.
  const double azimuth = (static_cast<double>(column.index) + column.within) / static_cast<double>(width_);
  const double phi = 2 * std::numbers::pi * (azimuth - 0.5);
  const double cosine = row_top(row.index) * (1 - row.within) + row_top(row.index + 1) * row.within;
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  return Imath::V3f(forward_ * (sine * std::cos(phi)) + right_ * (sine * std::sin(phi)) + up_ * cosine);
}

float EnvironmentImage::pdf(const Imath::V3f& wi) const {
  if (row_cdf_.empty()) return 0;
  const std::size_t texel = texel_at(wi);
  const std::size_t row = texel / width_;
  return static_cast<float>(cdf_step(std::span(row_cdf_), row) *
                            cdf_step(row_of(column_cdf_, row, width_), texel % width_) / solid_angle(row));
}

Curve EnvironmentImage::mean_radiance() const {
  return sum(sum(scaled(primaries_[0], mean_[0]), scaled(primaries_[1], mean_[1])),
             scaled(primaries_[2], mean_[2]));
}

std::size_t EnvironmentImage::memory_bytes() const {
  return texels_.size() * sizeof(texels_[0]) + (row_cdf_.size() + column_cdf_.size()) * sizeof(double);
}

float EnvironmentLight::pdf(const Shapes& /*shapes*/, const LightHit& at) const {
  return direction_pdf(*this, at.context, at.wi);
}

std::optional<LightSample> EnvironmentLight::sample(const LightQuery& query) const {
  const auto wi = sample_direction(*this, query.context, query.u);
  if (!wi) return std::nullopt;
  // The rounded direction may fall into the next texel. Density and radiance then both belong to that texel.
  const float density = direction_pdf(*this, query.context, *wi);
  if (!(density > 0)) return std::nullopt;
  return LightSample{*wi, kInfinity, 1, density, query.context.point};
}

SampledSpectrum EnvironmentLight::emission_from(const ScaledCurve& emission, const Imath::V3f& wi,
                                                const SampledSpectrum& wavelengths_nm) const {
  return image ? image->radiance(wi, wavelengths_nm) : emission(wavelengths_nm);
}

EmissionDensity EnvironmentLight::emission_density(const EmissionQuery& query) const {
  return {disc_pdf(query.scene_radius_m), direction_pdf(*this, {}, -query.wo)};
}

LightBounds EnvironmentLight::bounds(const Shapes& /*shapes*/, double emission) const {
  LightBounds bounds =
      bounds_at_infinity({0, 0, 1}, 2, emission * std::numbers::pi, emission * 4 * std::numbers::pi);
  bounds.box = Imath::Box3d(Imath::V3d(0));
  bounds.ambient = image == nullptr;
  return bounds;
}

std::optional<LightSample> DirectionalLight::sample(const LightQuery& query) const {
  return LightSample{towards, kInfinity, 1, 1, query.context.point};
}

EmissionDensity DirectionalLight::emission_density(const EmissionQuery& query) const {
  return {disc_pdf(query.scene_radius_m), 1};
}

LightBounds DirectionalLight::bounds(const Shapes& /*shapes*/, double emission) const {
  return bounds_at_infinity(towards, 0, emission, emission);
}

std::optional<BasicRay<double>> DirectionalLight::central_ray(const Ball& sphere) const {
  return central_ray_from(Imath::V3d(towards), sphere);
}

double SunLight::projected_solid_angle() const {
  const auto height = static_cast<double>(cap);
  return std::numbers::pi * height * (2 - height);
}

std::optional<LightSample> SunLight::sample(const LightQuery& query) const {
  const float phi = 2 * std::numbers::pi_v<float> * query.u.y;
  return LightSample{direction_about(towards, query.u.x * cap, phi), kInfinity, 1, cone_pdf(cap),
                     query.context.point};
}

float SunLight::pdf(const Shapes& /*shapes*/, const LightHit& at) const {
  return contains(at.wi) ? cone_pdf(cap) : 0.0F;
}

EmissionDensity SunLight::emission_density(const EmissionQuery& query) const {
  return {disc_pdf(query.scene_radius_m), contains(-query.wo) ? cone_pdf(cap) : 0.0F};
}

LightBounds SunLight::bounds(const Shapes& /*shapes*/, double emission) const {
  const double irradiance = emission * projected_solid_angle();
  return bounds_at_infinity(towards, static_cast<double>(cap), irradiance, irradiance);
}

std::optional<BasicRay<double>> SunLight::central_ray(const Ball& sphere) const {
  return central_ray_from(Imath::V3d(towards), sphere);
}

}  // namespace abbe
