#include "lens/clear_apertures.h"

#include <algorithm>
#include <array>

#include "lens/pupil_search.h"
#include "lens/trace.h"

namespace abbe::lens {
namespace {

constexpr int kSteps = 8;  // from the middle of the image to its corner

// Along one radius where all are alike.
std::vector<Imath::V2d> image_points(const System& system, const Imath::V2d& half_image_mm) {
  std::vector<Imath::V2d> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    if (!system.displaced()) {
      points.emplace_back(half_image_mm.length() * share, 0);
      continue;
    }
    for (int j = 0; j <= kSteps; ++j)
      points.push_back(half_image_mm * Imath::V2d(2 * share - 1, 2.0 * j / kSteps - 1));
  }
  return points;
}

}  // namespace

System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm, double low_nm,
                            double high_nm) {
  System with = system.system();
  // Of which what passes along a radius is what passes all around.
  const SpectralSystem round(with_round_stop(with), system.stop_radius_mm());
  std::vector<double> reach(with.surfaces.size(), 0);
  for (const double nm : std::array{low_nm, (low_nm + high_nm) / 2, high_nm}) {
    const SystemAt at(round.system(), nm);
    for (const Imath::V2d& image : image_points(with, half_image_mm))
      for (const Ray& leaving : search_pupil(round, image, nm).leaving) {
        const RayPath path = trace(at, {leaving.origin, -leaving.direction}, Apertures::obeyed);
        for (std::size_t i = 0; i < path.hits.size(); ++i)
          reach[i] = std::max(reach[i], system.local_of(i, path.hits[i].point).length());
      }
  }
  for (std::size_t i = 0; i < reach.size(); ++i)
    if (!with.surfaces[i].semi_aperture_mm) with.surfaces[i].semi_aperture_mm = reach[i];
  return with;
}

}  // namespace abbe::lens
