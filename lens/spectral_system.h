#pragma once

#include <array>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "lens/route.h"
#include "lens/system.h"
#include "lens/trace.h"

namespace abbe::lens {

/// Index and absorption of the media before the first surface and behind each surface of a lens, tabulated
/// every nanometre. Linear interpolation is accurate to about 1e-7 for the index. Medium 0 is the air before
/// the first surface; medium i + 1 is behind surface i.
class MediaTable {
 public:
  /// Tabulates the media from 300 to 1100 nm. `system` need not outlive the table.
  explicit MediaTable(const System& system);

  /// Position of one wavelength, or of each lane, in the table.
  template <typename Real>
  struct Coordinate {
    std::array<const double*, sizeof(Real) / sizeof(ScalarOf<Real>)> row;
    Real fraction;  ///< Position between this row and the next, in [0, 1].
  };
  /// Table position of a wavelength [nm], clamped to [300, 1100]. Valid as long as the table.
  template <typename Real>
  [[nodiscard]] Coordinate<Real> coordinate(const Real& wavelength_nm) const;

  /// Refractive index relative to air.
  template <typename Real>
  [[nodiscard]] Real n(std::size_t medium, const Coordinate<Real>& coordinate) const {
    return at(medium, coordinate);
  }
  /// True if the medium absorbs at any wavelength of the table.
  [[nodiscard]] bool absorbs(std::size_t medium) const { return absorbs_[medium]; }
  /// Absorption coefficient a of power [1/mm]: e^(-a d) is transmitted over a distance d.
  template <typename Real>
  [[nodiscard]] Real absorption_per_mm(std::size_t medium, const Coordinate<Real>& coordinate) const {
    return at(absorbs_.size() + medium, coordinate);
  }

 private:
  template <typename Real>
  [[nodiscard]] Real at(std::size_t column, const Coordinate<Real>& coordinate) const {
    const auto value = [&](std::size_t of) {
      return by_lane<Real>([&](int j) { return coordinate.row[static_cast<std::size_t>(j)][of]; });
    };
    const Real here = value(column);
    return here + coordinate.fraction * (value(column + columns()) - here);
  }
  [[nodiscard]] std::size_t columns() const { return 2 * absorbs_.size(); }

  std::vector<bool> absorbs_;   // at any wavelength
  std::vector<double> values_;  // row by row: indices, then absorptions
};

/// A ray in the image plane, or one per lane, in the coordinates of the lens (`system.h`).
template <typename Real>
struct BasicImageRay {
  Mask<Real> reached_image;     ///< If false, the other members are undefined.
  Imath::Vec2<Real> point;      ///< Position (x, y) in the image plane [mm].
  Imath::Vec3<Real> direction;  ///< Unit vector along which the light travels.
  Real transmittance;  ///< Fraction of the power of unpolarised light left by surfaces and glass, in [0, 1].
  Imath::Vec3<Real> last;  ///< Point on the last surface, from which the ray comes [mm].
  /// `UnpolarisedFields` at the image, without absorption in glass.
  Imath::Vec3<Real> first, second;
};
using ImageRay = BasicImageRay<double>;

/// A ray in object space that was traced from the image, or one per lane.
template <typename Real>
struct BasicObjectRay {
  Mask<Real> reached_object;  ///< If false, `ray` is undefined.
  BasicRay<Real> ray;         ///< Starts at the first surface and travels towards -z.
};

struct ColouredRay {
  Ray ray;
  double wavelength_nm;
};

/// A ray common to all wavelengths of a packet.
struct PacketRay {
  Ray ray;
  SampledSpectrum wavelengths_nm;
};

/// A point of a surface [mm], and its unit normal towards +z, in the coordinates of the lens.
struct SurfacePoint {
  Imath::V3d point;
  Imath::V3d normal;
  double cos_axis;  ///< Cosine of the angle between the normal and the surface's own axis.
};

/// A system for tracing many rays at arbitrary wavelengths. Its media come from a `MediaTable`, so that
/// wavelengths count as within [300, 1100] nm. Tracing a ray or a packet allocates no memory. All tracing is
/// thread-safe and never throws.
class SpectralSystem {
 public:
  /// `stop_radius_mm` becomes a clear aperture of the stop surface, unless that has a smaller one.
  SpectralSystem(System system, double stop_radius_mm);

  [[nodiscard]] const System& system() const { return system_; }
  [[nodiscard]] double stop_radius_mm() const { return stop_radius_mm_; }
  /// Positions z of the last vertex and of the image plane [mm].
  [[nodiscard]] double last_z() const { return vertex_z_[vertex_z_.size() - 2]; }
  [[nodiscard]] double image_z() const { return vertex_z_.back(); }

  /// Route that forms the image.
  [[nodiscard]] const Route& direct() const { return direct_; }
  /// Traces a ray from object space to the image along a route, with clear apertures. Nothing if it does not
  /// arrive. The ray travels towards +z and may start anywhere on its line.
  [[nodiscard]] std::optional<ImageRay> to_image(const Ray& ray, double wavelength_nm,
                                                 const Route& route) const;
  [[nodiscard]] std::optional<ImageRay> to_image(const Ray& ray, double wavelength_nm) const {
    return to_image(ray, wavelength_nm, direct_);
  }
  /// Traces one ray per packet at all its wavelengths, for two packets, in single precision like the rays of
  /// scenes. On the direct route, the error at the image is below 5e-5 mm.
  [[nodiscard]] BasicImageRay<Floats> to_image(const std::array<PacketRay, 2>& rays,
                                               const Route& route) const;
  /// Traces a ray from the image towards -z, backwards along the route to object space
  /// (`BasicObjectRay::ray`). Applies clear apertures; nothing if it does not arrive.
  [[nodiscard]] std::optional<Ray> to_object(const Ray& ray, double wavelength_nm, const Route& route) const;
  [[nodiscard]] std::optional<Ray> to_object(const Ray& ray, double wavelength_nm) const {
    return to_object(ray, wavelength_nm, direct_);
  }
  /// Traces many rays along the direct route, several at once.
  [[nodiscard]] std::vector<std::optional<Ray>> to_object(std::span<const ColouredRay> rays) const;
  /// Position at the stop of a ray from the image towards -z, in radii of the stop from its center. Ignores
  /// clear apertures; nothing if it does not arrive at the stop.
  [[nodiscard]] std::optional<Imath::V2d> at_stop(const Ray& ray, double wavelength_nm) const;

  /// Conversion between (x, y) in a surface's own coordinates and the point of the surface there [mm]. (x, y)
  /// must be inside the edge of its conic.
  [[nodiscard]] SurfacePoint point_of(std::size_t surface, const Imath::V2d& local) const;
  [[nodiscard]] Imath::V2d local_of(std::size_t surface, const Imath::V3d& point) const;

 private:
  template <typename Real>
  [[nodiscard]] BasicImageRay<Real> trace_to_image(BasicRay<Real> ray, const Real& wavelength_nm,
                                                   const Route& route) const;
  template <typename Real>
  [[nodiscard]] BasicObjectRay<Real> trace_to_object(BasicRay<Real> ray, const Real& wavelength_nm,
                                                     const Route& route) const;
  template <typename Real>
  [[nodiscard]] Crossing<Real> interact_next(const Step& step, const MediaTable::Coordinate<Real>& coordinate,
                                             const BasicRay<Real>& ray) const;

  System system_;
  double stop_radius_mm_;
  std::vector<SystemAt::Frame> frames_;
  std::vector<double> vertex_z_;
  MediaTable media_;
  Route direct_;
};

}  // namespace abbe::lens
