#include "scene/lights/photometric_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "sampling/discrete.h"
#include "scene/lights/point_light.h"

namespace abbe {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

// Index of the interval of ascending `edges` that contains `x`, which is within them.
std::size_t interval_of(const std::vector<double>& edges, double x) {
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, x);
  return static_cast<std::size_t>(above - edges.begin()) - 1;
}

// The luminaire's axes at some time. C increases counter-clockwise as viewed from the side opposite to the
// axis.
struct LuminaireFrame {
  Imath::V3f x, y, z;

  LuminaireFrame(const PhotometricLight& light, float time)
      : x(moved_direction(light.c0, light.motion.get(), time)),
        z(moved_direction(light.axis, light.motion.get(), time)) {
    y = x.cross(z);
  }
  [[nodiscard]] Imath::V3f to_local(const Imath::V3f& w) const { return {x.dot(w), y.dot(w), z.dot(w)}; }
  [[nodiscard]] Imath::V3f to_world(const Imath::V3f& w) const { return x * w.x + y * w.y + z * w.z; }
};

}  // namespace

IntensityDistribution::IntensityDistribution(const Table& table) : values_(table.candelas) {
  for (const double gamma : table.gammas_deg) gammas_.push_back(gamma * kRadian);
  for (const double plane : table.planes_deg) planes_.push_back(plane * kRadian);
  cdf_.reserve((planes_.size() - 1) * (gammas_.size() - 1));
  for (std::size_t plane = 0; plane + 1 < planes_.size(); ++plane)
    for (std::size_t gamma = 0; gamma + 1 < gammas_.size(); ++gamma)
      cdf_.push_back(flux_ += cell_flux(plane, gamma));
  normalise_cdf(std::span(cdf_));
  for (double& candelas : values_) {
    candelas *= 4 * std::numbers::pi / flux_;
    max_ = std::max(max_, candelas);
  }
}

// Integral of the intensity over a cell. The mean over C is linear in gamma, a at its start and b at its end:
// with h = gamma_1 - gamma_0, the integral of (a + (b - a) (gamma - gamma_0)/h) sin gamma is
//     a (cos gamma_0 - cos gamma_1) + (b - a) ((sin gamma_1 - sin gamma_0)/h - cos gamma_1).
double IntensityDistribution::cell_flux(std::size_t plane, std::size_t gamma) const {
  const double from = gammas_[gamma];
  const double to = gammas_[gamma + 1];
  const double a = (value(plane, gamma) + value(plane + 1, gamma)) / 2;
  const double b = (value(plane, gamma + 1) + value(plane + 1, gamma + 1)) / 2;
  const double integral = a * (std::cos(from) - std::cos(to)) +
                          (b - a) * ((std::sin(to) - std::sin(from)) / (to - from) - std::cos(to));
  return (planes_[plane + 1] - planes_[plane]) * std::max(0.0, integral);
}

double IntensityDistribution::cell_solid_angle(std::size_t plane, std::size_t gamma) const {
  const double center = (gammas_[gamma] + gammas_[gamma + 1]) / 2;
  const double half = (gammas_[gamma + 1] - gammas_[gamma]) / 2;
  return (planes_[plane + 1] - planes_[plane]) * 2 * std::sin(center) * std::sin(half);
}

std::optional<IntensityDistribution::GridCell> IntensityDistribution::cell_of(
    const Imath::V3f& direction) const {
  const Imath::V3d d(direction);
  const double gamma = std::atan2(std::hypot(d.x, d.y), d.z);
  if (gamma < gammas_.front() || gamma > gammas_.back()) return std::nullopt;
  double azimuth = std::atan2(d.y, d.x);
  while (azimuth < planes_.front()) azimuth += 2 * std::numbers::pi;
  const std::size_t row = interval_of(gammas_, gamma);
  const std::size_t plane = interval_of(planes_, azimuth);
  return GridCell{row, plane, (gamma - gammas_[row]) / (gammas_[row + 1] - gammas_[row]),
                  std::clamp((azimuth - planes_[plane]) / (planes_[plane + 1] - planes_[plane]), 0.0, 1.0)};
}

float IntensityDistribution::relative_intensity(const Imath::V3f& direction) const {
  const std::optional<GridCell> at = cell_of(direction);
  if (!at) return 0;
  const auto in_plane = [&](std::size_t plane) {
    return value(plane, at->gamma) * (1 - at->along_gamma) + value(plane, at->gamma + 1) * at->along_gamma;
  };
  return static_cast<float>(in_plane(at->plane) * (1 - at->along_plane) +
                            in_plane(at->plane + 1) * at->along_plane);
}

Imath::V3f IntensityDistribution::sample(Imath::V2f u) const {
  const auto [index, within] = invert_cdf(std::span<const double>(cdf_), static_cast<double>(u.x));
  const std::size_t plane = index / (gammas_.size() - 1);
  const std::size_t gamma = index % (gammas_.size() - 1);
  const double cosine = std::cos(gammas_[gamma]) * (1 - within) + std::cos(gammas_[gamma + 1]) * within;
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  const double azimuth = planes_[plane] + static_cast<double>(u.y) * (planes_[plane + 1] - planes_[plane]);
  return Imath::V3f(Imath::V3d(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine));
}

float IntensityDistribution::pdf(const Imath::V3f& direction) const {
  const std::optional<GridCell> at = cell_of(direction);
  if (!at) return 0;
  return static_cast<float>(cdf_step(std::span<const double>(cdf_), cell(at->plane, at->gamma)) /
                            cell_solid_angle(at->plane, at->gamma));
}

std::size_t IntensityDistribution::memory_bytes(std::size_t gammas, std::size_t planes) {
  return (gammas + planes + 2 * gammas * planes) * sizeof(double);
}

std::optional<LightSample> PhotometricLight::sample(const LightQuery& query) const {
  std::optional<LightSample> sample =
      sample_towards_point(moved_position(position, motion.get(), query.time), query.context.point);
  if (!sample) return std::nullopt;
  const float factor = emission_factor(Imath::V3f(0), -sample->wi, query.time);
  if (!(factor > 0)) return std::nullopt;
  sample->factor *= factor;
  return sample;
}

// 0 where rounding leaves no density, so that photons and connections agree on where it emits.
float PhotometricLight::emission_factor(const Imath::V3f& /*normal*/, const Imath::V3f& wo,
                                        float time) const {
  const Imath::V3f local = LuminaireFrame(*this, time).to_local(wo);
  return distribution->pdf(local) > 0 ? distribution->relative_intensity(local) : 0.0F;
}

Imath::V3f PhotometricLight::emission_direction(const Imath::V3f& /*normal*/, Imath::V2f u,
                                                float time) const {
  return LuminaireFrame(*this, time).to_world(distribution->sample(u));
}

EmissionDensity PhotometricLight::emission_density(const EmissionQuery& query) const {
  return {1, distribution->pdf(LuminaireFrame(*this, query.time).to_local(query.wo))};
}

LightBounds PhotometricLight::bounds(const Shapes& /*shapes*/, double emission) const {
  EmissionCone cone = kEverywhere;
  if (!motion) cone = {Imath::V3d(axis), distribution->max_gamma(), 0};
  return bounds_of_point(position, motion.get(), cone, emission * distribution->max_relative_intensity());
}

}  // namespace abbe
