#include "description/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kFNumber{description::kFastestFNumber, 1e6};

}  // namespace

static Fields fields(Tag<Aperture>) {
  return describe("aperture", "The aperture of a lens.",
                  {field("f_number", &Aperture::f_number, kFNumber,
                         "Focal length over the diameter of the aperture, at least 0.5, the limit of lenses "
                         "in air. A pinhole is sharp everywhere: its f-number sets only the exposure, and is "
                         "4 if neither it nor `t_stop` is given."),
                   field("t_stop", &Aperture::t_stop, kFNumber,
                         "f-number divided by the square root of the transmittance of the lens; at least the "
                         "f-number. It gives the exposure of a round, lossless lens of that f-number. "
                         "Without `f_number` the lens is lossless.")});
}

static Fields fields(Tag<Pinhole>) {
  return describe(
      "pinhole", "A camera without a lens, sharp everywhere.",
      {one_of(&Pinhole::view,
              under<FocalLength>("focal_length", kLength, "Distance from the pinhole to the film."),
              under<FieldOfView>("fov_deg", Range{0, 180, true, true, "degrees"},
                                 "Field of view along the shorter image axis.")),
       inlined(&Pinhole::aperture)});
}

static Fields fields(Tag<ThinLens>) {
  return describe("thin_lens", "A camera with an ideal lens.",
                  {field("focal_length", &ThinLens::focal_length, kLength, "The focal length."),
                   inlined(&ThinLens::aperture), inlined(&ThinLens::iris),
                   field("focus_distance", &ThinLens::focus_distance,
                         "Distance from the lens to the plane in focus, greater than the focal length. If "
                         "absent, the distance from `from` to `to`.")},
                  {"f_number", "t_stop"});
}

static Fields fields(Tag<View>) {
  return describe(
      "view", "Position and orientation of a camera.",
      {field("from", &View::from, kCoordinate, "Position of the camera."),
       field("to", &View::to, kCoordinate, "Position that the camera looks at."),
       field("up", &View::up, direction(), "Direction that is up in the image."),
       defaulted("roll_deg", &View::roll_deg, kAngle,
                 "Rotation of the camera about its viewing direction, clockwise as seen by the camera.")});
}

// The key of the lens is the name of its table.
template <typename Lens>
Fields fields(Tag<CameraWithView<Lens>>) {
  return describe(
      "", "",
      {field(fields_of<Lens>().name, &CameraWithView<Lens>::lens), inlined(&CameraWithView<Lens>::view)});
}

Fields fields(Tag<Camera>) {
  return describe(
      "camera", "The camera or irradiance probe that records the scene.",
      {one_of(&Camera::kind, inlined_by<PinholeCamera>("pinhole"), inlined_by<ThinLensCamera>("thin_lens"),
              inlined_by<LensSystemCamera>("lens_system"),
              under<Probe>("irradiance_probe", "A probe of the irradiance weighted by the channels.")),
       field("motion", &Camera::motion, "Motion relative to the described pose; a probe cannot move.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

/// The f-number of a lens and its transmittance.
struct Aperture {
  double f_number;
  double transmittance;
};

// T = N/sqrt(s tau), where s is the fraction of the circular aperture that is open and tau the transmittance.
// A T-stop gives the exposure of a round lossless lens of that f-number. Without an f-number the lens counts
// as lossless, unless that needs an f-number below 0.5, the limit in air.
std::optional<Aperture> build(const spec::Aperture& aperture, double open_fraction,
                              const LoadContext& context) {
  if (!aperture.t_stop) return Aperture{aperture.f_number.value_or(kDefaultFNumber), 1};
  const double t_stop = aperture.t_stop->value;
  const double without_losses = t_stop * std::sqrt(open_fraction);
  if (!aperture.f_number && without_losses >= kFastestFNumber) return Aperture{without_losses, 1};
  const double f_number = aperture.f_number.value_or(kFastestFNumber);
  const double fastest = f_number / std::sqrt(open_fraction);
  if (t_stop >= fastest) return Aperture{f_number, std::pow(fastest / t_stop, 2)};
  const char* limit = open_fraction == 1  ? "its f-number"
                      : aperture.f_number ? "its f-number and blades allow"
                                          : "its blades allow";
  context.diagnostics.error(
      aperture.t_stop->where,
      fmt::format("a T-stop must not be faster than {} (got {}, allowed [{}, inf))", limit, t_stop, fastest));
  return std::nullopt;
}

struct PlacedView {
  CameraFrame frame;
  double distance;  ///< Distance from `from` to `to` [m].
};

std::optional<PlacedView> build(const spec::View& view, const SourcePosition& where,
                                const LoadContext& context) {
  const Imath::V3d from = view.from * context.unit_m;
  const Imath::V3d sight = view.to * context.unit_m - from;
  if (sight.length() == 0) {
    context.diagnostics.error(where, "from and to are the same point: the camera has no viewing direction");
    return std::nullopt;
  }
  const Imath::V3d forward = sight.normalized();
  const Imath::V3d right = forward.cross(view.up.normalized());
  if (right.length() < 1e-9) {
    context.diagnostics.error(where, "up is parallel to the viewing direction");
    return std::nullopt;
  }
  // A roll by the angle r turns the right axis to cos r right - sin r up, clockwise as the camera looks.
  const Imath::V3d level = right.normalized();
  const double roll = view.roll_deg * std::numbers::pi / 180;
  const Imath::V3d turned = level * std::cos(roll) - level.cross(forward) * std::sin(roll);
  return PlacedView{{from, turned, turned.cross(forward), forward}, sight.length()};
}

// The pinhole at the distance v from the film. Its opening has the radius v/(2 N) for the f-number N.
std::optional<Pinhole> build(const spec::PinholeCamera& camera, const SourcePosition& where,
                             const Sensor& sensor, const LoadContext& context) {
  const auto view = build(camera.view, where, context);
  const auto aperture = build(camera.lens.aperture, 1, context);
  if (!view || !aperture) return std::nullopt;
  double image_distance = 0;
  if (const auto* length = std::get_if<spec::FocalLength>(&camera.lens.view)) {
    image_distance = length->value * context.unit_m;
  } else {
    const double half_film = std::min(sensor.width, sensor.height) * sensor.pixel_pitch / 2;
    const double fov_deg = std::get<spec::FieldOfView>(camera.lens.view).value;
    image_distance = half_film / std::tan(fov_deg * std::numbers::pi / 360);
  }
  return Pinhole{view->frame, image_distance, image_distance / (2 * aperture->f_number),
                 aperture->transmittance};
}

// Distance to the plane in focus [m]; infinity is allowed.
double focus_distance(const spec::ThinLens& lens, const PlacedView& view, const LoadContext& context) {
  if (!lens.focus_distance) return view.distance;
  const auto* distance = std::get_if<double>(&*lens.focus_distance);
  return distance ? *distance * context.unit_m : std::numeric_limits<double>::infinity();
}

std::optional<ThinLens> build(const spec::ThinLensCamera& camera, const SourcePosition& where,
                              const LoadContext& context) {
  const auto view = build(camera.view, where, context);
  const auto iris = build(camera.lens.iris, context);
  const auto aperture = build(camera.lens.aperture, iris ? iris->area_fraction() : 1, context);
  if (!view || !aperture) return std::nullopt;
  const double focus = focus_distance(camera.lens, *view, context);
  const double f = camera.lens.focal_length * context.unit_m;
  if (focus <= f) {
    context.diagnostics.error(
        camera.lens.where,
        fmt::format("the lens cannot focus within its focal length (got {} m, allowed ({}, inf) m)", focus,
                    f));
    return std::nullopt;
  }
  // Solves 1/v = 1/f - 1/s for v, in the form that holds for s = infinity.
  return ThinLens{
      view->frame, f / (1 - f / focus), focus, f / (2 * aperture->f_number), aperture->transmittance, iris};
}

std::optional<LensSystem> build(const spec::LensSystemCamera& camera, const SourcePosition& where,
                                const Sensor& sensor, LoadContext& context) {
  const auto view = build(camera.view, where, context);
  return view ? build(camera.lens, view->frame, sensor, context) : std::nullopt;
}

}  // namespace

std::optional<Camera> build(const spec::Camera& camera, const Sensor& sensor, LoadContext& context) {
  std::optional<decltype(Camera::kind)> kind;
  if (const auto* pinhole = std::get_if<spec::PinholeCamera>(&camera.kind))
    kind = build(*pinhole, camera.where, sensor, context);
  else if (const auto* lens = std::get_if<spec::ThinLensCamera>(&camera.kind))
    kind = build(*lens, camera.where, context);
  else if (const auto* system = std::get_if<spec::LensSystemCamera>(&camera.kind))
    kind = build(*system, camera.where, sensor, context);
  else
    kind = build(std::get<spec::Probe>(camera.kind), context);
  if (!kind) return std::nullopt;
  return Camera{*kind, sensor.width, sensor.height, sensor.pixel_pitch};
}

void set_moving(const spec::Motion& spec, Camera& camera, LoadContext& context) {
  const PoseAndMotion moving = build(std::optional(spec), context);
  const auto move_to_opening = [&](auto& kind) {
    if constexpr (requires { kind.frame; }) {
      kind.frame.position *= moving.pose_at_opening;
      for (Imath::V3d* axis : {&kind.frame.right, &kind.frame.up, &kind.frame.forward}) {
        const Imath::V3d before = *axis;
        moving.pose_at_opening.multDirMatrix(before, *axis);
      }
    } else {
      context.diagnostics.error(spec.where, "an irradiance probe cannot move");
    }
  };
  std::visit(move_to_opening, camera.kind);
  camera.motion = moving.motion;
}

}  // namespace abbe::description
