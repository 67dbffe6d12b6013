#include "description/lens.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "io/error.h"
#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/spot.h"
#include "sampling/angle.h"

namespace abbe::spec {

using namespace schema;

namespace {

constexpr Range kMm = Range{-kMaxMm, kMaxMm}.in("mm");
constexpr Range kTilt = Range{-89, 89}.in("degrees");

}  // namespace

static Fields fields(Tag<ModelGlass>) {
  return describe("model_glass", "A glass given by two numbers: n = A + B/lambda^2 through both.",
                  {field("nd", &ModelGlass::nd, kModelIndex, "Index at 587.5618 nm."),
                   field("vd", &ModelGlass::vd, kAbbeNumber, "Abbe number (n_d - 1)/(n_F - n_C).")});
}

static ValueType value_type(Tag<LensGlass::Wrapped>) {
  return forms<LensGlass::Wrapped>("lens_glass",
                                   "a glass: an index, nd and vd, an object of n and k, or a name",
                                   form<ModelGlass>(Json::object, {"nd", "vd"}), form<Ior>(Json::any));
}

static Fields fields(Tag<LensSurface>) {
  using Pair = std::array<double, 2>;
  return describe(
             "lens_surface", "A surface and the space behind it.",
             {defaulted("radius", &LensSurface::radius, kMm,
                        "Radius of curvature, positive if the center is behind the surface; 0 for a plane."),
              defaulted("thickness", &LensSurface::thickness, kMm,
                        "Distance to the next surface, or to the image."),
              field("glass", &LensSurface::glass, "Glass behind the surface; air if absent."),
              field("aperture", &LensSurface::aperture, kPositiveMm,
                    "Half the diameter of the clear aperture."),
              defaulted("stop", &LensSurface::stop, "True if this surface is the aperture stop."),
              defaulted("conic", &LensSurface::conic, {-1e6, 1e6},
                        "Conic constant: 0 for a sphere, -1 for a paraboloid."),
              defaulted("r2", &LensSurface::r2, Range::any(), "Coefficient of r^2 [1/mm]."),
              defaulted("asphere", &LensSurface::asphere, Range::any(),
                        "Coefficients of r^4, r^6, ... to r^20."),
              defaulted("decenter", &LensSurface::decenter, vector<Pair>(kMm),
                        "Displacement of the vertex along x and y; the following surfaces do not move."),
              defaulted("tilt_deg", &LensSurface::tilt_deg, vector<Pair>(kTilt),
                        "Tilt about x, then about the tilted y."),
              defaulted("coating", &LensSurface::coating, "Thin films, from the air inwards.")})
      .or_array(2, 4);
}

Fields fields(Tag<Lens>) {
  return describe(
      "lens", "Lengths are in mm, wavelengths in nm, indices relative to air.",
      {defaulted("title", &Lens::title, "Title of the lens."),
       defaulted("source", &Lens::source, "Source of the data."),
       field("surfaces", &Lens::surfaces, list<LensSurface>("surfaces", 1),
             "Surfaces in the order in which light passes them."),
       at_most_one(&Lens::aperture, "a lens has one aperture",
                   under<PupilDiameter>("entrance_pupil", kPositiveMm,
                                        "Diameter of the axial beam in the entrance pupil."),
                   under<FNumber>("f_number", {0, 1e6, true, false},
                                  "Focal length over the diameter of the entrance pupil.")),
       at_most_one(
           &Lens::fields, "a lens has fields of one kind",
           under<FieldAngles>("fields_deg", kFieldAngle, "Field angles; 0 if absent."),
           under<ObjectHeights>("object_heights", kMm, "Object heights of an object at a finite distance."),
           under<ImageHeights>("image_heights", kMm, "Paraxial image heights.")),
       field("object_distance", &Lens::object_distance, kPositiveMm,
             "Distance of the object from the first surface; infinity if absent."),
       defaulted("wavelengths_nm", &Lens::wavelengths_nm, kWavelength,
                 "Wavelengths at which the lens is evaluated."),
       field("primary_nm", &Lens::primary_nm, kWavelength,
             "The one of these wavelengths at which stop and focus are set; the median one if absent."),
       defaulted("focus", &Lens::focus, enumeration<LensFocus>("focus", {"given", "paraxial", "best"}),
                 "Position of the image: at the last thickness, at the paraxial focus, or where the spots of "
                 "all fields are smallest."),
       defaulted("defocus", &Lens::defocus, kMm, "Displacement of the image from there.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

using lens::System;

constexpr double kCNm = 656.2725;
constexpr double kDNm = 587.5618;
constexpr double kFNm = 486.1327;
constexpr int kGapSamples = 64;
constexpr double kGapTolerance = 1e-9;  // Overlap [mm] allowed where surfaces meet at their rim.

// n = A + B/lambda^2 through n_d with n_F - n_C = (n_d - 1)/V_d.
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

std::optional<lens::Glass> build(const spec::LensGlass& spec, const std::set<double>& wavelengths_nm,
                                 LoadContext& context) {
  if (const auto* model = std::get_if<spec::ModelGlass>(&spec.value)) return model_glass(*model);
  auto ior = build(std::get<spec::Ior>(spec.value), context);
  if (!ior) return std::nullopt;
  for (const double nm : wavelengths_nm)
    if (nm < ior->index.low_nm() || nm > ior->index.high_nm()) {
      context.diagnostics.warning(
          spec.where, fmt::format("{} has no data at {:g} nm: its index at {:g} nm is used", ior->name, nm,
                                  std::clamp(nm, ior->index.low_nm(), ior->index.high_nm())));
    }
  return lens::Glass{std::move(ior->name), std::move(ior->index)};
}

// Builds a surface. A conic of curvature c and conic constant k ends at the height 1/(|c| sqrt(1 + k)), where
// its sag is no longer real.
lens::Surface build(const spec::LensSurface& spec, const std::set<double>& wavelengths_nm,
                    LoadContext& context) {
  lens::Surface surface;
  surface.profile.curvature = spec.radius == 0 ? 0 : 1 / spec.radius;
  surface.profile.conic = spec.conic;
  surface.profile.even[0] = spec.r2;
  if (spec.asphere.size() >= surface.profile.even.size())
    context.diagnostics.error(
        spec.where,
        fmt::format("an asphere ends at r^20 (got {} coefficients from r^4 on)", spec.asphere.size()));
  else
    std::copy(spec.asphere.begin(), spec.asphere.end(), surface.profile.even.begin() + 1);
  surface.thickness_mm = spec.thickness;
  surface.semi_aperture_mm = spec.aperture;
  if (spec.aperture && !std::isfinite(surface.profile.sag(*spec.aperture * *spec.aperture)))
    context.diagnostics.error(
        spec.where,
        fmt::format("the clear aperture is larger than the surface (got {:g} mm, allowed less than {:g} mm)",
                    *spec.aperture, 1 / (std::abs(surface.profile.curvature) * std::sqrt(1 + spec.conic))));
  surface.decenter_mm = {spec.decenter[0], spec.decenter[1]};
  surface.tilt_deg = {spec.tilt_deg[0], spec.tilt_deg[1]};
  surface.coating = build(spec.coating, context);
  if (spec.glass) surface.behind = build(*spec.glass, wavelengths_nm, context);
  return surface;
}

// Reports surfaces that cross: the second must not be in front of the first within both clear apertures.
// Planes and stops in air may be anywhere.
void check_gaps(const spec::Lens& spec, const System& system, Diagnostics& diagnostics) {
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
      if (gap >= -kGapTolerance) continue;
      diagnostics.error(
          spec.surfaces[i].where,
          fmt::format("surface {} crosses surface {} at {:.4g} mm from the axis, within their clear "
                      "apertures (got a gap of {:.4g} mm, allowed 0 or more)",
                      i + 1, i + 2, h, gap));
      break;
    }
  }
}

void find_stop(const spec::Lens& spec, System& system, Diagnostics& diagnostics) {
  std::size_t stops = 0;
  for (std::size_t i = 0; i < spec.surfaces.size(); ++i) {
    if (!spec.surfaces[i].stop) continue;
    if (++stops == 1)
      system.stop = i;
    else
      diagnostics.error(spec.surfaces[i].where,
                        fmt::format("a lens has one stop: surface {} is already the stop", system.stop + 1));
  }
  if (stops == 0) diagnostics.error(spec.where, "a lens needs a stop, and no surface is marked as the stop");
}

void set_aperture(const spec::Lens& spec, System& system, Diagnostics& diagnostics) {
  using lens::ApertureKind;
  if (const auto* pupil = std::get_if<spec::PupilDiameter>(&spec.aperture))
    system.aperture = {ApertureKind::entrance_pupil, pupil->value};
  else if (const auto* f = std::get_if<spec::FNumber>(&spec.aperture))
    system.aperture = {ApertureKind::f_number, f->value};
  else if (const auto& stop = spec.surfaces[system.stop]; stop.aperture)
    system.aperture = {ApertureKind::stop, *stop.aperture};
  else
    diagnostics.error(
        spec.where,
        "the lens has no aperture: it needs an entrance pupil, an f-number or a clear aperture of its stop");
}

void set_wavelengths(const spec::Lens& spec, System& system, Diagnostics& diagnostics) {
  system.wavelengths_nm = spec.wavelengths_nm;
  if (spec.wavelengths_nm.empty()) return diagnostics.error(spec.where, "a lens needs a wavelength");
  system.primary = spec.wavelengths_nm.size() / 2;
  if (!spec.primary_nm) return;
  const auto found =
      std::find(spec.wavelengths_nm.begin(), spec.wavelengths_nm.end(), spec.primary_nm->value);
  if (found == spec.wavelengths_nm.end())
    diagnostics.error(
        spec.primary_nm->where,
        fmt::format("the primary wavelength must be one of the wavelengths of the lens (got {}, allowed {})",
                    spec.primary_nm->value, fmt::join(spec.wavelengths_nm, ", ")));
  system.primary = static_cast<std::size_t>(found - spec.wavelengths_nm.begin());
}

// Heights of an object at a finite distance that appear under these angles from the entrance pupil.
std::vector<double> object_heights(const spec::Lens& spec, std::vector<double> angles_deg, double pupil_mm,
                                   Diagnostics& diagnostics) {
  for (double& field : angles_deg) {
    if (field == 0) continue;
    if (!(std::abs(field) < 90)) {
      diagnostics.error(spec.where, fmt::format("fields_deg of an object at a finite distance must be within "
                                                "90 degrees of the axis (got {:g}, allowed (-90, 90))",
                                                field));
    } else if (!(std::abs(pupil_mm) <= spec::kMaxMm)) {
      diagnostics.error(
          spec.where,
          fmt::format(
              "fields_deg need an entrance pupil at a finite distance, and this lens is telecentric: use "
              "object_heights (got a pupil {:g} mm behind the first surface, allowed [{:g}, {:g}])",
              pupil_mm, -spec::kMaxMm, spec::kMaxMm));
      break;
    }
    field = -(*spec.object_distance + pupil_mm) * std::tan(field * kDegree);
  }
  return angles_deg;
}

// Fields with these paraxial image heights.
std::vector<double> fields_of_image(const spec::Lens& spec, std::vector<double> heights,
                                    const lens::FirstOrder& first, Diagnostics& diagnostics) {
  if (!(std::abs(first.image_distance_mm) <= spec::kMaxMm))
    diagnostics.error(spec.where,
                      fmt::format("image_heights need an image at a finite distance: use {} (got an image "
                                  "{:g} mm behind the last surface, allowed [{:g}, {:g}])",
                                  spec.object_distance ? "object_heights" : "fields_deg",
                                  first.image_distance_mm, -spec::kMaxMm, spec::kMaxMm));
  for (double& field : heights)
    field = spec.object_distance ? field / first.magnification
                                 : std::atan(field / first.focal_length_mm) / kDegree;
  return heights;
}

// Converts fields of any kind to those that ray tracing uses: angles for an object at infinity, else object
// heights.
void set_fields(const spec::Lens& spec, System& system, Diagnostics& diagnostics) {
  const lens::FirstOrder first = lens::first_order(lens::SystemAt(system, system.primary_nm()));
  if (const auto* angles = std::get_if<spec::FieldAngles>(&spec.fields)) {
    system.fields = spec.object_distance
                        ? object_heights(spec, angles->value, first.entrance_pupil_mm, diagnostics)
                        : angles->value;
  } else if (const auto* heights = std::get_if<spec::ObjectHeights>(&spec.fields)) {
    if (!spec.object_distance)
      diagnostics.error(spec.where,
                        "object_heights need an object_distance: use fields_deg for an object at infinity");
    system.fields = heights->value;
  } else if (const auto* images = std::get_if<spec::ImageHeights>(&spec.fields)) {
    system.fields = fields_of_image(spec, images->value, first, diagnostics);
  }
  if (system.fields.empty()) system.fields = {0};
}

// Distance [mm] from the last vertex to the requested image.
std::optional<double> image_distance(const spec::Lens& spec, System system, Diagnostics& diagnostics) {
  double& last = system.surfaces.back().thickness_mm;
  if (spec.focus == spec::LensFocus::given) return last;
  last = lens::first_order(lens::SystemAt(system, system.primary_nm())).image_distance_mm;
  if (!(std::abs(last) <= spec::kMaxMm)) {
    diagnostics.error(
        spec.where,
        fmt::format("the lens is afocal and has no focus: use focus \"given\", with the image at the last "
                    "thickness (got a focus {:g} mm behind the last surface, allowed [{:g}, {:g}])",
                    last, -spec::kMaxMm, spec::kMaxMm));
    return std::nullopt;
  }
  if (spec.focus == spec::LensFocus::paraxial) return last;
  const auto shift = lens::best_focus(system);
  if (!shift) diagnostics.error(spec.where, "no beam of the lens converges: it has no best focus");
  return shift ? std::optional(last + *shift) : std::nullopt;
}

// Text of an aperture of this kind with this value.
std::string describe_aperture(lens::ApertureKind kind, double value) {
  return kind == lens::ApertureKind::entrance_pupil ? fmt::format("an entrance pupil of {:.4g} mm", value)
                                                    : fmt::format("f/{:.4g}", value);
}

// Text of the widest aperture for which the stop is within its own clear aperture.
std::string widest_opening(const System& system, double stop_aperture_mm) {
  constexpr int kCells = 16;
  const auto speed = lens::speed(lens::SystemAt(system, system.primary_nm()), stop_aperture_mm, kCells);
  if (!speed) return "an aperture that light passes";
  const lens::ApertureKind kind = system.aperture.kind;
  const bool by_pupil = kind == lens::ApertureKind::entrance_pupil;
  const double widest = by_pupil ? speed->entrance_diameter_mm : speed->f_number;
  if (!std::isfinite(widest)) return "the aperture of its stop";
  return describe_aperture(kind, widest) + (by_pupil ? " or less" : " or more");
}

// Reports a stop whose clear aperture is smaller than the aperture of the lens requires.
void check_stop(const spec::Lens& spec, const System& system, Diagnostics& diagnostics) {
  const std::optional<double>& aperture = system.surfaces[system.stop].semi_aperture_mm;
  if (!aperture || lens::stop_radius(system) <= *aperture * (1 + lens::kNominalRounding)) return;
  diagnostics.error(
      spec.surfaces[system.stop].where,
      fmt::format("the stop cannot open that far, because its clear aperture is {:g} mm (got {}, allowed {})",
                  *aperture, describe_aperture(system.aperture.kind, system.aperture.value),
                  widest_opening(system, *aperture)));
}

// Sets stop and image, then the wavelengths if any are given. False after an error.
bool set_up(const spec::Lens& spec, System& system, const std::vector<double>& wavelengths_nm,
            Diagnostics& diagnostics) {
  try {
    check_stop(spec, system, diagnostics);
    if (diagnostics.has_errors()) return false;
    const auto distance = image_distance(spec, system, diagnostics);
    if (!distance) return false;
    system.surfaces.back().thickness_mm = *distance + spec.defocus;
    system.defocus_mm = spec.defocus;
    const double stop = lens::stop_radius(system);
    if (const auto ray = lens::cut_rim_ray(lens::SystemAt(system, system.primary_nm()), stop))
      diagnostics.warning(spec.where,
                          fmt::format("part of the axial beam that fills the stop does not reach the image: "
                                      "its rim {}. T-stops include this loss, f-numbers do not",
                                      lens::reason(*ray)));
    if (wavelengths_nm.empty()) return true;
    // Stop and image stay as they are set at the lens's own primary wavelength.
    system.aperture = {lens::ApertureKind::stop, stop};
    system.set_at_nm = system.primary_nm();
    system.wavelengths_nm = wavelengths_nm;
    system.primary = wavelengths_nm.size() / 2;
    return true;
  } catch (const Error& error) {  // Thrown if no ray reaches the rim of the stop.
    diagnostics.error(spec.where, error.what());
    return false;
  }
}

}  // namespace

std::optional<System> build(const spec::Lens& spec, LoadContext& context,
                            const std::vector<double>& wavelengths_nm) {
  System system;
  system.title = spec.title;
  system.source = spec.source;
  std::set<double> all_nm(spec.wavelengths_nm.begin(), spec.wavelengths_nm.end());
  all_nm.insert(wavelengths_nm.begin(), wavelengths_nm.end());
  for (const spec::LensSurface& surface : spec.surfaces)
    system.surfaces.push_back(build(surface, all_nm, context));
  system.object_distance_mm = spec.object_distance;
  find_stop(spec, system, context.diagnostics);
  set_aperture(spec, system, context.diagnostics);
  set_wavelengths(spec, system, context.diagnostics);
  check_gaps(spec, system, context.diagnostics);
  if (context.diagnostics.has_errors()) return std::nullopt;
  if (const auto& glass = system.surfaces.back().behind; glass && glass->index.n(system.primary_nm()) != 1)
    context.diagnostics.error(
        spec.surfaces.back().where,
        fmt::format("the image of a lens must be in air (got {} behind the last surface)", glass->name));
  set_fields(spec, system, context.diagnostics);
  if (context.diagnostics.has_errors()) return std::nullopt;
  if (!set_up(spec, system, wavelengths_nm, context.diagnostics)) return std::nullopt;
  return system;
}

}  // namespace abbe::description
