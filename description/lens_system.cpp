#include "description/lens_system.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "description/checks.h"
#include "description/load_lens.h"
#include "description/value_ranges.h"
#include "io/error.h"
#include "lens/beam.h"
#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/spot.h"
#include "scene/camera/lens_optics.h"

namespace abbe::spec {

using namespace schema;

ValueType value_type(Tag<FocusDistance>) {
  return forms<FocusDistance>(
      "", "a distance, or \"infinity\"",
      form<InfinityKeyword>(Json::text, enumeration<InfinityKeyword>("distance", {"infinity"})),
      form<double>(Json::number, kLength));
}

ValueType value_type(Tag<Prescription>) {
  return forms<Prescription>("", "a lens: its name, a file, or an object with its surfaces",
                             form<std::string>(Json::text), form<Lens>(Json::object));
}

Fields fields(Tag<LensSystem>) {
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
  context.diagnostics.error(
      spec.f_number->where,
      fmt::format("the lens cannot open that far (got f/{:g}, allowed {})", spec.f_number->value,
                  speed && std::isfinite(speed->f_number) ? fmt::format("f/{:.4g} or more", speed->f_number)
                                                          : "the aperture of its prescription"));
  return std::nullopt;
}

void warn_of_lost_defocus(const spec::LensSystem& spec, const lens::System& lens, LoadContext& context) {
  if (lens.defocus_mm == 0) return;
  context.diagnostics.warning(
      spec.prescription.where,
      fmt::format("defocus has no effect (got {:g} mm): a focus_distance moves the film into focus",
                  lens.defocus_mm));
}

// Moves the film to the image of an object at the focus distance from the first surface. False after an
// error.
bool focus(const spec::LensSystem& spec, lens::System& lens, double stop_radius, LoadContext& context) {
  warn_of_lost_defocus(spec, lens, context);
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

}  // namespace

std::optional<LensSystem> build(const spec::LensSystem& spec, const CameraFrame& frame, const Sensor& sensor,
                                LoadContext& context) {
  auto lens = load_prescription(spec, context);
  if (!lens) return std::nullopt;
  if (sensor.spectral) {
    context.diagnostics.error(spec.where,
                              "a spectral sensor records radiances, but a real lens images different "
                              "wavelengths to different pixels: use a thin lens or a pinhole");
    return std::nullopt;
  }
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
    return LensSystem{frame, optics, optics->has_ghosts()};
  } catch (const Error& error) {
    context.diagnostics.error(spec.where, error.what());
    return std::nullopt;
  }
}

}  // namespace abbe::description
