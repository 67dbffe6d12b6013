#include "lens/clear_apertures.h"

#include <algorithm>
#include <array>

#include "lens/pupil_search.h"
#include "lens/trace.h"

namespace abbe::lens {
namespace {

constexpr int kSteps = 8;  // from the center of the image to its corner

// Points on one radius if the system has rotational symmetry, otherwise on a grid.
std::vector<Imath::V2d> image_points(const System& system, const Imath::V2d& half_image_mm) {
  std::vector<Imath::V2d> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double fraction = static_cast<double>(i) / kSteps;
    if (!system.displaced()) {
      points.emplace_back(half_image_mm.length() * fraction, 0);
      continue;
    }
    for (int j = 0; j <= kSteps; ++j)
      points.push_back(half_image_mm * Imath::V2d(2 * fraction - 1, 2.0 * j / kSteps - 1));
  }
  return points;
}

}  // namespace

System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm, double low_nm,
                            double high_nm) {
  System result = system.system();
  // A round stop, so that one radius represents all directions.
  const SpectralSystem round(with_round_stop(result), system.stop_radius_mm());
  std::vector<double> radius_mm(result.surfaces.size(), 0);
  for (const double nm : std::array{low_nm, (low_nm + high_nm) / 2, high_nm}) {
    const SystemAt at(round.system(), nm);
    for (const Imath::V2d& image : image_points(result, half_image_mm))
      for (const Ray& leaving : search_pupil(round, image, nm).leaving) {
        const RayPath path = trace(at, {leaving.origin, -leaving.direction}, Apertures::obeyed);
        for (std::size_t i = 0; i < path.hits.size(); ++i)
          radius_mm[i] = std::max(radius_mm[i], system.local_of(i, path.hits[i].point).length());
      }
  }
  for (std::size_t i = 0; i < radius_mm.size(); ++i)
    if (!result.surfaces[i].semi_aperture_mm) result.surfaces[i].semi_aperture_mm = radius_mm[i];
  return result;
}

}  // namespace abbe::lens
