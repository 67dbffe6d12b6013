#include "lens/spot.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace abbe::lens {
namespace {

using V2d = Imath::V2d;

struct Mean {
  double weight = 0;
  V2d point{0, 0};
  V2d slope{0, 0};
};

Mean mean_of(std::span<const Spot> spots) {
  Mean mean;
  for (const Spot& spot : spots)
    for (const SpotRay& ray : spot.rays) {
      mean.weight += ray.weight;
      mean.point += ray.weight * ray.point;
      mean.slope += ray.weight * ray.slope;
    }
  if (mean.weight > 0) {
    mean.point /= mean.weight;
    mean.slope /= mean.weight;
  }
  return mean;
}

constexpr int kFocusCells = 48;  // across a beam

}  // namespace

Spot spot(const Beam& beam, double field, int side) {
  const SystemAt& at = beam.at();
  Spot spot{at.wavelength_nm, field, {}};
  const Imath::Box2d box = beam.bounds();
  const V2d cell = box.size() / side;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const V2d launched = box.min + V2d((i + 0.5) * cell.x, (j + 0.5) * cell.y);
      const auto pupil = beam.pupil_of(launched);
      if (!pupil || pupil->length() > 1) continue;
      const double power = beam.density(launched) * cell.x * cell.y;
      spot.filled += power;
      const Ray ray = beam.launch(launched);
      const RayPath path = trace(at, ray, Apertures::obeyed);
      if (!path.reached()) continue;
      spot.passed += power;
      const double weight = power * transmittance(at, ray, path);
      spot.transmitted += weight;
      const Imath::V3d& d = path.last.direction;
      spot.rays.push_back({{path.last.origin.x, path.last.origin.y}, {d.x / d.z, d.y / d.z}, weight});
    }
  return spot;
}

std::optional<SpotSize> size_of(std::span<const Spot> spots) {
  const Mean mean = mean_of(spots);
  if (!(mean.weight > 0)) return std::nullopt;
  SpotSize size{mean.point, 0, 0};
  for (const Spot& spot : spots)
    for (const SpotRay& ray : spot.rays) {
      const double d2 = (ray.point - mean.point).length2();
      size.rms_mm += ray.weight * d2;
      size.largest_mm = std::max(size.largest_mm, std::sqrt(d2));
    }
  size.rms_mm = std::sqrt(size.rms_mm / mean.weight);
  return size;
}

// A plane moved by z shifts a ray by z times its slope, so the mean square is a parabola in z.
std::optional<double> best_focus(std::span<const std::vector<Spot>> groups) {
  double across = 0;
  double slopes = 0;
  for (const std::vector<Spot>& group : groups) {
    const Mean mean = mean_of(group);
    if (!(mean.weight > 0)) continue;
    for (const Spot& spot : group)
      for (const SpotRay& ray : spot.rays) {
        const V2d slope = ray.slope - mean.slope;
        across += ray.weight / mean.weight * (ray.point - mean.point).dot(slope);
        slopes += ray.weight / mean.weight * slope.length2();
      }
  }
  constexpr double kParallel = 1e-9;  // differences of slopes due to rounding in sums of many rays
  return slopes > kParallel * kParallel ? std::optional(-across / slopes) : std::nullopt;
}

double geometric_mtf(std::span<const Spot> spots, double per_mm, const V2d& direction) {
  const Mean mean = mean_of(spots);
  if (!(mean.weight > 0)) return 0;
  std::complex<double> sum = 0;
  for (const Spot& spot : spots)
    for (const SpotRay& ray : spot.rays)
      sum += ray.weight *
             std::polar(1.0, -2 * std::numbers::pi * per_mm * (ray.point - mean.point).dot(direction));
  return std::abs(sum) / mean.weight;
}

std::vector<std::vector<Spot>> all_spots(const System& system, double stop_radius_mm, int side) {
  std::vector<std::vector<Spot>> groups;
  for (const double field : system.fields) {
    std::vector<Spot>& group = groups.emplace_back();
    for (const double nm : system.wavelengths_nm) {
      const SystemAt at(system, nm);
      if (const auto beam = Beam::of(at, field, stop_radius_mm))
        group.push_back(spot(*beam, field, side));
      else
        group.push_back({nm, field, {}});
    }
  }
  return groups;
}

std::optional<double> best_focus(const System& system) {
  return best_focus(all_spots(system, stop_radius(system), kFocusCells));
}

}  // namespace abbe::lens
