#include "description/lens.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "io/error.h"
#include "lens/field.h"
#include "lens/focus.h"
#include "lens/paraxial.h"
#include "sampling/angle.h"

namespace abbe::spec {

using namespace schema;

namespace {

constexpr Range kMm = Range{-kMaxMm, kMaxMm}.in("mm");
constexpr Range kTilt = Range{-89, 89}.in("degrees");

}  // namespace

static Fields fields(Tag<ModelGlass>) {
  return describe("model_glass", "A glass known by two numbers: n = A + B/lambda^2 through both.",
                  {field("nd", &ModelGlass::nd, kModelIndex, "Index at 587.5618 nm."),
                   field("vd", &ModelGlass::vd, kAbbeNumber, "Abbe number (n_d - 1)/(n_F - n_C).")});
}

static Kind kind(Tag<LensGlass::Wrapped>) {
  return forms<LensGlass::Wrapped>("lens_glass",
                                   "a glass: an index, nd and vd, an object of n and k, or a name",
                                   form<ModelGlass>(Json::object, {"nd", "vd"}), form<Ior>(Json::any));
}

static Fields fields(Tag<LensSurface>) {
  using Pair = std::array<double, 2>;
  return describe(
             "lens_surface", "A surface and what follows it.",
             {defaulted("radius", &LensSurface::radius, kMm,
                        "Of curvature, positive where the centre is behind; 0 for a plane."),
              defaulted("thickness", &LensSurface::thickness, kMm, "To the next surface, or to the image."),
              field("glass", &LensSurface::glass, "What is behind it; air when absent."),
              field("aperture", &LensSurface::aperture, kPositiveMm,
                    "Half the diameter that lets light through."),
              defaulted("stop", &LensSurface::stop, "Whether it is the aperture stop."),
              defaulted("conic", &LensSurface::conic, {-1e6, 1e6},
                        "Conic constant: 0 for a sphere, -1 for a paraboloid."),
              defaulted("r2", &LensSurface::r2, Range::any(), "Coefficient of r^2 [1/mm]."),
              defaulted("asphere", &LensSurface::asphere, Range::any(),
                        "Coefficients of r^4, r^6, ... to r^20."),
              defaulted("decenter", &LensSurface::decenter, vector<Pair>(kMm),
                        "Of its vertex along x and y; what follows stays."),
              defaulted("tilt_deg", &LensSurface::tilt_deg, vector<Pair>(kTilt),
                        "About x, then about the tilted y."),
              defaulted("coating", &LensSurface::coating, "Thin films, from the air inwards.")})
      .or_row(2, 4);
}

Fields fields(Tag<Lens>) {
  return describe(
      "lens", "Lengths are in mm, wavelengths in nm, indices relative to air.",
      {defaulted("title", &Lens::title, "What it is."),
       defaulted("source", &Lens::source, "Where its figures come from."),
       field("surfaces", &Lens::surfaces, list<LensSurface>("surfaces", 1),
             "In the order in which light meets them."),
       at_most_one(&Lens::aperture, "a lens has one aperture",
                   under<PupilDiameter>("entrance_pupil", kPositiveMm,
                                        "Diameter of the axial beam in the entrance pupil."),
                   under<FNumber>("f_number", {0, 1e6, true, false}, "Focal length over that diameter.")),
       at_most_one(&Lens::fields, "a lens has fields of one kind",
                   under<FieldAngles>("fields_deg", kFieldAngle, "Directions of objects; 0 when absent."),
                   under<ObjectHeights>("object_heights", kMm, "Of a near object."),
                   under<ImageHeights>("image_heights", kMm, "Paraxial, of an object at infinity.")),
       field("object_distance", &Lens::object_distance, kPositiveMm,
             "Of the object before the first surface; at infinity when absent."),
       defaulted("wavelengths_nm", &Lens::wavelengths_nm, kWavelength, "At which it is looked at."),
       field("primary_nm", &Lens::primary_nm, kWavelength,
             "That of them at which stop and focus are set; the middle one when absent."),
       defaulted("focus", &Lens::focus, word<LensFocus>("focus", {"given", "paraxial", "best"}),
                 "Where the image is: behind the last thickness, at the paraxial focus, or where the spots "
                 "of all fields are least."),
       defaulted("defocus", &Lens::defocus, kMm, "How far the image is moved from there.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

using lens::System;

constexpr double kCNm = 656.2725;
constexpr double kDNm = 587.5618;
constexpr double kFNm = 486.1327;
constexpr int kGapSamples = 64;
constexpr double kTouch = 1e-9;  // mm: surfaces that meet at their rim

// A + B/lambda^2 through n_d with n_F - n_C = (n_d - 1)/V_d.
lens::Glass model_glass(const spec::ModelGlass& glass) {
  const auto inverse2 = [](double nm) { return 1e6 / (nm * nm); };
  const double b = (glass.nd - 1) / glass.vd / (inverse2(kFNm) - inverse2(kCNm));
  DispersionFormula formula;
  formula.id = 5;
  formula.c = {glass.nd - b * inverse2(kDNm), b, -2};
  formula.terms = 3;
  return {fmt::format("{}/{}", glass.nd, glass.vd),
          RefractiveIndex(formula, std::nullopt, IndexMedium::air, kMinWavelengthNm, kMaxWavelengthNm)};
}

std::optional<lens::Glass> build(const spec::LensGlass& said, const std::set<double>& wavelengths_nm,
                                 LoadContext& context) {
  if (const auto* model = std::get_if<spec::ModelGlass>(&said.value)) return model_glass(*model);
  auto ior = build(std::get<spec::Ior>(said.value), context);
  if (!ior) return std::nullopt;
  for (const double nm : wavelengths_nm)
    if (nm < ior->index.low_nm() || nm > ior->index.high_nm()) {
      context.diagnostics.warning(
          said.where, fmt::format("{} has no data at {:g} nm: its index at {:g} nm is used", ior->name, nm,
                                  std::clamp(nm, ior->index.low_nm(), ior->index.high_nm())));
    }
  return lens::Glass{std::move(ior->name), std::move(ior->index)};
}

lens::Surface build(const spec::LensSurface& said, const std::set<double>& wavelengths_nm,
                    LoadContext& context) {
  lens::Surface surface;
  surface.profile.curvature = said.radius == 0 ? 0 : 1 / said.radius;
  surface.profile.conic = said.conic;
  surface.profile.even[0] = said.r2;
  if (said.asphere.size() >= surface.profile.even.size())
    context.diagnostics.error(
        said.where,
        fmt::format("an asphere ends at r^20 (got {} coefficients from r^4 on)", said.asphere.size()));
  else
    std::copy(said.asphere.begin(), said.asphere.end(), surface.profile.even.begin() + 1);
  surface.thickness_mm = said.thickness;
  surface.semi_aperture_mm = said.aperture;
  if (said.aperture && !std::isfinite(surface.profile.sag(*said.aperture * *said.aperture)))
    context.diagnostics.error(
        said.where,
        fmt::format("the clear aperture reaches beyond the edge of the surface (got {:g} mm, "
                    "allowed less than {:g} mm)",
                    *said.aperture, 1 / (std::abs(surface.profile.curvature) * std::sqrt(1 + said.conic))));
  surface.decenter_mm = {said.decenter[0], said.decenter[1]};
  surface.tilt_deg = {said.tilt_deg[0], said.tilt_deg[1]};
  surface.coating = build(said.coating, context);
  if (said.glass) surface.behind = build(*said.glass, wavelengths_nm, context);
  return surface;
}

// What is true of any two neighbours: that the second is not before the first where light may pass both.
// Planes and stops in air stand where they like.
void check_gaps(const spec::Lens& said, const System& system, Diagnostics& diagnostics) {
  const auto refracts = [&](std::size_t i) {
    return system.surfaces[i].behind.has_value() || (i > 0 && system.surfaces[i - 1].behind.has_value());
  };
  for (std::size_t i = 0; i + 1 < system.surfaces.size(); ++i) {
    const lens::Surface& first = system.surfaces[i];
    const lens::Surface& second = system.surfaces[i + 1];
    if (!refracts(i) || !refracts(i + 1) || first.displaced() || second.displaced()) continue;
    const double top = std::min(first.semi_aperture_mm.value_or(0), second.semi_aperture_mm.value_or(0));
    for (int k = 0; k <= kGapSamples; ++k) {
      const double h = top * k / kGapSamples;
      const double gap = first.thickness_mm + second.profile.sag(h * h) - first.profile.sag(h * h);
      if (gap >= -kTouch) continue;
      diagnostics.error(
          said.surfaces[i].where,
          fmt::format("surface {} crosses surface {} at {:.4g} mm from the axis, within their clear "
                      "apertures (got a gap of {:.4g} mm, allowed 0 or more)",
                      i + 1, i + 2, h, gap));
      break;
    }
  }
}

void find_stop(const spec::Lens& said, System& system, Diagnostics& diagnostics) {
  std::size_t stops = 0;
  for (std::size_t i = 0; i < said.surfaces.size(); ++i) {
    if (!said.surfaces[i].stop) continue;
    if (++stops == 1)
      system.stop = i;
    else
      diagnostics.error(
          said.surfaces[i].where,
          fmt::format("a second stop: surface {} is the stop already, and a lens has one", system.stop + 1));
  }
  if (stops == 0) diagnostics.error(said.where, "no surface is the stop: a lens has one");
}

void set_aperture(const spec::Lens& said, System& system, Diagnostics& diagnostics) {
  using lens::ApertureKind;
  if (const auto* pupil = std::get_if<spec::PupilDiameter>(&said.aperture))
    system.aperture = {ApertureKind::entrance_pupil, pupil->value};
  else if (const auto* f = std::get_if<spec::FNumber>(&said.aperture))
    system.aperture = {ApertureKind::f_number, f->value};
  else if (const auto& stop = said.surfaces[system.stop]; stop.aperture)
    system.aperture = {ApertureKind::stop, *stop.aperture};
  else
    diagnostics.error(
        said.where,
        "how wide is the lens open? It needs an entrance pupil, an f-number or the aperture of its stop");
}

void set_wavelengths(const spec::Lens& said, System& system, Diagnostics& diagnostics) {
  system.wavelengths_nm = said.wavelengths_nm;
  if (said.wavelengths_nm.empty()) return diagnostics.error(said.where, "a lens needs a wavelength");
  system.primary = said.wavelengths_nm.size() / 2;
  if (!said.primary_nm) return;
  const auto found =
      std::find(said.wavelengths_nm.begin(), said.wavelengths_nm.end(), said.primary_nm->value);
  if (found == said.wavelengths_nm.end())
    diagnostics.error(said.primary_nm->where,
                      fmt::format("the primary wavelength is none of the lens's (got {}, allowed {})",
                                  said.primary_nm->value, fmt::join(said.wavelengths_nm, ", ")));
  system.primary = static_cast<std::size_t>(found - said.wavelengths_nm.begin());
}

void require_air(const spec::Lens& said, const System& system, Diagnostics& diagnostics) {
  const auto& glass = system.surfaces.back().behind;
  if (glass && glass->index.n(system.primary_nm()) != 1)
    diagnostics.error(
        said.surfaces.back().where,
        fmt::format("the image of a lens is in air (got {} behind the last surface)", glass->name));
}

// Heights of a near object that are seen under these angles from the entrance pupil.
std::vector<double> object_heights(const spec::Lens& said, std::vector<double> angles_deg, double pupil_mm,
                                   Diagnostics& diagnostics) {
  for (double& field : angles_deg) {
    if (field == 0) continue;
    if (!(std::abs(field) < 90)) {
      diagnostics.error(said.where,
                        fmt::format("fields_deg of a near object are less than 90 degrees from the axis (got "
                                    "{:g}, allowed (-90, 90))",
                                    field));
    } else if (!(std::abs(pupil_mm) <= spec::kMaxMm)) {
      diagnostics.error(said.where,
                        fmt::format("fields_deg of a near object are seen from the entrance pupil, and this "
                                    "lens is telecentric: say object_heights (got a pupil {:g} mm behind the "
                                    "first surface, allowed [{:g}, {:g}])",
                                    pupil_mm, -spec::kMaxMm, spec::kMaxMm));
      break;
    }
    field = -(*said.object_distance + pupil_mm) * std::tan(field * kDegree);
  }
  return angles_deg;
}

// The fields that have these paraxial heights in the image.
std::vector<double> fields_of_image(const spec::Lens& said, std::vector<double> heights,
                                    const lens::FirstOrder& first, Diagnostics& diagnostics) {
  if (!(std::abs(first.image_distance_mm) <= spec::kMaxMm))
    diagnostics.error(said.where,
                      fmt::format("image_heights need an image, and the lens has it at infinity: say {} (got "
                                  "an image {:g} mm behind the last surface, allowed [{:g}, {:g}])",
                                  said.object_distance ? "object_heights" : "fields_deg",
                                  first.image_distance_mm, -spec::kMaxMm, spec::kMaxMm));
  for (double& field : heights)
    field = said.object_distance ? field / first.magnification
                                 : std::atan(field / first.focal_length_mm) / kDegree;
  return heights;
}

// Fields of any kind as the tracing takes them: directions of objects at infinity, heights of near ones.
void set_fields(const spec::Lens& said, System& system, Diagnostics& diagnostics) {
  const lens::FirstOrder first = lens::first_order(lens::SystemAt(system, system.primary_nm()));
  if (const auto* angles = std::get_if<spec::FieldAngles>(&said.fields)) {
    system.fields = said.object_distance
                        ? object_heights(said, angles->value, first.entrance_pupil_mm, diagnostics)
                        : angles->value;
  } else if (const auto* heights = std::get_if<spec::ObjectHeights>(&said.fields)) {
    if (!said.object_distance)
      diagnostics.error(said.where,
                        "object_heights need an object_distance: of an object at infinity say fields_deg");
    system.fields = heights->value;
  } else if (const auto* images = std::get_if<spec::ImageHeights>(&said.fields)) {
    system.fields = fields_of_image(said, images->value, first, diagnostics);
  }
  if (system.fields.empty()) system.fields = {0};
}

// How far behind the last vertex the image is that is asked for.
std::optional<double> image_distance(const spec::Lens& said, System system, Diagnostics& diagnostics) {
  double& last = system.surfaces.back().thickness_mm;
  if (said.focus == spec::LensFocus::given) return last;
  last = lens::first_order(lens::SystemAt(system, system.primary_nm())).image_distance_mm;
  if (!(std::abs(last) <= spec::kMaxMm)) {
    diagnostics.error(
        said.where,
        fmt::format("the lens is afocal and has no focus: its image is \"given\" by the last "
                    "thickness (got a focus {:g} mm behind the last surface, allowed [{:g}, {:g}])",
                    last, -spec::kMaxMm, spec::kMaxMm));
    return std::nullopt;
  }
  if (said.focus == spec::LensFocus::paraxial) return last;
  const auto shift = lens::best_focus(system);
  if (!shift) diagnostics.error(said.where, "no beam of the lens comes together: it has no best focus");
  return shift ? std::optional(last + *shift) : std::nullopt;
}

void set_focus(const spec::Lens& said, System& system, Diagnostics& diagnostics) {
  if (const auto distance = image_distance(said, system, diagnostics))
    system.surfaces.back().thickness_mm = *distance + said.defocus;
  system.defocus_mm = said.defocus;
}

// Its stop and its image stay as they are set at its own primary wavelength.
void look_at(System& system, const std::vector<double>& wavelengths_nm) {
  system.aperture = {lens::ApertureKind::stop, lens::stop_radius(system)};
  system.set_at_nm = system.primary_nm();
  system.wavelengths_nm = wavelengths_nm;
  system.primary = wavelengths_nm.size() / 2;
}

// What the lens is said to open to, with this value of it.
std::string opening(lens::ApertureKind kind, double value) {
  return kind == lens::ApertureKind::entrance_pupil ? fmt::format("an entrance pupil of {:.4g} mm", value)
                                                    : fmt::format("f/{:.4g}", value);
}

// The widest for which the stop is no wider than its own aperture.
std::string widest_opening(const System& system, double stop_aperture_mm) {
  constexpr int kCells = 16;
  const auto speed = lens::speed(lens::SystemAt(system, system.primary_nm()), stop_aperture_mm, kCells);
  if (!speed) return "what lets light pass it";
  const lens::ApertureKind kind = system.aperture.kind;
  const bool by_pupil = kind == lens::ApertureKind::entrance_pupil;
  const double widest = by_pupil ? speed->entrance_diameter_mm : speed->f_number;
  if (!std::isfinite(widest)) return "what its aperture says";
  return opening(kind, widest) + (by_pupil ? " or less" : " or more");
}

// A stop whose own clear aperture is less than what the lens is said to open to.
void check_stop(const spec::Lens& said, const System& system, Diagnostics& diagnostics) {
  const std::optional<double>& aperture = system.surfaces[system.stop].semi_aperture_mm;
  if (!aperture || lens::stop_radius(system) <= *aperture * (1 + lens::kNominalRounding)) return;
  diagnostics.error(
      said.surfaces[system.stop].where,
      fmt::format("the stop does not open so far, its aperture being {:g} mm (got {}, allowed {})", *aperture,
                  opening(system.aperture.kind, system.aperture.value), widest_opening(system, *aperture)));
}

void warn_of_cut_beam(const spec::Lens& said, const System& system, Diagnostics& diagnostics) {
  const auto ray = lens::cut_rim_ray(lens::SystemAt(system, system.primary_nm()), lens::stop_radius(system));
  if (!ray) return;
  diagnostics.warning(
      said.where,
      fmt::format("the axial beam that fills the stop does not get to the image whole: its rim {}. "
                  "T-stops count that, f-numbers do not",
                  lens::reason(*ray)));
}

// Stop and image; at these wavelengths, if there are any. False after an error.
bool set_up(const spec::Lens& said, System& system, const std::vector<double>& wavelengths_nm,
            Diagnostics& diagnostics) {
  try {
    check_stop(said, system, diagnostics);
    if (diagnostics.has_errors()) return false;
    set_focus(said, system, diagnostics);
    if (diagnostics.has_errors()) return false;
    warn_of_cut_beam(said, system, diagnostics);
    if (!wavelengths_nm.empty()) look_at(system, wavelengths_nm);
    return true;
  } catch (const Error& error) {  // of a stop that its ray does not get to
    diagnostics.error(said.where, error.what());
    return false;
  }
}

}  // namespace

std::optional<System> build(const spec::Lens& said, LoadContext& context,
                            const std::vector<double>& wavelengths_nm) {
  System system;
  system.title = said.title;
  system.source = said.source;
  std::set<double> all_nm(said.wavelengths_nm.begin(), said.wavelengths_nm.end());
  all_nm.insert(wavelengths_nm.begin(), wavelengths_nm.end());
  for (const spec::LensSurface& surface : said.surfaces)
    system.surfaces.push_back(build(surface, all_nm, context));
  system.object_distance_mm = said.object_distance;
  find_stop(said, system, context.diagnostics);
  set_aperture(said, system, context.diagnostics);
  set_wavelengths(said, system, context.diagnostics);
  check_gaps(said, system, context.diagnostics);
  if (context.diagnostics.has_errors()) return std::nullopt;
  require_air(said, system, context.diagnostics);
  set_fields(said, system, context.diagnostics);
  if (context.diagnostics.has_errors()) return std::nullopt;
  if (!set_up(said, system, wavelengths_nm, context.diagnostics)) return std::nullopt;
  return system;
}

}  // namespace abbe::description
