#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "lens/spectral_system.h"

namespace abbe::lens {

/// An ellipse in the tangent plane of the last vertex [mm], one axis of it along the unit vector `along`.
struct PupilBound {
  Imath::V2d center{0, 0};
  Imath::V2d semi{0, 0};  ///< Axes along `along` and across it; 0 where no light comes through.
  Imath::V2d along{1, 0};

  [[nodiscard]] double area() const { return std::numbers::pi * semi.x * semi.y; }
  /// The point of it that one of the unit disc stands for.
  [[nodiscard]] Imath::V2d point(const Imath::V2d& disc) const;
  [[nodiscard]] bool contains(const Imath::V2d& point) const;
};

/// What light of an object must come in through, in front of a lens: a disc about the axis across it [mm].
struct EntranceDisc {
  double z;
  double radius;
};

/// Bounds of the exit pupil, of a stop with blades that of its circle, as the points of an image see it,
/// found once by rays from there, and of where all of these rays come in. Nothing passes outside of them:
/// they are those of the rim at neighbouring points of the image, next to where light ends too, and at some
/// wavelengths together, each moved as the middle of the pupil is between the points, a little widened. Where
/// surfaces without clear apertures would let light through by ways apart from the beam, far outside of it,
/// that light is none of the lens's.
class ExitPupil {
 public:
  /// For an image of these half sides [mm] and wavelengths between the ends of the range. Throws
  /// Error{scene} where the lens has no bound or sees nothing there, or sees more than 87 degrees off its
  /// axis.
  ExitPupil(const SpectralSystem& system, const Imath::V2d& half_image_mm, double low_nm, double high_nm);

  /// For light to a point of the image [mm].
  [[nodiscard]] PupilBound bound(const Imath::V2d& image) const;
  [[nodiscard]] const EntranceDisc& entrance() const { return entrance_; }
  /// The least cosine of an angle of incidence on the image.
  [[nodiscard]] double least_cosine() const { return least_cosine_; }

 private:
  void bound_along_radius(const SpectralSystem& system, std::span<const double> wavelengths_nm);
  void bound_all_over(const SpectralSystem& system, std::span<const double> wavelengths_nm);

  // The point of the image that is so many cells from where they begin; along the radius for columns alone.
  [[nodiscard]] Imath::V2d at(double column, double row) const;

  Imath::V2d half_image_;
  bool centred_;  // so that the distance from the axis alone matters
  int columns_;   // of the bounds; along the radius these are all there are
  int rows_ = 1;
  Imath::V2d cell_mm_;  // along the radius in x alone
  double shift_;        // of the pupil, over that of the point of the image
  std::vector<PupilBound> bounds_;
  EntranceDisc entrance_{0, 0};
  double least_cosine_ = 1;
};

}  // namespace abbe::lens
