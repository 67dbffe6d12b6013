#include "description/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "description/sensor.h"
#include "description/shape.h"
#include "description/values.h"

namespace abbe::description {
namespace {

constexpr Range kFNumber{0, 1e6, true, false};
constexpr double kDefaultFNumber = 4;

/// An opening, and what share of the light the lens passes.
struct Aperture {
  double f_number;
  double transmittance;
};

// T = N/sqrt(tau): a T-stop exposes as a lens without losses of that f-number does. Without an f-number the
// lens is taken for one.
std::optional<Aperture> read_aperture(ObjectReader& reader, std::optional<double> otherwise,
                                      const LoadContext& context) {
  const JsonValue* stop = reader.find("t_stop");
  const auto t_stop = reader.number("t_stop", kFNumber);
  if (stop && !t_stop) return std::nullopt;
  const bool named = reader.find("f_number") != nullptr;
  const auto f_number = named || (!stop && !otherwise) ? reader.require_number("f_number", kFNumber)
                        : stop                         ? t_stop
                                                       : otherwise;
  if (!f_number) return std::nullopt;
  if (!t_stop) return Aperture{*f_number, 1};
  if (*t_stop < *f_number) {
    context.diagnostics.error(
        stop->where, fmt::format("a T-stop is no faster than its f-number (got {}, allowed [{}, inf))",
                                 *t_stop, *f_number));
    return std::nullopt;
  }
  return Aperture{*f_number, std::pow(*f_number / *t_stop, 2)};
}

struct Placed {
  CameraFrame frame;
  double distance;  ///< From the camera to what it looks at [m].
};

std::optional<Placed> read_frame(ObjectReader& reader, const LoadContext& context) {
  const auto from = read_point(reader, "from", context);
  const auto to = read_point(reader, "to", context);
  const auto up = read_direction(reader, "up", context);
  if (!from || !to || !up) return std::nullopt;
  const Imath::V3d sight = *to - *from;
  if (sight.length() == 0) {
    context.diagnostics.error(reader.where(),
                              "the camera looks at the point where it stands: from and to are the same");
    return std::nullopt;
  }
  const Imath::V3d forward = sight.normalized();
  const Imath::V3d right = forward.cross(*up);
  if (right.length() < 1e-9) {
    context.diagnostics.error(reader.where(), "up is parallel to the direction of sight");
    return std::nullopt;
  }
  const Imath::V3d unit_right = right.normalized();
  return Placed{{*from, unit_right, unit_right.cross(forward), forward}, sight.length()};
}

std::optional<Pinhole> read_pinhole(const JsonValue& json, const Placed* placed, const Sensor& sensor,
                                    const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto key = reader.exactly_one({"focal_length", "fov_deg"});
  std::optional<double> image_distance;
  if (key == "focal_length") {
    if (const auto length = reader.number(*key, kLength)) image_distance = *length * context.unit_m;
  } else if (key) {
    const double half_film = std::min(sensor.width, sensor.height) * sensor.pixel_pitch / 2;
    if (const auto fov = reader.number(*key, {0, 180, true, true}))
      image_distance = half_film / std::tan(*fov * std::numbers::pi / 360);
  }
  const auto aperture = read_aperture(reader, kDefaultFNumber, context);
  reader.finish();
  if (!placed || !image_distance || !aperture) return std::nullopt;
  return Pinhole{placed->frame, *image_distance, *image_distance / (2 * aperture->f_number),
                 aperture->transmittance};
}

// The distance in focus: a length, the word "infinity", or that of what the camera looks at [m].
std::optional<double> read_focus(ObjectReader& reader, const Placed* placed, const LoadContext& context) {
  const JsonValue* json = reader.find("focus_distance");
  if (!json) return placed ? std::optional(placed->distance) : std::nullopt;
  const auto* word = std::get_if<std::string>(&json->value);
  if (word && *word == "infinity") return std::numeric_limits<double>::infinity();
  const auto distance = read_number(*json, kLength, context.diagnostics);
  return distance ? std::optional(*distance * context.unit_m) : std::nullopt;
}

std::optional<ThinLens> read_thin_lens(const JsonValue& json, const Placed* placed,
                                       const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto length = reader.require_number("focal_length", kLength);
  const auto aperture = read_aperture(reader, std::nullopt, context);
  const auto focus = read_focus(reader, placed, context);
  reader.finish();
  if (!placed || !length || !aperture || !focus) return std::nullopt;
  const double f = *length * context.unit_m;
  if (*focus <= f) {
    context.diagnostics.error(
        json.where,
        fmt::format("the lens cannot focus within its focal length (got {} m, allowed ({}, inf) m)", *focus,
                    f));
    return std::nullopt;
  }
  // 1/v = 1/f - 1/s, in the form that holds for s = infinity.
  return ThinLens{placed->frame, f / (1 - f / *focus), *focus, f / (2 * aperture->f_number),
                  aperture->transmittance};
}

std::optional<IrradianceProbe> read_probe(const JsonValue& json, const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto key = reader.exactly_one({"at", "quad"});
  std::optional<IrradianceProbe> probe;
  if (key == "at") {
    const auto at = read_point(reader, "at", context);
    const auto normal = read_direction(reader, "normal", context);
    if (at && normal) probe = IrradianceProbe{*at, Imath::V3d(0), Imath::V3d(0), *normal};
  } else if (key) {
    if (const auto quad = read_quad(*reader.find("quad"), context))
      probe = IrradianceProbe{quad->corner, quad->edge_u, quad->edge_v,
                              quad->edge_u.cross(quad->edge_v).normalized()};
  }
  reader.finish();
  return probe;
}

}  // namespace

std::optional<Camera> read_camera(const JsonValue& json, const Sensor& sensor, LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto key = reader.exactly_one({"pinhole", "thin_lens", "irradiance_probe"});
  if (!key) return std::nullopt;
  const JsonValue& model = *reader.find(*key);
  std::optional<decltype(Camera::kind)> kind;
  if (*key == "irradiance_probe") {
    kind = read_probe(model, context);
  } else {
    const std::optional<Placed> placed = read_frame(reader, context);
    const Placed* where = placed ? &*placed : nullptr;
    if (*key == "pinhole")
      kind = read_pinhole(model, where, sensor, context);
    else
      kind = read_thin_lens(model, where, context);
  }
  reader.finish();
  if (!kind) return std::nullopt;
  return Camera{*kind, sensor.width, sensor.height, sensor.pixel_pitch};
}

}  // namespace abbe::description
