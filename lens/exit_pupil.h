#pragma once

#include <numbers>
#include <vector>

#include "lens/spectral_system.h"

namespace abbe::lens {

/// Ellipse in the tangent plane of the last vertex [mm], with one axis along the unit vector `along`.
struct PupilBound {
  Imath::V2d center{0, 0};  ///< Components along `along` and along its normal (-along.y, along.x).
  Imath::V2d semi{0, 0};    ///< Semi-axes along `along` and across it; 0 if no light arrives.
  Imath::V2d along{1, 0};   ///< Unit vector in (x, y).

  /// Area [mm^2]; 0 if no light arrives.
  [[nodiscard]] double area() const { return std::numbers::pi * semi.x * semi.y; }
  /// Maps a point of the unit disc to (x, y) in the ellipse [mm]. Equal areas stay equal.
  [[nodiscard]] Imath::V2d point(const Imath::V2d& disc) const;
  /// True if (x, y) of the tangent plane [mm] is inside the ellipse; always false for an area of 0.
  [[nodiscard]] bool contains(const Imath::V2d& point) const;
};

/// Disc in front of a lens through which all its light enters, centered on the axis and normal to it [mm].
struct EntranceDisc {
  double z;
  double radius;
};

/// Bounds of the exit pupil from each point of the image, and of the rays that enter the lens, found once by
/// tracing from the image. No light that forms the image passes outside them. A stop with blades counts as
/// its circle. Each bound contains the rims at neighbouring image points and at the edge of the illuminated
/// image, at both ends of the wavelength range and its center. Between the points they follow the center of
/// the pupil. Light far outside the beam, which surfaces without clear apertures would transmit, is ignored.
class ExitPupil {
 public:
  /// Bounds the pupil for an image with these half sides [mm], centered on the axis, and wavelengths from
  /// `low_nm` to `high_nm`. Throws Error{scene} if the pupil has no bound, if no light arrives, or if the
  /// field exceeds 87 degrees from the axis.
  ExitPupil(const SpectralSystem& system, const Imath::V2d& half_image_mm, double low_nm, double high_nm);

  /// Bound for light that arrives at a point (x, y) of the image [mm]. Points outside the image take the
  /// nearest bound, shifted.
  [[nodiscard]] PupilBound bound(const Imath::V2d& image) const;
  [[nodiscard]] const EntranceDisc& entrance() const { return entrance_; }
  /// Radius around the axis within which light crosses the plane of the first vertex [mm].
  [[nodiscard]] double front_radius() const { return front_radius_; }
  /// Lower bound of the cosine of the angle of incidence on the image, over all its points.
  [[nodiscard]] double min_cosine() const { return min_cosine_; }

 private:
  // Image point at a grid position in cells; on a radius, only the column counts.
  [[nodiscard]] Imath::V2d at(double column, double row) const;

  Imath::V2d half_image_;
  bool centred_;  // rotational symmetry: bounds depend only on the distance from the axis
  int columns_;   // of the bounds; the only dimension for rotational symmetry
  int rows_ = 1;
  Imath::V2d cell_mm_;  // for rotational symmetry, only x is used
  double shift_;        // movement of the pupil over that of the image point
  std::vector<PupilBound> bounds_;
  EntranceDisc entrance_{0, 0};
  double front_radius_ = 0;
  double min_cosine_ = 1;
};

/// The system with a clear aperture at every surface. Surfaces without one get the smallest that transmits
/// all light to an image with these half sides [mm], at `low_nm`, `high_nm` and the wavelength midway. Stops
/// with blades count as their circle. A surface without light gets 0. Throws Error{scene} if the passing rays
/// have no bound.
[[nodiscard]] System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm,
                                          double low_nm, double high_nm);

}  // namespace abbe::lens
