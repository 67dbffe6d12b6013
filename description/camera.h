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

/// How much light a lens passes.
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
  std::optional<FocusDistance> focus_distance;  ///< Of what the camera looks at when absent.
  SourcePosition where;
};
/// Where a camera stands and what it looks at.
struct View {
  Imath::V3d from{0, 0, 0};
  Imath::V3d to{0, 0, 0};
  Imath::V3d up{0, 0, 0};
  double roll_deg = 0;
};
/// A camera of some lens.
template <typename Lens>
struct Sighted {
  Lens lens;
  View view;
};
using PinholeCamera = Sighted<Pinhole>;
using ThinLensCamera = Sighted<ThinLens>;
using LensSystemCamera = Sighted<LensSystem>;
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

/// The camera before the sensor's film. Reports what no table can say: a T-stop faster than its f-number or
/// than blades allow a lens in air, a view of no direction, a lens that cannot focus; nothing after an error.
[[nodiscard]] std::optional<Camera> build(const spec::Camera& camera, const Sensor& sensor,
                                          LoadContext& context);
/// Lets a camera move from where it is described. Reports a probe, which does not.
void set_moving(const spec::Motion& said, Camera& camera, LoadContext& context);

}  // namespace abbe::description
