#include "report/lens_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lens/spot.h"

namespace abbe {
namespace {

using lens::Beam;
using lens::Spot;
using lens::SystemAt;

// Shortest and longest wavelength, between which colour errors are computed.
std::pair<double, double> ends(const std::vector<double>& wavelengths_nm) {
  const auto [low, high] = std::minmax_element(wavelengths_nm.begin(), wavelengths_nm.end());
  return {*low, *high};
}

lens::SeidelSums seidel_of(const lens::System& system, const LensFigures& figures) {
  const auto [blue, red] = ends(system.wavelengths_nm);
  const double outermost = *std::max_element(system.fields.begin(), system.fields.end(),
                                             [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto& speed = figures.speed[system.primary];
  const double radius = speed ? speed->launch_diameter_mm / 2 : std::numeric_limits<double>::quiet_NaN();
  return lens::seidel_sums(SystemAt(system, system.primary_nm()), SystemAt(system, blue),
                           SystemAt(system, red), radius, outermost);
}

std::vector<lens::RayFan> fans_of(const lens::System& system, double field, double stop_radius_mm, int rays) {
  const SystemAt primary(system, system.primary_nm());
  const auto primary_beam = Beam::of(primary, field, stop_radius_mm);
  if (!primary_beam) return {};
  const auto chief =
      lens::trace(primary, primary_beam->launch(primary_beam->chief()), lens::Apertures::ignored);
  if (!chief.reached()) return {};
  std::vector<lens::RayFan> fans;
  for (const double nm : system.wavelengths_nm) {
    const SystemAt at(system, nm);
    const auto beam = Beam::of(at, field, stop_radius_mm);
    fans.push_back(beam ? lens::ray_fan(*beam, {chief.last.origin.x, chief.last.origin.y}, rays)
                        : lens::RayFan{});
  }
  return fans;
}

LensFieldFigures at_field(const lens::System& system, double field, std::vector<Spot> spots,
                          double stop_radius_mm, const LensAnalysisSettings& settings) {
  LensFieldFigures figures{field, std::move(spots), {}, {}, {}, {}, {}};
  for (const double nm : system.wavelengths_nm)
    figures.chiefs.push_back(lens::chief_ray(SystemAt(system, nm), field, stop_radius_mm));
  figures.fans = fans_of(system, field, stop_radius_mm, settings.fan_rays);
  for (const double per_mm : settings.frequencies_per_mm) {
    figures.tangential_mtf.push_back(lens::geometric_mtf(figures.spots, per_mm, {0, 1}));
    figures.sagittal_mtf.push_back(lens::geometric_mtf(figures.spots, per_mm, {1, 0}));
  }
  return figures;
}

void add_illumination(LensFigures& figures, int cells) {
  const SystemAt primary(figures.system, figures.system.primary_nm());
  const auto axis = Beam::of(primary, 0, figures.stop_radius_mm);
  if (!axis) return;
  const Spot on_axis = lens::spot(*axis, 0, cells);
  for (LensFieldFigures& field : figures.fields)
    field.relative_illumination = lens::relative_illumination(primary, field.field, figures.stop_radius_mm,
                                                              field.spots[figures.system.primary], on_axis);
}

std::vector<GhostFigures> ghosts_of(const lens::System& system, double stop_radius_mm) {
  const auto [blue, red] = ends(system.wavelengths_nm);
  const SystemAt at(system, system.primary_nm());
  std::vector<GhostFigures> all;
  for (const lens::Ghost& ghost : lens::ghosts(system, blue, red)) {
    const lens::GhostFocus focus = lens::ghost_focus(at, ghost, stop_radius_mm);
    all.push_back({ghost, focus.image_distance_mm - system.surfaces.back().thickness_mm, focus.diameter_mm});
  }
  const auto brightness = [](const GhostFigures& of) {
    return of.ghost.reflectance / (of.diameter_mm * of.diameter_mm);
  };
  std::sort(all.begin(), all.end(),
            [&](const GhostFigures& a, const GhostFigures& b) { return brightness(a) > brightness(b); });
  return all;
}

}  // namespace

std::optional<double> LensFieldFigures::lateral_color_mm() const {
  const auto by_wavelength = [](const Spot& a, const Spot& b) { return a.wavelength_nm < b.wavelength_nm; };
  const auto [blue, red] = std::minmax_element(spots.begin(), spots.end(), by_wavelength);
  const auto& first = chiefs[static_cast<std::size_t>(blue - spots.begin())];
  const auto& last = chiefs[static_cast<std::size_t>(red - spots.begin())];
  return first && last ? std::optional(first->height_mm - last->height_mm) : std::nullopt;
}

std::string LensFigures::field_name(double field) const {
  return fmt::format("{:.4g} {}", field, system.object_distance_mm ? "mm" : "deg");
}

LensFigures lens_figures(const lens::System& system, const LensAnalysisSettings& settings) {
  LensFigures figures{.system = system,
                      .stop_radius_mm = lens::stop_radius(system),
                      .first_order = {},
                      .speed = {},
                      .seidel = {},
                      .best_focus_mm = {},
                      .frequencies_per_mm = settings.frequencies_per_mm,
                      .fields = {},
                      .ghosts = {}};
  for (const double nm : system.wavelengths_nm) {
    const SystemAt at(system, nm);
    figures.first_order.push_back(lens::first_order(at));
    figures.speed.push_back(lens::speed(at, figures.stop_radius_mm, settings.cells));
  }
  figures.seidel = seidel_of(system, figures);
  figures.ghosts = ghosts_of(system, figures.stop_radius_mm);
  auto spots = lens::all_spots(system, figures.stop_radius_mm, settings.cells);
  figures.best_focus_mm = lens::best_focus(spots);
  for (std::size_t i = 0; i < spots.size(); ++i)
    figures.fields.push_back(
        at_field(system, system.fields[i], std::move(spots[i]), figures.stop_radius_mm, settings));
  add_illumination(figures, settings.cells);
  return figures;
}

}  // namespace abbe
