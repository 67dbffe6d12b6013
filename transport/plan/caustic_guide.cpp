#include "transport/plan/caustic_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "scene/shapes/ray.h"

namespace abbe {
namespace {

using Imath::V3f;
using Photons = std::span<const CausticPhoton>;
using LobePacket = CausticLobes::LobePacket;

constexpr std::size_t kMaxRegionPhotons = 32;  // per region
constexpr std::size_t kMinRegionPhotons = 8;   // fewer are not used
constexpr float kMinWidth = 1e-4F;
// fraction of a region's diagonal around its photons in which it is valid
constexpr float kRegionMargin = 0.5F;
// Minimum ratio of the lobes' pdf to that of a white surface; below it a region has no lobes.
constexpr float kMinGain = 8;

// Target of a lobe: a point, or a direction that is the same from everywhere.
struct LobeTarget {
  V3f at;
  float near;  // 1 for a point, 0 for a direction
};

V3f axis_from(const V3f& point, const LobeTarget& target) {
  return (target.at - point * target.near).normalized();
}

// Point on a photon's ray, back at a distance that may be infinite.
LobeTarget target_of(const CausticPhoton& photon, float distance) {
  if (!std::isfinite(distance)) return {photon.from, 0};
  return {photon.point + photon.from * distance, 1};
}

// Lobes without their probabilities.
std::vector<LobePacket> packets_of(std::span<const LobeTarget> targets) {
  std::vector<LobePacket> lobes((targets.size() + CausticLobes::kLobesPerPacket - 1) /
                                CausticLobes::kLobesPerPacket);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    LobePacket& packet = lobes[i / CausticLobes::kLobesPerPacket];
    const std::size_t k = i % CausticLobes::kLobesPerPacket;
    packet.x[k] = targets[i].at.x;
    packet.y[k] = targets[i].at.y;
    packet.z[k] = targets[i].at.z;
    packet.near[k] = targets[i].near;
  }
  return lobes;
}

// tan^2 of the angles between a photon's direction and the lobes' axes; infinite from 90 degrees on. Small
// angles are computed from the difference of the unit vectors, which preserves their digits.
LobePacket::Floats tan2_to_axes(const CausticPhoton& photon, const LobePacket& lobes) {
  LobePacket::Floats tan2;
  for (std::size_t k = 0; k < CausticLobes::kLobesPerPacket; ++k) {
    const V3f to(lobes.x[k] - photon.point.x * lobes.near[k], lobes.y[k] - photon.point.y * lobes.near[k],
                 lobes.z[k] - photon.point.z * lobes.near[k]);
    const V3f axis = to / std::sqrt(to.length2());
    const float cosine = photon.from.dot(axis);
    const V3f difference = photon.from - axis;
    // Explicit fma as for a single axis: the compiler would otherwise fuse a different product here.
    const float chord2 = std::fma(difference.z, difference.z,
                                  std::fma(difference.x, difference.x, difference.y * difference.y));
    const float known = chord2 / 2 * (1 + cosine) / (cosine * cosine);
    tan2[k] = cosine > 0 ? known : std::numeric_limits<float>::infinity();
  }
  return tan2;
}

// Mean logarithm of the angle between each photon's direction and the nearest axis of the others. It measures
// how sharply photons predict one another.
float log_spread(Photons photons, std::span<const LobeTarget> targets) {
  constexpr float kWidest = 10;  // tangent; larger angles predict nothing
  const std::vector<LobePacket> lobes = packets_of(targets);
  float sum = 0;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    float nearest = kWidest * kWidest;
    for (std::size_t j = 0; j < targets.size();) {
      const LobePacket::Floats tan2 = tan2_to_axes(photons[i], lobes[j / CausticLobes::kLobesPerPacket]);
      for (std::size_t k = 0; k < tan2.size() && j < targets.size(); ++k, ++j)
        if (j != i) nearest = std::min(nearest, tan2[k]);
    }
    sum += std::log(std::max(nearest, kMinWidth * kMinWidth)) / 2;
  }
  return sum / static_cast<float>(photons.size());
}

struct Focus {
  std::vector<LobeTarget> targets;
  float width;
};

// Targets at the distance that predicts best.
Focus sharpest(Photons photons) {
  Focus best;
  float min_spread = std::numeric_limits<float>::infinity();
  for (const auto distance : {&CausticPhoton::last_distance, &CausticPhoton::path_distance}) {
    std::vector<LobeTarget> targets;
    for (const CausticPhoton& photon : photons) targets.push_back(target_of(photon, photon.*distance));
    const float spread = log_spread(photons, targets);
    if (!(spread < min_spread)) continue;
    min_spread = spread;
    best.targets = std::move(targets);
  }
  // Twice the spacing of neighbours, so that the lobes leave no gaps.
  best.width = std::max(kMinWidth, 2 * std::exp(min_spread));
  return best;
}

// Geometric mean of the ratio between the lobes' pdf and that of a white surface at the photons.
float gain(Photons photons, const CausticLobes& lobes) {
  float sum = 0;
  for (const CausticPhoton& photon : photons)
    sum += std::log(std::numbers::pi_v<float> * lobes.pdf(photon.point, photon.from));
  return std::exp(sum / static_cast<float>(photons.size()));
}

// Lobes with probabilities in proportion to the power of their photons.
std::vector<LobePacket> lobes_of(Photons photons, std::span<const LobeTarget> targets) {
  float total_power = 0;
  for (const CausticPhoton& photon : photons) total_power += photon.power;
  std::vector<LobePacket> lobes = packets_of(targets);
  for (std::size_t i = 0; i < targets.size(); ++i)
    lobes[i / CausticLobes::kLobesPerPacket].probability[i % CausticLobes::kLobesPerPacket] =
        photons[i].power / total_power;
  return lobes;
}

// Area of the surface on which photons lie: that of a rectangle, corrected for the expected margin between
// the photons and its edges.
float area_of(Photons photons) {
  Imath::Box3f box;
  for (const CausticPhoton& photon : photons) box.extendBy(photon.point);
  const V3f size = box.size();
  const float min_size = std::min({size.x, size.y, size.z});
  const float area = min_size > 0 ? size.x * size.y * size.z / min_size
                                  : std::max({size.x * size.y, size.y * size.z, size.z * size.x});
  const auto n = static_cast<float>(photons.size());
  return area * (n + 1) * (n + 1) / ((n - 1) * (n - 1));
}

// If q paths are added per vertex, light from the lobes has the variance C^2/q and other light B^2. C is the
// irradiance of caustics and B that of the other light. Let k be the cost of an added path over that of one
// vertex: (B^2 + C^2/q)(1 + k q) is minimal for q = C/(B sqrt(k)). C/(C + B) is that for k near 1 and small
// C, and remains below one path. Lights are sampled by NEE, so that B is the light from other surfaces, a
// quarter of the unoccluded irradiance. A quarter of that is used: lobes that do not fit their caustic
// multiply C^2, and the part of a caustic that they miss dominates the error.
float added_path_probability(Photons photons) {
  constexpr float kSteps = 64;
  constexpr float kMaxSteps = 48;
  float power = 0;
  float unoccluded = 0;
  for (const CausticPhoton& photon : photons) {
    power += photon.power;
    unoccluded += photon.unoccluded_irradiance / static_cast<float>(photons.size());
  }
  const float others = unoccluded / 16 * area_of(photons);  // B/C times the photons' power
  return std::clamp(std::round(kSteps * power / (power + others)), 1.0F, kMaxSteps) / kSteps;
}

// Lobe selected by `u` in [0, 1); the last one if rounding leaves a remainder.
LobeTarget chosen(std::span<const LobePacket> lobes, float u) {
  LobeTarget target{};
  for (const LobePacket& packet : lobes)
    for (std::size_t k = 0; k < CausticLobes::kLobesPerPacket; ++k) {
      if (!(packet.probability[k] > 0)) continue;
      target = {{packet.x[k], packet.y[k], packet.z[k]}, packet.near[k]};
      u -= packet.probability[k];
      if (u < 0) return target;
    }
  return target;
}

}  // namespace

V3f CausticLobes::sample(const V3f& point, float lobe, Imath::V2f u) const {
  const float radius = width_ * std::sqrt(u.x / (1 - u.x));
  const float phi = 2 * std::numbers::pi_v<float> * u.y;
  return Basis<float>(axis_from(point, chosen(lobes_, lobe)))
      .to_world({radius * std::cos(phi), radius * std::sin(phi), 1})
      .normalized();
}

// Let c be the cosine and h the chord of the angle: tan^2 is h^2 (1 + c)/(2 c^2), and the pdf of a lobe is
// a^2 c / (pi (a^2 c^2 + h^2 (1 + c)/2)^2).
float CausticLobes::pdf(const V3f& point, const V3f& direction) const {
  const float a2 = width_ * width_;
  float sum = 0;
  for (const LobePacket& packet : lobes_) {
    LobePacket::Floats density;
    for (std::size_t k = 0; k < kLobesPerPacket; ++k) {
      const float x = packet.x[k] - packet.near[k] * point.x;
      const float y = packet.y[k] - packet.near[k] * point.y;
      const float z = packet.z[k] - packet.near[k] * point.z;
      const float scale = 1 / std::sqrt(x * x + y * y + z * z + std::numeric_limits<float>::min());
      const float dx = x * scale - direction.x;
      const float dy = y * scale - direction.y;
      const float dz = z * scale - direction.z;
      const float cosine = std::max(0.0F, (x * direction.x + y * direction.y + z * direction.z) * scale);
      const float spread = a2 * cosine * cosine + (dx * dx + dy * dy + dz * dz) * (1 + cosine) / 2;
      density[k] = packet.probability[k] * a2 * cosine / (spread * spread);
    }
    for (const float one : density) sum += one;
  }
  return sum / std::numbers::pi_v<float>;
}

CausticGuide::CausticGuide(std::vector<CausticPhoton> photons, const Imath::Box3d& scene) {
  std::erase_if(photons, [](const CausticPhoton& photon) {
    return !(photon.power > 0 && std::isfinite(photon.power));
  });
  if (photons.size() < kMinRegionPhotons) return;
  // Offset so that no cell boundary coincides with a flat shape: rounding would put a floor's photons on
  // either side.
  const Imath::V3d size(1.3 * scene.size()[static_cast<int>(scene.majorAxis())]);
  const V3f low(scene.min - size * 0.1057);
  build({photons, photons, {low, low + V3f(size)}, 0});
  if (lobes_.empty()) *this = {};
}

// The planes that divide cells do not depend on the photons, so that an additional photon changes only its
// own region. A cell with too few photons uses the lobes of the cell around it.
void CausticGuide::build(Cell cell) {
  constexpr int kMaxTreeDepth = 60;  // cells of a millionth of the size: coincident photons are not separated
  const std::size_t here = nodes_.size();
  nodes_.push_back({.region = static_cast<std::uint32_t>(regions_.size())});
  if (cell.photons.size() >= kMinRegionPhotons) cell.fallback = cell.photons;
  if (cell.photons.size() <= kMaxRegionPhotons || cell.depth == kMaxTreeDepth)
    return add_region(cell.fallback);
  const int axis = cell.depth % 3;
  const float at = (cell.box.min[axis] + cell.box.max[axis]) / 2;
  const auto above =
      std::stable_partition(cell.photons.begin(), cell.photons.end(),
                            [axis, at](const CausticPhoton& photon) { return photon.point[axis] < at; });
  const auto below = static_cast<std::size_t>(above - cell.photons.begin());
  nodes_[here].axis = axis;
  nodes_[here].at = at;
  Cell part{cell.photons.first(below), cell.fallback, cell.box, cell.depth + 1};
  part.box.max[axis] = at;
  build(part);
  nodes_[here].above = static_cast<std::uint32_t>(nodes_.size());
  part = {cell.photons.subspan(below), cell.fallback, cell.box, cell.depth + 1};
  part.box.min[axis] = at;
  build(part);
}

void CausticGuide::add_region(Photons region_photons) {
  std::vector<CausticPhoton> photons;
  const std::size_t count = std::min(region_photons.size(), kMaxRegionPhotons);
  for (std::size_t i = 0; i < count; ++i)
    photons.push_back(region_photons[i * region_photons.size() / count]);
  Region region;
  region.first = static_cast<std::uint32_t>(lobes_.size());
  for (const CausticPhoton& photon : region_photons) region.box.extendBy(photon.point);
  const V3f margin(kRegionMargin * region.box.size().length());
  region.box = {region.box.min - margin, region.box.max + margin};
  const Focus focus = sharpest(photons);
  const std::vector<LobePacket> lobes = lobes_of(photons, focus.targets);
  if (gain(photons, CausticLobes(lobes, focus.width, 1)) > kMinGain) {
    region.probability = added_path_probability(region_photons);
    region.count = static_cast<std::uint32_t>(lobes.size());
    region.width = focus.width;
    lobes_.insert(lobes_.end(), lobes.begin(), lobes.end());
  }
  regions_.push_back(region);
}

CausticLobes CausticGuide::at(const V3f& point) const {
  if (nodes_.empty()) return {};
  std::uint32_t node = 0;
  while (nodes_[node].axis >= 0)
    node = point[nodes_[node].axis] < nodes_[node].at ? node + 1 : nodes_[node].above;
  const Region& region = regions_[nodes_[node].region];
  if (region.count == 0 || !region.box.intersects(point)) return {};
  return {std::span(lobes_).subspan(region.first, region.count), region.width, region.probability};
}

}  // namespace abbe
