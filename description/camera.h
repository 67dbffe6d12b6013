#pragma once

#include <optional>
#include <string>
#include <variant>

#include "description/lens.h"
#include "description/load_context.h"
#include "description/motion.h"
#include "description/probe.h"
#include "description/sensor.h"
#include "description/surface.h"
#include "io/schema/fields.h"
#include "lens/iris.h"
#include "scene/camera/camera.h"
#include "scene/camera/lens_system.h"
#include "scene/camera/model.h"

namespace abbe::spec {

/// The blades of an aperture stop; without them the stop is round.
struct Iris {
  std::optional<int> blades;  ///< 3 to 32; the opening is the polygon inscribed in the circle of the stop.
  /// Clockwise rotation of the blades as the camera looks; 0, with a corner up, if absent.
  std::optional<schema::Located<double>> blade_rotation_deg;
};

enum class InfinityKeyword { infinity };
/// Distance from the lens to the plane in focus, in scene units and above 0; or infinity. That of a
/// lens system is measured from its first surface.
using FocusDistance = std::variant<double, InfinityKeyword>;

/// A lens: its name in `data/lens`, the name of a .json, .zmx or .dat file, or the contents of such a .json.
using Prescription = std::variant<std::string, Lens>;

/// Film position for a focus distance: the paraxial focus, or the smallest axial spot over all wavelengths of
/// the prescription.
enum class FilmPlane { paraxial, best };
/// A real lens in a scene, given by its prescription.
struct LensSystem {
  schema::Located<Prescription> prescription;
  std::optional<FocusDistance> focus_distance;      ///< If absent, the film stays at the prescribed image.
  std::optional<schema::Located<FilmPlane>> focus;  ///< Only with `focus_distance`; `best` if absent.
  std::optional<schema::Located<double>> f_number;  ///< If absent, the stop is that of the prescription.
  Iris iris;
  bool ghosts = false;  ///< True to render ghosts: light that two surfaces of the lens reflect.
  SourcePosition where;
};

/// The f-number or T-stop of a lens.
struct Aperture {
  std::optional<double> f_number;  ///< `kDefaultFNumber` if both are absent.
  /// f-number over the square root of the transmittance. A lens with a T-stop alone is lossless.
  std::optional<schema::Located<double>> t_stop;
};
struct FocalLength : schema::Value<double> {};  ///< Distance from the pinhole to the film [scene units].
struct FieldOfView : schema::Value<double> {};  ///< Full angle along the shorter image axis [degrees].
/// A camera without a lens, sharp everywhere. Its aperture sets only the exposure.
struct Pinhole {
  std::variant<std::monostate, FocalLength, FieldOfView> view;
  Aperture aperture;
};
/// An ideal lens. A focal length and an aperture are required.
struct ThinLens {
  double focal_length = 0;  ///< [scene units]
  Aperture aperture;
  Iris iris;
  std::optional<FocusDistance> focus_distance;  ///< If absent, the distance from `View::from` to `View::to`.
  SourcePosition where;
};
/// Position and orientation of a camera, in scene units.
struct View {
  /// Position of the camera: of its pinhole, its thin lens or the first surface of its lens system.
  Imath::V3d from{0, 0, 0};
  Imath::V3d to{0, 0, 0};  ///< Position that the camera looks at.
  Imath::V3d up{0, 0, 0};  ///< Direction that is up in the image, of any length except 0.
  double roll_deg = 0;     ///< Rotation about the viewing direction, clockwise as the camera looks.
};
/// A lens with its position and orientation.
template <typename Lens>
struct CameraWithView {
  Lens lens;
  View view;
};
using PinholeCamera = CameraWithView<Pinhole>;
using ThinLensCamera = CameraWithView<ThinLens>;
using LensSystemCamera = CameraWithView<LensSystem>;
/// The camera or irradiance probe of a scene file. `std::monostate` means that none has been read.
struct Camera {
  std::variant<std::monostate, PinholeCamera, ThinLensCamera, LensSystemCamera, Probe> kind;
  SourcePosition where;
  std::optional<Motion> motion = {};  ///< Motion relative to the described pose; at rest if absent.
};
/// Key table of `Camera`.
[[nodiscard]] schema::Fields fields(schema::Tag<Camera>);

}  // namespace abbe::spec

namespace abbe::description {

/// f-number of the fastest lens in air: N = 1/(2 sin U') for U' = 90 degrees, the half-angle of the cone of
/// light on the film.
inline constexpr double kFastestFNumber = 0.5;
/// f-number that sets the exposure of a pinhole with neither f-number nor T-stop.
inline constexpr double kDefaultFNumber = 4;

/// Builds the camera, in metres, in front of the film of `sensor`, whose channels must have been built.
/// `camera.kind` must not be std::monostate. Returns nothing after an error. Errors in addition to those of
/// the key table:
/// - a T-stop faster than the f-number, or than the blades allow a lens in air;
/// - a view without a direction, or with `up` along it;
/// - a lens that cannot focus at the requested distance or open to the requested f-number;
/// - a prescription with errors, at their positions in it;
/// - a lens system that does not illuminate the film, or that has a spectral sensor;
/// - the errors of a probe.
/// Warns of settings without effect and of indices without data where the sensor responds. The motion is not
/// built; see `set_moving`. Throws Error{resource} if the memory limit is exceeded.
[[nodiscard]] std::optional<Camera> build(const spec::Camera& camera, const Sensor& sensor,
                                          LoadContext& context);
/// Moves `camera` from its described pose to that at which the shutter opens, and sets its motion from then
/// on. `context.open_s` and `context.span_s` must be set. Reports a probe, which cannot move.
void set_moving(const spec::Motion& spec, Camera& camera, LoadContext& context);

}  // namespace abbe::description
