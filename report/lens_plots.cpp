#include "report/lens_plots.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "report/layout.h"
#include "report/line_plot.h"
#include "report/svg.h"

namespace abbe {
namespace {

constexpr double kPerMm = 1000;  // micrometres
constexpr double kSpotSide = 200;
constexpr double kSpotTop = 40;
constexpr std::size_t kMaxDots = 700;  // of a spot
constexpr int kMtfPoints = 60;
constexpr int kShiftStepNm = 5;
constexpr std::array<const char*, 6> kFieldColors{"#2060c0", "#208040", "#c03030",
                                                  "#a06000", "#8030a0", "#008080"};

// Largest distance of any ray from the chief ray of its field.
double max_spot_distance(const LensFigures& figures) {
  double max_distance = 1e-6;
  for (const LensFieldFigures& field : figures.fields)
    if (const auto& chief = field.chiefs[figures.system.primary])
      for (const lens::Spot& spot : field.spots)
        for (const lens::SpotRay& ray : spot.rays)
          max_distance = std::max(max_distance, (ray.point - Imath::V2d(0, chief->height_mm)).length());
  return max_distance;
}

std::string dots(const LensFieldFigures& field, const Imath::V2d& chief, double x, double y, double scale) {
  std::string all;
  for (const lens::Spot& spot : field.spots) {
    const std::string style =
        fmt::format("fill=\"{}\" fill-opacity=\"0.6\"", wavelength_color(spot.wavelength_nm));
    const std::size_t step = spot.rays.size() / kMaxDots + 1;
    for (std::size_t i = 0; i < spot.rays.size(); i += step) {
      const Imath::V2d p = spot.rays[i].point - chief;
      all += svg_circle(x + scale * p.x, y - scale * p.y, 0.9, style);
    }
  }
  return all;
}

}  // namespace

std::string spot_plot(const LensFigures& figures) {
  const double max_distance = max_spot_distance(figures);
  const double scale = 0.45 * kSpotSide / max_distance;
  std::string elements;
  double left = 10;
  for (const LensFieldFigures& field : figures.fields) {
    const double x = left + kSpotSide / 2;
    const double y = kSpotTop + kSpotSide / 2;
    elements += svg_rect(left, kSpotTop, kSpotSide, kSpotSide, "fill=\"none\" stroke=\"#888888\"");
    if (const auto& chief = field.chiefs[figures.system.primary])
      elements += dots(field, {0, chief->height_mm}, x, y, scale);
    if (const auto& speed = figures.speed[figures.system.primary])
      elements += svg_circle(x, y, scale * speed->airy_radius_um / kPerMm, "fill=\"none\" stroke=\"black\"");
    elements +=
        svg_text(x, kSpotTop + kSpotSide + 18, figures.field_name(field.field), "text-anchor=\"middle\"");
    left += kSpotSide + 10;
  }
  return svg_document(
      std::max(left, 420.0), kSpotTop + kSpotSide + 30,
      fmt::format("Spots, boxes {:.4g} um wide; black: Airy disc", kSpotSide / scale * kPerMm), elements);
}

std::string fan_plot(const LensFigures& figures, const LensFieldFigures& field) {
  LinePlot plot{"Ray fans at " + figures.field_name(field.field),
                "height in the stop [radii]",
                "error along y, dashed x [um]",
                {}};
  for (std::size_t w = 0; w < field.fans.size(); ++w) {
    const double nm = figures.system.wavelengths_nm[w];
    PlotSeries tangential{fmt::format("{:.4g} nm", nm), {}, wavelength_color(nm), false, false};
    PlotSeries sagittal{"", {}, wavelength_color(nm), true, false};
    const lens::RayFan& fan = field.fans[w];
    for (std::size_t i = 0; i < fan.pupil.size(); ++i) {
      if (fan.tangential[i]) tangential.points.emplace_back(fan.pupil[i], kPerMm * *fan.tangential[i]);
      if (fan.sagittal[i]) sagittal.points.emplace_back(fan.pupil[i], kPerMm * *fan.sagittal[i]);
    }
    plot.series.push_back(std::move(tangential));
    plot.series.push_back(std::move(sagittal));
  }
  return svg(plot);
}

std::string lens_mtf_plot(const LensFigures& figures) {
  LinePlot plot{"Geometric modulation transfer, sagittal dashed", "lines per mm", "modulation", {}};
  const double highest =
      *std::max_element(figures.frequencies_per_mm.begin(), figures.frequencies_per_mm.end());
  for (std::size_t f = 0; f < figures.fields.size(); ++f) {
    const LensFieldFigures& field = figures.fields[f];
    const std::string color = kFieldColors[f % kFieldColors.size()];
    PlotSeries tangential{figures.field_name(field.field), {}, color, false, false};
    PlotSeries sagittal{"", {}, color, true, false};
    for (int i = 0; i <= kMtfPoints; ++i) {
      const double per_mm = highest * i / kMtfPoints;
      tangential.points.emplace_back(per_mm, lens::geometric_mtf(field.spots, per_mm, {0, 1}));
      sagittal.points.emplace_back(per_mm, lens::geometric_mtf(field.spots, per_mm, {1, 0}));
    }
    plot.series.push_back(std::move(tangential));
    plot.series.push_back(std::move(sagittal));
  }
  return svg(plot);
}

std::string focal_shift_plot(const LensFigures& figures) {
  const lens::System& system = figures.system;
  const double reference = figures.first_order[system.primary].image_distance_mm;
  const auto [low, high] = std::minmax_element(system.wavelengths_nm.begin(), system.wavelengths_nm.end());
  PlotSeries series{"", {}, "#2060c0", false, false};
  for (double nm = *low; nm < *high + kShiftStepNm; nm += kShiftStepNm) {
    const double at_nm = std::min(nm, *high);
    const double image = lens::first_order(lens::SystemAt(system, at_nm)).image_distance_mm;
    series.points.emplace_back(at_nm, kPerMm * (image - reference));
  }
  return svg(
      LinePlot{"Chromatic focal shift", "wavelength [nm]", "shift of the paraxial focus [um]", {series}});
}

}  // namespace abbe
