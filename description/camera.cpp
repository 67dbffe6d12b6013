#include "description/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "description/checks.h"
#include "description/lens_files.h"
#include "description/value_ranges.h"
#include "io/error.h"
#include "lens/beam.h"
#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/spot.h"
#include "scene/camera/lens_optics.h"

namespace abbe::spec {

using namespace schema;

static constexpr Range kFNumber{description::kFastestFNumber, 1e6};

static Fields fields(Tag<Iris>) {
  return describe(
      "iris", "The blades of a stop.",
      {field("blades", &Iris::blades, {lens::kMinBlades, lens::kMaxBlades},
             "Number of straight blades. The opening is the regular polygon inscribed in the circle of the "
             "stop; the f-number stays that of the circle. Round if absent."),
       field("blade_rotation_deg", &Iris::blade_rotation_deg, kAngle,
             "Rotation of the blades, clockwise as seen by the camera; if absent, a corner points up.")});
}

static ValueType value_type(Tag<FocusDistance>) {
  return forms<FocusDistance>(
      "", "a distance, or \"infinity\"",
      form<InfinityKeyword>(Json::text, enumeration<InfinityKeyword>("distance", {"infinity"})),
      form<double>(Json::number, kLength));
}

static ValueType value_type(Tag<Prescription>) {
  return forms<Prescription>("", "a lens: its name, a file, or an object with its surfaces",
                             form<std::string>(Json::text), form<Lens>(Json::object));
}

static Fields fields(Tag<LensSystem>) {
  return describe("lens_system",
                  "A camera with a real lens, traced surface by surface, with the film at its image.",
                  {field("prescription", &LensSystem::prescription,
                         "A lens: its name in `data/lens`, a file (`.json`, `.zmx`, `.dat`), or the contents "
                         "of such a `.json`."),
                   field("focus_distance", &LensSystem::focus_distance,
                         "Distance from the first surface to the plane in focus; it moves the film. If "
                         "absent, the film is at the image of the prescription."),
                   field("focus", &LensSystem::focus, enumeration<FilmPlane>("focus", {"paraxial", "best"}),
                         "Film position for `focus_distance`: the paraxial focus, or the smallest axial spot "
                         "over all wavelengths of the prescription. `best` if absent."),
                   field("f_number", &LensSystem::f_number, Range{0, 1e6, true, false},
                         "Focal length over the diameter of the axial beam, to which the stop is closed. The "
                         "aperture of the prescription if absent."),
                   inlined(&LensSystem::iris),
                   defaulted("ghosts", &LensSystem::ghosts,
                             "True to include ghosts: light that two surfaces of the lens reflect. Surfaces "
                             "without a clear aperture then end where the imaging light does.")});
}

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

std::optional<lens::System> load_prescription(const spec::LensSystem& spec, LoadContext& context) {
  if (const auto* lens_spec = std::get_if<spec::Lens>(&spec.prescription.value))
    return build(*lens_spec, context);
  std::string name = std::get<std::string>(spec.prescription.value);
  if (std::filesystem::path(name).has_extension()) {
    const auto file = context.file(name, spec.prescription.where);
    if (!file) return std::nullopt;
    name = file->string();
  }
  return load_lens(name, context.diagnostics, context.inputs, spec.prescription.where);
}

// Radius of the stop [mm]. Reports a stop that would have to be wider than that of the prescription, and
// returns nothing then.
std::optional<double> closed_stop(const spec::LensSystem& spec, const lens::System& lens,
                                  LoadContext& context) {
  const double widest = lens::stop_radius(lens);
  if (!spec.f_number) return widest;
  lens::System closed = lens;
  closed.aperture = {lens::ApertureKind::f_number, spec.f_number->value};
  const double radius = lens::stop_radius(closed);
  if (radius <= widest * (1 + lens::kNominalRounding)) return std::min(radius, widest);
  constexpr int kCells = 16;
  const auto speed = lens::speed(lens::SystemAt(lens, lens.primary_nm()), widest, kCells);
  return context.refuse(
      spec.f_number->where,
      fmt::format("the lens cannot open that far (got f/{:g}, allowed {})", spec.f_number->value,
                  speed && std::isfinite(speed->f_number) ? fmt::format("f/{:.4g} or more", speed->f_number)
                                                          : "the aperture of its prescription"));
}

// Moves the film to the image of an object at the focus distance from the first surface. False after an
// error.
bool focus(const spec::LensSystem& spec, lens::System& lens, double stop_radius, LoadContext& context) {
  if (lens.defocus_mm != 0)
    context.diagnostics.warning(
        spec.prescription.where,
        fmt::format("defocus has no effect (got {:g} mm): a focus_distance moves the film into focus",
                    lens.defocus_mm));
  const auto* distance = std::get_if<double>(&*spec.focus_distance);
  lens.object_distance_mm =
      distance != nullptr ? std::optional(*distance * context.unit_m * lens::kMmPerM) : std::nullopt;
  lens.fields = {0};
  lens.aperture = {lens::ApertureKind::stop, stop_radius};
  double& film = lens.surfaces.back().thickness_mm;
  film = lens::first_order(lens::SystemAt(lens, lens.primary_nm())).image_distance_mm;
  if (film > 0 && std::isfinite(film)) {
    if (!spec.focus || spec.focus->value == spec::FilmPlane::best) film += lens::best_focus(lens).value_or(0);
    if (film > 0) return true;
  }
  context.diagnostics.error(spec.where,
                            fmt::format("the lens forms no image behind it of an object at the focus "
                                        "distance (got {:.4g} mm from its last surface, allowed (0, inf) mm)",
                                        film));
  return false;
}

// Wavelengths at which the sensor responds, for any orientation of its filters; all wavelengths if it never
// responds.
Support counted_range(const Sensor& sensor) {
  Support range;
  for (const Channel& channel : sensor.channels) extend(range, envelope(channel));
  return range.low < range.high ? range : Support{kMinWavelengthNm, kMaxWavelengthNm};
}

// Checks each index once, even if several surfaces use it. The data range is part of the key, because all
// tables have the same name.
void check_indices(const spec::LensSystem& spec, const lens::System& lens, const Support& counted,
                   const LoadContext& context) {
  std::set<std::tuple<std::string, double, double>> checked;
  const auto check = [&](const std::string& name, const RefractiveIndex& index) {
    if (checked.emplace(name, index.low_nm(), index.high_nm()).second)
      check_validity({&name, &index}, counted, spec.prescription.where, context.diagnostics);
  };
  for (const lens::Surface& surface : lens.surfaces) {
    if (surface.behind) check(surface.behind->name, surface.behind->index);
    for (const Coating::Material& film : surface.coating.materials) check(film.index_name, film.index);
  }
}

std::optional<lens::Iris> build(const spec::Iris& iris, const LoadContext& context) {
  const auto& rotation = iris.blade_rotation_deg;
  if (iris.blades) return lens::Iris(*iris.blades, rotation ? rotation->value : 0);
  if (rotation)
    context.diagnostics.warning(rotation->where,
                                "blade_rotation_deg has no effect: the stop has no blades and is round");
  return std::nullopt;
}

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
  return context.refuse(
      aperture.t_stop->where,
      fmt::format("a T-stop must not be faster than {} (got {}, allowed [{}, inf))", limit, t_stop, fastest));
}

struct PlacedView {
  CameraFrame frame;
  double distance;  ///< Distance from `from` to `to` [m].
};

std::optional<PlacedView> build(const spec::View& view, const SourcePosition& where,
                                const LoadContext& context) {
  const Imath::V3d from = view.from * context.unit_m;
  const Imath::V3d sight = view.to * context.unit_m - from;
  if (sight.length() == 0)
    return context.refuse(where, "from and to are the same point: the camera has no viewing direction");
  const Imath::V3d forward = sight.normalized();
  const Imath::V3d right = forward.cross(view.up.normalized());
  if (right.length() < 1e-9) return context.refuse(where, "up is parallel to the viewing direction");
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

std::optional<ThinLens> build(const spec::ThinLensCamera& camera, const SourcePosition& where,
                              const LoadContext& context) {
  const auto view = build(camera.view, where, context);
  const auto iris = build(camera.lens.iris, context);
  const auto aperture = build(camera.lens.aperture, iris ? iris->area_fraction() : 1, context);
  if (!view || !aperture) return std::nullopt;
  double focus = view->distance;
  if (const auto& given = camera.lens.focus_distance) {
    const auto* distance = std::get_if<double>(&*given);
    focus = distance ? *distance * context.unit_m : std::numeric_limits<double>::infinity();
  }
  const double f = camera.lens.focal_length * context.unit_m;
  if (focus <= f)
    return context.refuse(
        camera.lens.where,
        fmt::format("the lens cannot focus within its focal length (got {} m, allowed ({}, inf) m)", focus,
                    f));
  // Solves 1/v = 1/f - 1/s for v, in the form that holds for s = infinity.
  return ThinLens{
      view->frame, f / (1 - f / focus), focus, f / (2 * aperture->f_number), aperture->transmittance, iris};
}

std::optional<LensSystem> build(const spec::LensSystemCamera& camera, const SourcePosition& where,
                                const Sensor& sensor, LoadContext& context) {
  const spec::LensSystem& spec = camera.lens;
  const auto view = build(camera.view, where, context);
  if (!view) return std::nullopt;
  auto lens = load_prescription(spec, context);
  if (!lens) return std::nullopt;
  if (sensor.spectral)
    return context.refuse(spec.where,
                          "a spectral sensor records radiances, but a real lens images different "
                          "wavelengths to different pixels: use a thin lens or a pinhole");
  if (spec.focus && !spec.focus_distance)
    context.diagnostics.warning(
        spec.focus->where,
        "focus has no effect: without a focus_distance the film stays at the image of the prescription");
  try {
    const std::optional<double> stop = closed_stop(spec, *lens, context);
    if (!stop || (spec.focus_distance && !focus(spec, *lens, *stop, context))) return std::nullopt;
    lens->surfaces[lens->stop].iris = build(spec.iris, context);
    const Support counted = counted_range(sensor);
    check_indices(spec, *lens, counted, context);
    const FilmGrid grid{sensor.width, sensor.height, sensor.pixel_pitch};
    using Ghosts = LensOptics::Ghosts;
    const auto optics = std::make_shared<LensOptics>(*std::move(lens), *stop, grid, counted.low, counted.high,
                                                     spec.ghosts ? Ghosts::enumerated : Ghosts::left_out);
    return LensSystem{view->frame, optics, optics->has_ghosts()};
  } catch (const Error& error) {
    return context.refuse(spec.where, error.what());
  }
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
