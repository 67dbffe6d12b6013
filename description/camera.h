#pragma once

#include <optional>
#include <variant>

#include "description/iris.h"
#include "description/lens_system.h"
#include "description/load_context.h"
#include "description/motion.h"
#include "description/probe.h"
#include "description/sensor.h"
#include "description/surface.h"
#include "io/schema/fields.h"
#include "scene/camera/camera.h"

namespace abbe::spec {

/// The f-number or T-stop of a lens.
struct Aperture {
  std::optional<double> f_number;
  std::optional<schema::Located<double>> t_stop;
};
struct FocalLength : schema::Value<double> {};
struct FieldOfView : schema::Value<double> {};
struct Pinhole {
  std::variant<std::monostate, FocalLength, FieldOfView> view;
  Aperture aperture;
};
struct ThinLens {
  double focal_length = 0;
  Aperture aperture;
  Iris iris;
  std::optional<FocusDistance> focus_distance;  ///< The distance from `from` to `to` if absent.
  SourcePosition where;
};
/// Position and orientation of a camera, in scene units.
struct View {
  Imath::V3d from{0, 0, 0};
  Imath::V3d to{0, 0, 0};
  Imath::V3d up{0, 0, 0};
  double roll_deg = 0;
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
struct Camera {
  std::variant<std::monostate, PinholeCamera, ThinLensCamera, LensSystemCamera, Probe> kind;
  SourcePosition where;
  std::optional<Motion> motion = {};
};
[[nodiscard]] schema::Fields fields(schema::Tag<Camera>);

}  // namespace abbe::spec

namespace abbe::description {

/// The fastest lens in air: N = 1/(2 sin U'), where U' is the half-angle of the cone of light on the film.
inline constexpr double kFastestFNumber = 0.5;
/// The f-number that sets the exposure of a pinhole without one of its own.
inline constexpr double kDefaultFNumber = 4;

/// Builds the camera in front of the sensor's film. Returns nothing after an error. Errors in addition to
/// those of the key table:
/// - a T-stop faster than the f-number, or than the blades allow a lens in air;
/// - a view without a direction;
/// - a lens that cannot focus at the requested distance.
[[nodiscard]] std::optional<Camera> build(const spec::Camera& camera, const Sensor& sensor,
                                          LoadContext& context);
/// Applies a motion to a camera, relative to its described pose. A probe cannot move: that is an error.
void set_moving(const spec::Motion& spec, Camera& camera, LoadContext& context);

}  // namespace abbe::description
