#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/route.h"
#include "lens/seidel.h"

namespace abbe {

/// What a lens does at one field.
struct LensFieldFigures {
  double field;                                    ///< As in `lens::System`.
  std::vector<lens::Spot> spots;                   ///< By wavelength.
  std::vector<std::optional<lens::Chief>> chiefs;  ///< By wavelength.
  std::optional<double> relative_illumination;     ///< At the primary wavelength.
  std::vector<lens::RayFan> fans;                  ///< By wavelength; empty where no chief ray gets through.
  std::vector<double> tangential_mtf;              ///< By frequency: lines across y, all wavelengths alike.
  std::vector<double> sagittal_mtf;

  /// The height of the chief ray at the shortest wavelength less that at the longest [mm].
  [[nodiscard]] std::optional<double> lateral_color_mm() const;
};

/// What a ghost of a point on the axis is like in the plane of the image, at the primary wavelength.
struct GhostFigures {
  lens::Ghost ghost;
  double focus_mm;     ///< Of its light behind that plane, paraxially.
  double diameter_mm;  ///< Of its light there, as in `lens::GhostFocus`.
};

/// All that is worked out of a lens.
struct LensFigures {
  lens::System system;
  double stop_radius_mm;
  std::vector<lens::FirstOrder> first_order;      ///< By wavelength.
  std::vector<std::optional<lens::Speed>> speed;  ///< By wavelength; none where the axis is blocked.
  lens::SeidelSums seidel;              ///< At the primary wavelength, of the field furthest from the axis;
                                        ///< not numbers where its speed is none.
  std::optional<double> best_focus_mm;  ///< As `lens::best_focus` tells.
  std::vector<double> frequencies_per_mm;
  std::vector<LensFieldFigures> fields;
  std::vector<GhostFigures> ghosts;  ///< The brightest first, by reflectance over area.

  /// How a field is told: degrees of objects at infinity, millimetres of near ones.
  [[nodiscard]] std::string field_name(double field) const;
};

/// How finely to look.
struct LensLook {
  std::vector<double> frequencies_per_mm{10, 20, 40};
  int cells = 100;    ///< Of the rectangle around a beam, each way.
  int fan_rays = 41;  ///< In each fan.
};

/// Works them out. Throws as `lens::stop_radius`.
[[nodiscard]] LensFigures lens_figures(const lens::System& system, const LensLook& look);

}  // namespace abbe
