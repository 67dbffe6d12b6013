#include "report/lens_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lens/spot.h"
#include "report/layout.h"
#include "report/plot.h"
#include "report/svg.h"

namespace abbe {
namespace {

using Imath::V3d;
using lens::Beam;
using lens::RayPath;
using lens::Spot;
using lens::SystemAt;

constexpr int kCells = 100;   // per edge of the square grid of rays over a beam
constexpr int kFanRays = 41;  // evenly spaced from one edge of the stop to the other

lens::SeidelSums seidel_of(const lens::System& system, const LensFigures& figures) {
  const auto [blue, red] = std::ranges::minmax(system.wavelengths_nm);
  const double outermost = std::ranges::max(system.fields, {}, [](double field) { return std::abs(field); });
  const auto& speed = figures.speed[system.primary];
  const double radius = speed ? speed->launch_diameter_mm / 2 : std::numeric_limits<double>::quiet_NaN();
  return lens::seidel_sums(SystemAt(system, system.primary_nm()), SystemAt(system, blue),
                           SystemAt(system, red), radius, outermost);
}

std::vector<lens::RayFan> fans_of(const lens::System& system, double field, double stop_radius_mm) {
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
    fans.push_back(beam ? lens::ray_fan(*beam, {chief.last.origin.x, chief.last.origin.y}, kFanRays)
                        : lens::RayFan{});
  }
  return fans;
}

LensFieldFigures at_field(const lens::System& system, double field, std::vector<Spot> spots,
                          double stop_radius_mm, const std::vector<double>& frequencies_per_mm) {
  LensFieldFigures figures{field, std::move(spots), {}, {}, {}, {}, {}};
  for (const double nm : system.wavelengths_nm)
    figures.chiefs.push_back(lens::chief_ray(SystemAt(system, nm), field, stop_radius_mm));
  figures.fans = fans_of(system, field, stop_radius_mm);
  for (const double per_mm : frequencies_per_mm) {
    figures.tangential_mtf.push_back(lens::geometric_mtf(figures.spots, per_mm, {0, 1}));
    figures.sagittal_mtf.push_back(lens::geometric_mtf(figures.spots, per_mm, {1, 0}));
  }
  return figures;
}

void add_illumination(LensFigures& figures) {
  const SystemAt primary(figures.system, figures.system.primary_nm());
  const auto axis = Beam::of(primary, 0, figures.stop_radius_mm);
  if (!axis) return;
  const Spot on_axis = lens::spot(*axis, 0, kCells);
  for (LensFieldFigures& field : figures.fields)
    field.relative_illumination = lens::relative_illumination(primary, field.field, figures.stop_radius_mm,
                                                              field.spots[figures.system.primary], on_axis);
}

std::vector<GhostFigures> ghosts_of(const lens::System& system, double stop_radius_mm) {
  const auto [blue, red] = std::ranges::minmax(system.wavelengths_nm);
  const SystemAt at(system, system.primary_nm());
  std::vector<GhostFigures> all;
  for (const lens::Ghost& ghost : lens::ghosts(system, blue, red)) {
    const lens::GhostFocus focus = lens::ghost_focus(at, ghost, stop_radius_mm);
    all.push_back({ghost, focus.image_distance_mm - system.surfaces.back().thickness_mm, focus.diameter_mm});
  }
  std::ranges::sort(all, std::ranges::greater(), [](const GhostFigures& of) {
    return of.ghost.reflectance / (of.diameter_mm * of.diameter_mm);
  });
  return all;
}

constexpr double kDrawingWidth = 900;
constexpr double kMaxHeight = 520;
constexpr double kDrawingMargin = 30;
constexpr double kDrawingTop = 50;
constexpr int kArcPoints = 48;
constexpr double kShrinkFactor = 0.99;
constexpr double kRimFactor = 1.05;     // height of a surface relative to the highest ray on it
constexpr double kLeadFraction = 0.25;  // of the lens's length, for rays in front of it

const char* field_color(std::size_t field) {
  constexpr std::array<const char*, 6> kColors{"#2060c0", "#208040", "#c03030",
                                               "#a06000", "#8030a0", "#008080"};
  return kColors[field % kColors.size()];
}

struct LensRay {
  std::size_t field;
  std::vector<V3d> points;
};

// Points of a ray from in front of the lens to its end.
std::vector<V3d> points_of(const lens::Ray& ray, const RayPath& path, double lead_mm) {
  std::vector<V3d> points;
  if (path.hits.empty()) return points;
  const double before = (path.hits.front().point - ray.origin).dot(ray.direction);
  points.push_back(ray.origin + (before - lead_mm) * ray.direction);
  for (const lens::RayHit& hit : path.hits) points.push_back(hit.point);
  if (path.reached()) points.push_back(path.last.origin);
  return points;
}

std::vector<LensRay> rays_of(const LensFigures& figures, const SystemAt& at, double lead_mm) {
  std::vector<LensRay> rays;
  for (std::size_t f = 0; f < figures.fields.size(); ++f) {
    const auto beam = lens::Beam::of(at, figures.fields[f].field, figures.stop_radius_mm);
    if (!beam) continue;
    for (const double pupil : {-1.0, -0.5, 0.0, 0.5, 1.0})
      if (const auto launched = beam->aim({0, pupil})) {
        const lens::Ray ray = beam->launch(*launched);
        rays.push_back({f, points_of(ray, lens::trace(at, ray, lens::Apertures::obeyed), lead_mm)});
      }
  }
  return rays;
}

// Reduces the drawn heights of two surfaces until they do not cross at their rims.
void avoid_rim_crossing(const lens::Surface& first, const lens::Surface& second, double& first_height,
                        double& second_height) {
  const auto gap = [&] {
    const double r2 = std::pow(std::min(first_height, second_height), 2);
    return first.thickness_mm + second.profile.sag(r2) - first.profile.sag(r2);
  };
  while (first.thickness_mm >= 0 && gap() < 0)
    (first_height > second_height ? first_height : second_height) *= kShrinkFactor;
}

// Drawn height of each surface above its axis.
std::vector<double> heights_of(const LensFigures& figures, const SystemAt& at,
                               const std::vector<LensRay>& rays) {
  std::vector<double> heights(at.size(), figures.stop_radius_mm * 0.2);
  heights[figures.system.stop] = figures.stop_radius_mm;
  for (const LensRay& ray : rays)
    for (std::size_t i = 0; i + 1 < ray.points.size() && i < at.size(); ++i)
      heights[i] = std::max(heights[i], kRimFactor * std::abs(lens::local_point(at, i, ray.points[i + 1]).y));
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = at.surface(i).semi_aperture_mm.value_or(heights[i]);
    while (!std::isfinite(at.surface(i).profile.sag(heights[i] * heights[i]))) heights[i] *= kShrinkFactor;
    if (i > 0) avoid_rim_crossing(at.surface(i - 1), at.surface(i), heights[i - 1], heights[i]);
  }
  return heights;
}

std::vector<V3d> arc(const SystemAt& at, std::size_t i, double height) {
  std::vector<V3d> points;
  for (int k = -kArcPoints; k <= kArcPoints; ++k) {
    const double y = height * k / kArcPoints;
    const V3d local(0, y, at.surface(i).profile.sag(y * y));
    points.push_back(local * at.frames[i].to_world + at.frames[i].vertex);
  }
  return points;
}

class SectionView {
 public:
  SectionView(const std::vector<std::vector<V3d>>& arcs, const std::vector<LensRay>& rays, double image_z) {
    for (const auto& points : arcs)
      for (const V3d& p : points) box_.extendBy(Imath::V2d(p.z, p.y));
    for (const LensRay& ray : rays)
      for (const V3d& p : ray.points) box_.extendBy(Imath::V2d(p.z, p.y));
    box_.extendBy(Imath::V2d(image_z, 0));
    scale_ = std::min((kDrawingWidth - 2 * kDrawingMargin) / box_.size().x,
                      kMaxHeight / std::max(box_.size().y, 1e-9));
  }
  [[nodiscard]] std::pair<double, double> at(const V3d& p) const {
    return {kDrawingMargin + scale_ * (p.z - box_.min.x), kDrawingTop + scale_ * (box_.max.y - p.y)};
  }
  [[nodiscard]] SvgPoints at(const std::vector<V3d>& points) const {
    SvgPoints all;
    for (const V3d& p : points) all.push_back(at(p));
    return all;
  }
  [[nodiscard]] double bottom() const { return kDrawingTop + scale_ * box_.size().y; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double top_mm() const { return box_.max.y; }

 private:
  Imath::Box2d box_;
  double scale_;
};

std::string glass_elements(const SystemAt& at, const std::vector<std::vector<V3d>>& arcs,
                           const SectionView& to) {
  std::string all;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (!at.surface(i).behind) continue;
    std::vector<V3d> edge = arcs[i];
    edge.insert(edge.end(), arcs[i + 1].rbegin(), arcs[i + 1].rend());
    all += svg_polygon(to.at(edge), "class=\"glass\" style=\"fill:#cfe2f3\" stroke=\"#303030\"");
  }
  return all;
}

// Edges of the stop, and the part of the image plane that rays reach.
std::string plane_elements(const LensFigures& figures, const SystemAt& at, const std::vector<LensRay>& rays,
                           const SectionView& to) {
  const std::string black = "stroke=\"black\" stroke-width=\"2\"";
  const V3d stop = at.frames[figures.system.stop].vertex;
  std::string all;
  for (const double side : {-1.0, 1.0}) {
    const double edge = stop.y + side * figures.stop_radius_mm;
    const double z =
        stop.z + at.surface(figures.system.stop).profile.sag(std::pow(figures.stop_radius_mm, 2));
    const auto [x0, y0] = to.at(V3d(0, edge, z));
    const auto [x1, y1] = to.at(V3d(0, edge + side * 0.3 * figures.stop_radius_mm, z));
    all += svg_line(x0, y0, x1, y1, "class=\"stop\" " + black);
  }
  double low = -0.1 * figures.stop_radius_mm;
  double high = -low;
  for (const LensRay& ray : rays)
    if (ray.points.size() == at.size() + 2) {
      low = std::min(low, ray.points.back().y);
      high = std::max(high, ray.points.back().y);
    }
  const auto [x0, y0] = to.at(V3d(0, low, at.vertex_z.back()));
  const auto [x1, y1] = to.at(V3d(0, high, at.vertex_z.back()));
  return all + svg_line(x0, y0, x1, y1, "class=\"image\" " + black);
}

constexpr double kPerMm = 1000;  // micrometres
constexpr double kSpotSide = 200;
constexpr double kSpotTop = 40;
constexpr std::size_t kMaxDots = 700;  // of a spot
constexpr int kMtfPoints = 60;
constexpr int kShiftStepNm = 5;

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

LensFigures lens_figures(const lens::System& system, std::vector<double> frequencies_per_mm) {
  LensFigures figures{.system = system,
                      .stop_radius_mm = lens::stop_radius(system),
                      .first_order = {},
                      .speed = {},
                      .seidel = {},
                      .best_focus_mm = {},
                      .frequencies_per_mm = std::move(frequencies_per_mm),
                      .fields = {},
                      .ghosts = {}};
  for (const double nm : system.wavelengths_nm) {
    const SystemAt at(system, nm);
    figures.first_order.push_back(lens::first_order(at));
    figures.speed.push_back(lens::speed(at, figures.stop_radius_mm, kCells));
  }
  figures.seidel = seidel_of(system, figures);
  figures.ghosts = ghosts_of(system, figures.stop_radius_mm);
  auto spots = lens::all_spots(system, figures.stop_radius_mm, kCells);
  figures.best_focus_mm = lens::best_focus(spots);
  for (std::size_t i = 0; i < spots.size(); ++i)
    figures.fields.push_back(at_field(system, system.fields[i], std::move(spots[i]), figures.stop_radius_mm,
                                      figures.frequencies_per_mm));
  add_illumination(figures);
  return figures;
}

std::string lens_drawing(const LensFigures& figures) {
  const SystemAt at(figures.system, figures.system.primary_nm());
  const double lead = kLeadFraction * std::max(at.vertex_z.back(), 4 * figures.stop_radius_mm);
  const std::vector<LensRay> rays = rays_of(figures, at, lead);
  const std::vector<double> heights = heights_of(figures, at, rays);
  std::vector<std::vector<V3d>> arcs;
  for (std::size_t i = 0; i < at.size(); ++i) arcs.push_back(arc(at, i, heights[i]));
  const SectionView to(arcs, rays, at.vertex_z.back());
  std::string elements = glass_elements(at, arcs, to);
  const auto [x0, axis_y] = to.at(V3d(0, 0, 0));
  elements += svg_line(kDrawingMargin, axis_y, kDrawingWidth - kDrawingMargin, axis_y,
                       "stroke=\"#888888\" stroke-dasharray=\"8 3 2 3\"");
  for (const LensRay& ray : rays)
    elements +=
        svg_polyline(to.at(ray.points),
                     fmt::format("class=\"ray\" stroke=\"{}\" stroke-width=\"0.8\"", field_color(ray.field)));
  elements += plane_elements(figures, at, rays, to);
  elements += svg_scale_bar(kDrawingMargin, to.bottom() + 25, to.scale(), kDrawingWidth / 5, "mm");
  double x = kDrawingWidth / 2;
  for (std::size_t f = 0; f < figures.fields.size(); ++f, x += 75)
    elements += svg_text(x, to.bottom() + 29, figures.field_name(figures.fields[f].field),
                         fmt::format("fill=\"{}\"", field_color(f)));
  return svg_document(kDrawingWidth, to.bottom() + 45, figures.system.title, elements);
}

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
    PlotSeries tangential{fmt::format("{:.4g} nm", nm), {}, wavelength_color(nm)};
    PlotSeries sagittal{"", {}, wavelength_color(nm), true};
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
  const double highest = std::ranges::max(figures.frequencies_per_mm);
  for (std::size_t f = 0; f < figures.fields.size(); ++f) {
    const LensFieldFigures& field = figures.fields[f];
    const std::string color = field_color(f);
    PlotSeries tangential{figures.field_name(field.field), {}, color};
    PlotSeries sagittal{"", {}, color, true};
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
  const auto [low, high] = std::ranges::minmax(system.wavelengths_nm);
  PlotSeries series{"", {}, "#2060c0", false, false};
  for (double nm = low; nm < high + kShiftStepNm; nm += kShiftStepNm) {
    const double at_nm = std::min(nm, high);
    const double image = lens::first_order(lens::SystemAt(system, at_nm)).image_distance_mm;
    series.points.emplace_back(at_nm, kPerMm * (image - reference));
  }
  return svg(
      LinePlot{"Chromatic focal shift", "wavelength [nm]", "shift of the paraxial focus [um]", {series}});
}

}  // namespace abbe
