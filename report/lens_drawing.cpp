#include "report/lens_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "report/svg.h"

namespace abbe {
namespace {

using Imath::V3d;
using lens::RayPath;
using lens::SystemAt;

constexpr double kDrawingWidth = 900;
constexpr double kMaxHeight = 520;
constexpr double kDrawingMargin = 30;
constexpr double kDrawingTop = 50;
constexpr int kArcPoints = 48;
constexpr double kShrinkFactor = 0.99;
constexpr double kRimFactor = 1.05;     // height of a surface relative to the highest ray on it
constexpr double kLeadFraction = 0.25;  // of the lens's length, for rays in front of it
constexpr std::array<const char*, 6> kColors{"#2060c0", "#208040", "#c03030",
                                             "#a06000", "#8030a0", "#008080"};

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

// Scale bar of 1, 2 or 5 times a power of ten, at most a fifth of the width.
std::string scale_bar(const SectionView& to) {
  const double max_length = kDrawingWidth / 5 / to.scale();
  const double decade = std::pow(10.0, std::floor(std::log10(max_length)));
  double length = decade;
  for (const double round : {2.0, 5.0})
    if (round * decade <= max_length) length = round * decade;
  const double y = to.bottom() + 25;
  return svg_line(kDrawingMargin, y, kDrawingMargin + length * to.scale(), y,
                  "stroke=\"black\" stroke-width=\"2\"") +
         svg_text(kDrawingMargin + length * to.scale() + 8, y + 4, fmt::format("{:g} mm", length), "");
}

}  // namespace

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
    elements += svg_polyline(
        to.at(ray.points),
        fmt::format("class=\"ray\" stroke=\"{}\" stroke-width=\"0.8\"", kColors[ray.field % kColors.size()]));
  elements += plane_elements(figures, at, rays, to) + scale_bar(to);
  double x = kDrawingWidth / 2;
  for (std::size_t f = 0; f < figures.fields.size(); ++f, x += 75)
    elements += svg_text(x, to.bottom() + 29, figures.field_name(figures.fields[f].field),
                         fmt::format("fill=\"{}\"", kColors[f % kColors.size()]));
  return svg_document(kDrawingWidth, to.bottom() + 45, figures.system.title, elements);
}

}  // namespace abbe
