#include "transport/plan/caustic_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "scene/shapes/basis.h"

namespace abbe {
namespace {

using Imath::V3f;
using Photons = std::span<const CausticPhoton>;
using LobePacket = CausticLobes::Lobes;

constexpr std::size_t kMostPhotons = 32;        // of a region,
constexpr std::size_t kLeastRegionPhotons = 8;  // and fewer than these tell nothing
constexpr float kLeastWidth = 1e-4F;
constexpr float kRegionMargin = 0.5F;  // of a region's diagonal: how far beyond its photons they are asked
// Lobes that are no denser than this times a white surface's own are left.
constexpr float kLeastGain = 8;

// Where a lobe points to: a point, or of one that points the same way from everywhere the direction.
struct LobeTarget {
  V3f at;
  float near;  // 1, or 0
};

V3f axis_from(const V3f& point, const LobeTarget& target) {
  return (target.at - point * target.near).normalized();
}

// A point on a photon's way back, at a distance that may be infinite.
LobeTarget target_of(const CausticPhoton& photon, float distance) {
  if (!std::isfinite(distance)) return {photon.from, 0};
  return {photon.point + photon.from * distance, 1};
}

// Without the shares of any.
std::vector<LobePacket> packets_of(std::span<const LobeTarget> targets) {
  std::vector<LobePacket> lobes((targets.size() + CausticLobes::kTogether - 1) / CausticLobes::kTogether);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    LobePacket& some = lobes[i / CausticLobes::kTogether];
    const std::size_t k = i % CausticLobes::kTogether;
    some.x[k] = targets[i].at.x;
    some.y[k] = targets[i].at.y;
    some.z[k] = targets[i].at.z;
    some.near[k] = targets[i].near;
  }
  return lobes;
}

// tan^2 of the angles between a photon's way and the axes of lobes, infinite from a right angle on: of small
// ones by the difference of the unit vectors, which keeps its digits.
LobePacket::Numbers tan2_to_axes(const CausticPhoton& photon, const LobePacket& lobes) {
  LobePacket::Numbers tan2;
  for (std::size_t k = 0; k < CausticLobes::kTogether; ++k) {
    const V3f to(lobes.x[k] - photon.point.x * lobes.near[k], lobes.y[k] - photon.point.y * lobes.near[k],
                 lobes.z[k] - photon.point.z * lobes.near[k]);
    const V3f axis = to / std::sqrt(to.length2());
    const float cosine = photon.from.dot(axis);
    const V3f apart = photon.from - axis;
    // Fused as for a single axis: left to itself the compiler would fuse another of the products here.
    const float chord2 = std::fma(apart.z, apart.z, std::fma(apart.x, apart.x, apart.y * apart.y));
    const float known = chord2 / 2 * (1 + cosine) / (cosine * cosine);
    tan2[k] = cosine > 0 ? known : std::numeric_limits<float>::infinity();
  }
  return tan2;
}

// The mean logarithm of the angle between each photon's way and the nearest axis of the others: how sharply
// they predict one another.
float log_spread(Photons photons, std::span<const LobeTarget> targets) {
  constexpr float kWidest = 10;  // of a tangent: beyond, they tell nothing
  const std::vector<LobePacket> lobes = packets_of(targets);
  float sum = 0;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    float nearest = kWidest * kWidest;
    for (std::size_t j = 0; j < targets.size();) {
      const LobePacket::Numbers tan2 = tan2_to_axes(photons[i], lobes[j / CausticLobes::kTogether]);
      for (std::size_t k = 0; k < tan2.size() && j < targets.size(); ++k, ++j)
        if (j != i) nearest = std::min(nearest, tan2[k]);
    }
    sum += std::log(std::max(nearest, kLeastWidth * kLeastWidth)) / 2;
  }
  return sum / static_cast<float>(photons.size());
}

struct Focus {
  std::vector<LobeTarget> targets;
  float width;
};

// Of the choices of targets the one that predicts best.
Focus sharpest(Photons photons) {
  Focus best;
  float least = std::numeric_limits<float>::infinity();
  for (const auto distance : {&CausticPhoton::last_distance, &CausticPhoton::whole_distance}) {
    std::vector<LobeTarget> targets;
    for (const CausticPhoton& photon : photons) targets.push_back(target_of(photon, photon.*distance));
    const float spread = log_spread(photons, targets);
    if (!(spread < least)) continue;
    least = spread;
    best.targets = std::move(targets);
  }
  // Twice the distance of neighbours, so that the lobes leave no gaps.
  best.width = std::max(kLeastWidth, 2 * std::exp(least));
  return best;
}

// Density of what the photons have shown, over that of a white surface: its mean logarithm, as a factor.
float gain(Photons photons, const CausticLobes& lobes) {
  float sum = 0;
  for (const CausticPhoton& photon : photons)
    sum += std::log(std::numbers::pi_v<float> * lobes.pdf(photon.point, photon.from));
  return std::exp(sum / static_cast<float>(photons.size()));
}

// Chosen by the power of their photons.
std::vector<LobePacket> lobes_of(Photons photons, std::span<const LobeTarget> targets) {
  float whole = 0;
  for (const CausticPhoton& photon : photons) whole += photon.power;
  std::vector<LobePacket> lobes = packets_of(targets);
  for (std::size_t i = 0; i < targets.size(); ++i)
    lobes[i / CausticLobes::kTogether].share[i % CausticLobes::kTogether] = photons[i].power / whole;
  return lobes;
}

// Area of the surface that photons lie on: of a rectangle that holds them as a larger one would hold more.
float area_of(Photons photons) {
  Imath::Box3f box;
  for (const CausticPhoton& photon : photons) box.extendBy(photon.point);
  const V3f size = box.size();
  const float least = std::min({size.x, size.y, size.z});
  const float area = least > 0 ? size.x * size.y * size.z / least
                               : std::max({size.x * size.y, size.y * size.z, size.z * size.x});
  const auto n = static_cast<float>(photons.size());
  return area * (n + 1) * (n + 1) / ((n - 1) * (n - 1));
}

// If q paths are added per vertex, light from the lobes has the variance C^2/q and other light B^2. C is the
// irradiance of caustics and B that of the other light. Let k be the cost of an added path over that of one
// vertex: (B^2 + C^2/q)(1 + k q) is least for q = C/(B sqrt(k)). C/(C + B) is that for k near 1 and small C,
// and remains below one path. Lights are connected to, so that B is what comes by other surfaces, a quarter
// of the unoccluded irradiance. A quarter of that is used: lobes that do not fit their caustic multiply C^2,
// and what they miss of a caustic is the worst of it.
float share_of(Photons photons) {
  constexpr float kSteps = 64;
  constexpr float kMost = 48;
  float power = 0;
  float unhindered = 0;
  for (const CausticPhoton& photon : photons) {
    power += photon.power;
    unhindered += photon.unhindered / static_cast<float>(photons.size());
  }
  const float others = unhindered / 16 * area_of(photons);  // B/C times the photons' power
  return std::clamp(std::round(kSteps * power / (power + others)), 1.0F, kMost) / kSteps;
}

// The lobe that `u` in [0, 1) falls to; the last one if rounding leaves something over.
LobeTarget chosen(std::span<const LobePacket> lobes, float u) {
  LobeTarget target{};
  for (const LobePacket& some : lobes)
    for (std::size_t k = 0; k < CausticLobes::kTogether; ++k) {
      if (!(some.share[k] > 0)) continue;
      target = {{some.x[k], some.y[k], some.z[k]}, some.near[k]};
      u -= some.share[k];
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

// With c the cosine and h the chord of the angle, tan^2 is h^2 (1 + c)/(2 c^2), so that the density of a lobe
// is a^2 c / (pi (a^2 c^2 + h^2 (1 + c)/2)^2).
float CausticLobes::pdf(const V3f& point, const V3f& direction) const {
  const float a2 = width_ * width_;
  float sum = 0;
  for (const LobePacket& some : lobes_) {
    LobePacket::Numbers density;
    for (std::size_t k = 0; k < kTogether; ++k) {
      const float x = some.x[k] - some.near[k] * point.x;
      const float y = some.y[k] - some.near[k] * point.y;
      const float z = some.z[k] - some.near[k] * point.z;
      const float scale = 1 / std::sqrt(x * x + y * y + z * z + std::numeric_limits<float>::min());
      const float dx = x * scale - direction.x;
      const float dy = y * scale - direction.y;
      const float dz = z * scale - direction.z;
      const float cosine = std::max(0.0F, (x * direction.x + y * direction.y + z * direction.z) * scale);
      const float spread = a2 * cosine * cosine + (dx * dx + dy * dy + dz * dz) * (1 + cosine) / 2;
      density[k] = some.share[k] * a2 * cosine / (spread * spread);
    }
    for (const float one : density) sum += one;
  }
  return sum / std::numbers::pi_v<float>;
}

CausticGuide::CausticGuide(std::vector<CausticPhoton> photons, const Imath::Box3d& scene) {
  std::erase_if(photons, [](const CausticPhoton& photon) {
    return !(photon.power > 0 && std::isfinite(photon.power));
  });
  if (photons.size() < kLeastRegionPhotons) return;
  // So placed that no cell ends on what is flat: a floor's photons would fall to either side by rounding.
  const Imath::V3d size(1.3 * scene.size()[static_cast<int>(scene.majorAxis())]);
  const V3f low(scene.min - size * 0.1057);
  build({photons, photons, {low, low + V3f(size)}, 0});
  if (lobes_.empty()) *this = {};
}

// Where the cell is divided does not depend on the photons, so that one more or less changes no region but
// its own. A cell of too few has the lobes of the one around it.
void CausticGuide::build(Cell cell) {
  constexpr int kDeepest = 60;  // cells of a millionth: photons that share a place are left together
  const std::size_t here = nodes_.size();
  nodes_.push_back({.region = static_cast<std::uint32_t>(regions_.size())});
  if (cell.photons.size() >= kLeastRegionPhotons) cell.around = cell.photons;
  if (cell.photons.size() <= kMostPhotons || cell.depth == kDeepest) return add_region(cell.around);
  const int axis = cell.depth % 3;
  const float at = (cell.box.min[axis] + cell.box.max[axis]) / 2;
  const auto above =
      std::stable_partition(cell.photons.begin(), cell.photons.end(),
                            [axis, at](const CausticPhoton& photon) { return photon.point[axis] < at; });
  const auto below = static_cast<std::size_t>(above - cell.photons.begin());
  nodes_[here].axis = axis;
  nodes_[here].at = at;
  Cell part{cell.photons.first(below), cell.around, cell.box, cell.depth + 1};
  part.box.max[axis] = at;
  build(part);
  nodes_[here].above = static_cast<std::uint32_t>(nodes_.size());
  part = {cell.photons.subspan(below), cell.around, cell.box, cell.depth + 1};
  part.box.min[axis] = at;
  build(part);
}

void CausticGuide::add_region(Photons all) {
  std::vector<CausticPhoton> photons;
  const std::size_t count = std::min(all.size(), kMostPhotons);
  for (std::size_t i = 0; i < count; ++i) photons.push_back(all[i * all.size() / count]);
  Region region;
  region.first = static_cast<std::uint32_t>(lobes_.size());
  for (const CausticPhoton& photon : all) region.box.extendBy(photon.point);
  const V3f margin(kRegionMargin * region.box.size().length());
  region.box = {region.box.min - margin, region.box.max + margin};
  const Focus focus = sharpest(photons);
  const std::vector<LobePacket> lobes = lobes_of(photons, focus.targets);
  if (gain(photons, CausticLobes(lobes, focus.width, 1)) > kLeastGain) {
    region.share = share_of(all);
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
  return {std::span(lobes_).subspan(region.first, region.count), region.width, region.share};
}

}  // namespace abbe
