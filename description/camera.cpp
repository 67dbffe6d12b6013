#include "description/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "description/kinds.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kFNumber{description::kFastestFNumber, 1e6};

}  // namespace

static Fields fields(Tag<Aperture>) {
  return describe(
      "aperture", "How much light a lens passes.",
      {field("f_number", &Aperture::f_number, kFNumber,
             "Focal length over the diameter of the opening, 0.5 or more as of all lenses in air; of a "
             "pinhole, which is sharp everywhere, it sets the exposure only and is 4 when neither it nor "
             "`t_stop` is given."),
       field("t_stop", &Aperture::t_stop, kFNumber,
             "f-number over the root of the share of light that the lens passes, at least the f-number: it "
             "exposes as a round lens without losses of that f-number does, and alone stands for a lens "
             "without losses.")});
}

static Fields fields(Tag<Pinhole>) {
  return describe("pinhole", "A camera without a lens, sharp everywhere.",
                  {one_of(&Pinhole::view,
                          under<FocalLength>("focal_length", kLength, "Distance from the hole to the film."),
                          under<FieldOfView>("fov_deg", Range{0, 180, true, true, "degrees"},
                                             "Field of view along the shorter image axis.")),
                   lent(&Pinhole::aperture)});
}

static Fields fields(Tag<ThinLens>) {
  return describe(
      "thin_lens", "A camera with an ideal lens.",
      {field("focal_length", &ThinLens::focal_length, kLength, "The focal length."),
       lent(&ThinLens::aperture), lent(&ThinLens::iris),
       field("focus_distance", &ThinLens::focus_distance,
             "Distance from the lens to the plane in focus, beyond the focal length; that from `from` to "
             "`to` when absent.")},
      {"f_number", "t_stop"});
}

static Fields fields(Tag<View>) {
  return describe("view", "Where a camera stands.",
                  {field("from", &View::from, kCoordinate, "Position of the camera."),
                   field("to", &View::to, kCoordinate, "Position it looks at."),
                   field("up", &View::up, direction(), "Direction that is up in the image."),
                   defaulted("roll_deg", &View::roll_deg, kAngle,
                             "Turn of the camera about its direction of sight, clockwise as it looks.")});
}

// The name of the lens is its key.
template <typename Lens>
Fields fields(Tag<Sighted<Lens>>) {
  return describe("", "", {field(fields_of<Lens>().name, &Sighted<Lens>::lens), lent(&Sighted<Lens>::view)});
}

Fields fields(Tag<Camera>) {
  return describe(
      "camera", "What looks at the scene.",
      {one_of(&Camera::kind, beside<PinholeCamera>("pinhole"), beside<ThinLensCamera>("thin_lens"),
              beside<LensSystemCamera>("lens_system"),
              under<Probe>("irradiance_probe", "A meter of the irradiance by the light that counts.")),
       field("motion", &Camera::motion, "How it moves, from where it is described; a probe does not.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

/// An opening, and what share of the light the lens passes.
struct Aperture {
  double f_number;
  double transmittance;
};

// T = N/sqrt(s tau), s being the share of the circle that is open: a T-stop exposes as a round lens without
// losses of that f-number does. Without an f-number the lens is taken for one without losses, of f/0.5 or
// slower as all lenses in air.
std::optional<Aperture> build(const spec::Aperture& aperture, double open_share, const LoadContext& context) {
  if (!aperture.t_stop) return Aperture{aperture.f_number.value_or(kDefaultFNumber), 1};
  const double t_stop = aperture.t_stop->value;
  const double without_losses = t_stop * std::sqrt(open_share);
  if (!aperture.f_number && without_losses >= kFastestFNumber) return Aperture{without_losses, 1};
  const double f_number = aperture.f_number.value_or(kFastestFNumber);
  const double fastest = f_number / std::sqrt(open_share);
  if (t_stop >= fastest) return Aperture{f_number, std::pow(fastest / t_stop, 2)};
  const char* limit = open_share == 1     ? "its f-number"
                      : aperture.f_number ? "its f-number and blades let it be"
                                          : "its blades let it be";
  context.diagnostics.error(
      aperture.t_stop->where,
      fmt::format("a T-stop is no faster than {} (got {}, allowed [{}, inf))", limit, t_stop, fastest));
  return std::nullopt;
}

struct Placed {
  CameraFrame frame;
  double distance;  ///< From the camera to what it looks at [m].
};

std::optional<Placed> build(const spec::View& view, const SourcePosition& where, const LoadContext& context) {
  const Imath::V3d from = view.from * context.unit_m;
  const Imath::V3d sight = view.to * context.unit_m - from;
  if (sight.length() == 0) {
    context.diagnostics.error(where,
                              "the camera looks at the point where it stands: from and to are the same");
    return std::nullopt;
  }
  const Imath::V3d forward = sight.normalized();
  const Imath::V3d right = forward.cross(view.up.normalized());
  if (right.length() < 1e-9) {
    context.diagnostics.error(where, "up is parallel to the direction of sight");
    return std::nullopt;
  }
  const Imath::V3d level = right.normalized();
  const double roll = view.roll_deg * std::numbers::pi / 180;
  const Imath::V3d turned = level * std::cos(roll) - level.cross(forward) * std::sin(roll);
  return Placed{{from, turned, turned.cross(forward), forward}, sight.length()};
}

std::optional<Pinhole> build(const spec::PinholeCamera& camera, const SourcePosition& where,
                             const Sensor& sensor, const LoadContext& context) {
  const auto placed = build(camera.view, where, context);
  const auto aperture = build(camera.lens.aperture, 1, context);
  if (!placed || !aperture) return std::nullopt;
  double image_distance = 0;
  if (const auto* length = std::get_if<spec::FocalLength>(&camera.lens.view)) {
    image_distance = length->value * context.unit_m;
  } else {
    const double half_film = std::min(sensor.width, sensor.height) * sensor.pixel_pitch / 2;
    const double fov_deg = std::get<spec::FieldOfView>(camera.lens.view).value;
    image_distance = half_film / std::tan(fov_deg * std::numbers::pi / 360);
  }
  return Pinhole{placed->frame, image_distance, image_distance / (2 * aperture->f_number),
                 aperture->transmittance};
}

// The distance in focus: a length, infinity, or that of what the camera looks at [m].
double focus_distance(const spec::ThinLens& lens, const Placed& placed, const LoadContext& context) {
  if (!lens.focus_distance) return placed.distance;
  const auto* distance = std::get_if<double>(&*lens.focus_distance);
  return distance ? *distance * context.unit_m : std::numeric_limits<double>::infinity();
}

std::optional<ThinLens> build(const spec::ThinLensCamera& camera, const SourcePosition& where,
                              const LoadContext& context) {
  const auto placed = build(camera.view, where, context);
  const auto iris = build(camera.lens.iris, context);
  const auto aperture = build(camera.lens.aperture, iris ? iris->share() : 1, context);
  if (!placed || !aperture) return std::nullopt;
  const double focus = focus_distance(camera.lens, *placed, context);
  const double f = camera.lens.focal_length * context.unit_m;
  if (focus <= f) {
    context.diagnostics.error(
        camera.lens.where,
        fmt::format("the lens cannot focus within its focal length (got {} m, allowed ({}, inf) m)", focus,
                    f));
    return std::nullopt;
  }
  // 1/v = 1/f - 1/s, in the form that holds for s = infinity.
  return ThinLens{
      placed->frame, f / (1 - f / focus), focus, f / (2 * aperture->f_number), aperture->transmittance, iris};
}

std::optional<LensSystem> build(const spec::LensSystemCamera& camera, const SourcePosition& where,
                                const Sensor& sensor, LoadContext& context) {
  const auto placed = build(camera.view, where, context);
  return placed ? build(camera.lens, placed->frame, sensor, context) : std::nullopt;
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

void set_moving(const spec::Motion& said, Camera& camera, LoadContext& context) {
  const Moving moving = build(std::optional(said), context);
  const auto bring = [&](auto& kind) {
    if constexpr (requires { kind.frame; }) {
      kind.frame.position *= moving.opening;
      for (Imath::V3d* axis : {&kind.frame.right, &kind.frame.up, &kind.frame.forward}) {
        const Imath::V3d before = *axis;
        moving.opening.multDirMatrix(before, *axis);
      }
    } else {
      context.diagnostics.error(said.where, "a meter does not move");
    }
  };
  std::visit(bring, camera.kind);
  camera.motion = moving.motion;
}

}  // namespace abbe::description
