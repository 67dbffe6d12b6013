#pragma once

#include "lens/exit_pupil.h"
#include "lens/field.h"
#include "lens/spectral_system.h"
#include "scene/camera/model.h"

namespace abbe {

/// A lens system ready to look through, all lengths in mm.
struct LensOptics {
  lens::SpectralSystem system;
  lens::ExitPupil pupil;  ///< For a film, and wavelengths, of which nothing else may be asked.
  double
      image_distance_mm;  ///< From the principal plane of image space, paraxially, at the primary wavelength.
  std::optional<lens::Speed>
      speed;  ///< On the axis at the primary wavelength; none where its beam does not get there.

  /// For a film of this grid, in the plane of the image about the axis, and the wavelengths between the ends
  /// of a range. Throws what `lens::ExitPupil` does.
  LensOptics(lens::System lens, double stop_radius_mm, const FilmGrid& grid, double low_nm, double high_nm);
};

}  // namespace abbe
