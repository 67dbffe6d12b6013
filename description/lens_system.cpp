#include "description/lens_system.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "description/checks.h"
#include "description/kinds.h"
#include "description/load_lens.h"
#include "io/error.h"
#include "lens/beam.h"
#include "lens/field.h"
#include "lens/focus.h"
#include "lens/paraxial.h"
#include "scene/camera/lens_optics.h"

namespace abbe::spec {

using namespace schema;

Kind kind(Tag<FocusDistance>) {
  return forms<FocusDistance>("", "a distance, or \"infinity\"",
                              form<Far>(Json::text, word<Far>("distance", {"infinity"})),
                              form<double>(Json::number, kLength));
}

Kind kind(Tag<Prescription>) {
  return forms<Prescription>("", "a lens: its name, a file, or an object with its surfaces",
                             form<std::string>(Json::text), form<Lens>(Json::object));
}

Fields fields(Tag<LensSystem>) {
  return describe(
      "lens_system", "A camera with a real lens, traced surface by surface; the film is at its image.",
      {field(
           "prescription", &LensSystem::prescription,
           "A lens by its name in `data/lens`, a file of one (`.json`, `.zmx`, `.dat`), or what its `.json` "
           "would say."),
       field("focus_distance", &LensSystem::focus_distance,
             "Distance from the first surface to the plane in focus, which moves the film; where the "
             "prescription has its image when absent."),
       field("focus", &LensSystem::focus, word<FilmPlane>("focus", {"paraxial", "best"}),
             "Where the film is moved for `focus_distance`: to the paraxial focus, or where the spot on the "
             "axis is least, of the prescription's wavelengths together, as it is when absent."),
       field("f_number", &LensSystem::f_number, Range{0, 1e6, true, false},
             "Focal length over the diameter of the beam on the axis, to which the stop is closed; as wide "
             "as the prescription says when absent."),
       lent(&LensSystem::iris),
       defaulted(
           "ghosts", &LensSystem::ghosts,
           "Whether light that surfaces of the lens reflect twice comes to the film too; surfaces without "
           "a clear aperture then end where the light of the picture does.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

std::optional<lens::System> load_prescription(const spec::LensSystem& said, LoadContext& context) {
  if (const auto* itself = std::get_if<spec::Lens>(&said.prescription.value)) return build(*itself, context);
  std::string name = std::get<std::string>(said.prescription.value);
  if (std::filesystem::path(name).has_extension()) {
    const auto file = context.file(name, said.prescription.where);
    if (!file) return std::nullopt;
    name = file->string();
  }
  return load_lens(name, context.diagnostics, context.inputs, said.prescription.where);
}

// The radius of the stop [mm]; nothing where it would have to be wider than the prescription has it.
std::optional<double> closed_stop(const spec::LensSystem& said, const lens::System& lens,
                                  LoadContext& context) {
  const double widest = lens::stop_radius(lens);
  if (!said.f_number) return widest;
  lens::System closed = lens;
  closed.aperture = {lens::ApertureKind::f_number, said.f_number->value};
  const double radius = lens::stop_radius(closed);
  if (radius <= widest * (1 + lens::kNominalRounding)) return std::min(radius, widest);
  constexpr int kCells = 16;
  const auto speed = lens::speed(lens::SystemAt(lens, lens.primary_nm()), widest, kCells);
  context.diagnostics.error(
      said.f_number->where,
      fmt::format("the lens does not open so far (got f/{:g}, allowed {})", said.f_number->value,
                  speed && std::isfinite(speed->f_number) ? fmt::format("f/{:.4g} or more", speed->f_number)
                                                          : "what its prescription says"));
  return std::nullopt;
}

void warn_of_lost_defocus(const spec::LensSystem& said, const lens::System& lens, LoadContext& context) {
  if (lens.defocus_mm == 0) return;
  context.diagnostics.warning(
      said.prescription.where,
      fmt::format("a defocus without effect (got {:g} mm): a focus_distance moves the film into focus",
                  lens.defocus_mm));
}

// Moves the film to the image of what is that far from the first surface.
bool focus(const spec::LensSystem& said, lens::System& lens, double stop_radius, LoadContext& context) {
  warn_of_lost_defocus(said, lens, context);
  const auto* distance = std::get_if<double>(&*said.focus_distance);
  lens.object_distance_mm =
      distance != nullptr ? std::optional(*distance * context.unit_m * lens::kMmPerM) : std::nullopt;
  lens.fields = {0};
  lens.aperture = {lens::ApertureKind::stop, stop_radius};
  double& film = lens.surfaces.back().thickness_mm;
  film = lens::first_order(lens::SystemAt(lens, lens.primary_nm())).image_distance_mm;
  if (film > 0 && std::isfinite(film)) {
    if (!said.focus || said.focus->value == spec::FilmPlane::best) film += lens::best_focus(lens).value_or(0);
    if (film > 0) return true;
  }
  context.diagnostics.error(
      said.where,
      fmt::format("the lens has no image behind it of what is there to be in focus (got {:.4g} mm "
                  "from its last surface, allowed (0, inf) mm)",
                  film));
  return false;
}

// The wavelengths that a sensor counts, whichever way its filters stand; all where it counts none.
Support counted_range(const Sensor& sensor) {
  Support range;
  for (const Channel& channel : sensor.channels) extend(range, envelope(channel));
  return range.low < range.high ? range : Support{kMinWavelengthNm, kMaxWavelengthNm};
}

// Each index once, however many surfaces have it; all tables have one name.
void check_indices(const spec::LensSystem& said, const lens::System& lens, const Support& counted,
                   const LoadContext& context) {
  std::set<std::tuple<std::string, double, double>> told;
  const auto check = [&](const std::string& name, const RefractiveIndex& index) {
    if (told.emplace(name, index.low_nm(), index.high_nm()).second)
      check_validity({&name, &index}, counted, said.prescription.where, context.diagnostics);
  };
  for (const lens::Surface& surface : lens.surfaces) {
    if (surface.behind) check(surface.behind->name, surface.behind->index);
    for (const Coating::Material& film : surface.coating.materials) check(film.index_name, film.index);
  }
}

}  // namespace

std::optional<LensSystem> build(const spec::LensSystem& said, const CameraFrame& frame, const Sensor& sensor,
                                LoadContext& context) {
  auto lens = load_prescription(said, context);
  if (!lens) return std::nullopt;
  if (sensor.spectral) {
    context.diagnostics.error(
        said.where,
        "a spectral sensor keeps radiances, which a lens that takes wavelengths to other pixels does not "
        "give: it needs a thin lens or a pinhole");
    return std::nullopt;
  }
  if (said.focus && !said.focus_distance)
    context.diagnostics.warning(said.focus->where,
                                "a focus without effect: without a focus_distance the film stays where the "
                                "prescription has its image");
  try {
    const std::optional<double> stop = closed_stop(said, *lens, context);
    if (!stop || (said.focus_distance && !focus(said, *lens, *stop, context))) return std::nullopt;
    lens->surfaces[lens->stop].iris = build(said.iris, context);
    const Support counted = counted_range(sensor);
    check_indices(said, *lens, counted, context);
    const FilmGrid grid{sensor.width, sensor.height, sensor.pixel_pitch};
    using Ghosts = LensOptics::Ghosts;
    const auto optics = std::make_shared<LensOptics>(*std::move(lens), *stop, grid, counted.low, counted.high,
                                                     said.ghosts ? Ghosts::enumerated : Ghosts::left_out);
    return LensSystem{frame, optics, optics->has_ghosts()};
  } catch (const Error& error) {
    context.diagnostics.error(said.where, error.what());
    return std::nullopt;
  }
}

}  // namespace abbe::description
