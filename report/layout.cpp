#include "report/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "report/display_color.h"
#include "report/light_rays.h"
#include "report/svg.h"
#include "scene/shapes/shape.h"
#include "scene/working_range.h"
#include "spectral/colorimetry.h"

namespace abbe {
namespace {

using V3d = Imath::V3d;

constexpr double kViewWidth = 860;
constexpr double kMaxViewHeight = 520;
constexpr double kLayoutMargin = 30;
constexpr double kLayoutTop = 50;
constexpr double kViewGap = 60;
constexpr std::size_t kMaxNames = 60;

struct View {
  const char* name;
  DrawingPlane plane;
};
const std::array<View, 2> kViews{
    {{"Plan (x, y)", {{1, 0, 0}, {0, 1, 0}}}, {"Elevation (x, z)", {{1, 0, 0}, {0, 0, 1}}}}};

// Box of the shapes that are not distant, the lights with a position and the camera, with padding. A camera
// alone is padded by the radius of an empty scene.
Imath::Box3d drawn_box(const Scene& scene) {
  Imath::Box3d box = scene.bounds;
  box.extendBy(position(scene.camera));
  for (const Light& light : scene.lights)
    if (!light.at_infinity() && !is_omitted(scene, light))
      if (const auto ray = central_ray(scene, light)) box.extendBy(ray->origin);
  const double size = box.size().length();
  const V3d padding(size > 0 ? 0.05 * size : scene_radius({}));
  return {box.min - padding, box.max + padding};
}

struct Projection {
  DrawingPlane plane;
  Imath::Box3d box;
  double scale;  // pixels per metre
  double top;

  [[nodiscard]] double x(const V3d& p) const {
    return kLayoutMargin + scale * (p - box.min).dot(plane.right);
  }
  [[nodiscard]] double y(const V3d& p) const { return top + scale * (box.max - p).dot(plane.up); }
  [[nodiscard]] double height() const { return scale * box.size().dot(plane.up); }
  [[nodiscard]] SvgPoints points(const std::vector<V3d>& line) const {
    SvgPoints points;
    for (const V3d& p : line) points.emplace_back(x(p), y(p));
    return points;
  }
};

// Part of a line inside the box; empty if there is none.
std::vector<V3d> clipped(const V3d& from, const V3d& to, const Imath::Box3d& box) {
  double first = 0;
  double last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double delta = to[axis] - from[axis];
    if (delta == 0) {
      if (from[axis] < box.min[axis] || from[axis] > box.max[axis]) return {};
      continue;
    }
    const double a = (box.min[axis] - from[axis]) / delta;
    const double b = (box.max[axis] - from[axis]) / delta;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (first >= last) return {};
  return {from + first * (to - from), from + last * (to - from)};
}

// Opacity is linear in the logarithm of the power.
double opacity(double power_fraction) {
  return std::clamp(1 - 0.85 * std::log(power_fraction) / std::log(kMinDrawnFraction), 0.15, 1.0);
}

std::string ray_elements(const DrawnRay& ray, const Projection& to) {
  std::string elements;
  const std::string style = fmt::format(
      "class=\"ray\" data-nm=\"{:g}\" stroke=\"{}\" stroke-width=\"0.8\" stroke-opacity=\"{:.2g}\"",
      ray.wavelength_nm, wavelength_color(ray.wavelength_nm), 0.8 * opacity(ray.power_fraction));
  for (std::size_t i = 0; i + 1 < ray.points.size(); ++i)
    if (const auto line = clipped(ray.points[i], ray.points[i + 1], to.box); !line.empty())
      elements += svg_line(to.x(line[0]), to.y(line[0]), to.x(line[1]), to.y(line[1]), style);
  return elements;
}

std::string shape_elements(const Scene& scene, const Projection& to) {
  std::string elements;
  std::set<std::string> named;
  for (const ShapeInstance& shape : scene.shapes) {
    if (shape.distant) continue;
    const bool is_light = shape.light >= 0;
    for (const auto& line : outline(shape.shape, to.plane))
      elements +=
          svg_polyline(to.points(line), fmt::format("class=\"shape\" stroke=\"{}\" stroke-width=\"{}\"",
                                                    is_light ? "#b08000" : "#303030", is_light ? 2.5 : 1.2));
    if (shape.name.empty() || named.size() == kMaxNames || !named.insert(shape.name).second) continue;
    const V3d center = bounds(shape.shape).center();
    elements += svg_text(to.x(center), to.y(center), shape.name,
                         "text-anchor=\"middle\" fill=\"#303030\" fill-opacity=\"0.8\" font-size=\"10\"");
  }
  return elements;
}

std::string light_elements(const Scene& scene, const Projection& to) {
  std::string elements;
  for (const Light& light : scene.lights) {
    if (surface_of(light) || light.at_infinity() || is_omitted(scene, light)) continue;
    const V3d at = central_ray(scene, light)->origin;
    elements += svg_circle(to.x(at), to.y(at), 4, "class=\"lamp\" fill=\"#ffd040\" stroke=\"#b08000\"");
    elements += svg_text(to.x(at) + 7, to.y(at) - 5, light.name, "fill=\"#b08000\" font-size=\"10\"");
  }
  return elements;
}

// The camera, and rays through the centres of the film's edges.
std::string camera_elements(const Scene& scene, const Projection& to) {
  const Camera& camera = scene.camera;
  const V3d at = position(camera);
  std::string elements = svg_circle(to.x(at), to.y(at), 4, "class=\"camera\" fill=\"#3060c0\"");
  elements += svg_text(to.x(at) + 7, to.y(at) + 12, "camera", "fill=\"#3060c0\" font-size=\"10\"");
  if (is_probe(camera)) return elements;
  const auto width = static_cast<float>(camera.width);
  const auto height = static_cast<float>(camera.height);
  const double length = to.box.size().length();
  for (const Imath::V2f& film : {Imath::V2f(0, height / 2), Imath::V2f(width, height / 2),
                                 Imath::V2f(width / 2, 0), Imath::V2f(width / 2, height)}) {
    const CameraRay ray = sample_ray(camera, film, {0.5F, 0.5F}, SampledSpectrum(550.0F), 0, 0);
    const auto line = clipped(at, at + length * V3d(ray.ray.direction).normalized(), to.box);
    if (!line.empty())
      elements +=
          svg_line(to.x(line[0]), to.y(line[0]), to.x(line[1]), to.y(line[1]),
                   "class=\"field\" stroke=\"#3060c0\" stroke-width=\"0.7\" stroke-dasharray=\"5 4\"");
  }
  return elements;
}

std::string unit_name(double unit_m) {
  static const std::map<double, std::string> kNames{
      {1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "um"}, {0.0254, "in"}};
  const auto entry = kNames.find(unit_m);
  return entry == kNames.end() ? "units" : entry->second;
}

std::string legend(const std::vector<DrawnRay>& rays, double y) {
  std::set<double> wavelengths;
  for (const DrawnRay& ray : rays) wavelengths.insert(ray.wavelength_nm);
  std::string elements;
  double x = kLayoutMargin + kViewWidth / 2;
  for (const double nm : wavelengths) {
    elements +=
        svg_line(x, y, x + 18, y, fmt::format("stroke=\"{}\" stroke-width=\"2\"", wavelength_color(nm)));
    elements += svg_text(x + 22, y + 4, fmt::format("{:g} nm", nm), "");
    x += 85;
  }
  return elements;
}

}  // namespace

std::vector<DrawnRay> drawn_rays(const Scene& scene, const RayTree& tree, double wavelength_nm) {
  std::vector<DrawnRay> rays;
  for (const RayBranch& branch : tree.branches) {
    DrawnRay drawn{wavelength_nm, {branch.start.origin}, branch.power_fraction};
    const RayTrace& trace = branch.trace;
    for (const TraceEvent& event : trace.events)
      if (event.kind != TraceEvent::Kind::escape) drawn.points.push_back(event.at.point);
    if (!trace.events.empty() && trace.events.back().kind == TraceEvent::Kind::escape)
      drawn.points.push_back(trace.last.origin + drawn_box(scene).size().length() * trace.last.direction);
    rays.push_back(std::move(drawn));
  }
  return rays;
}

std::string wavelength_color(double wavelength_nm) {
  const ColorMatching& observer = color_matching(Observer::cie1931);
  LinearRgb rgb =
      linear_rgb_of_xyz({observer.x(wavelength_nm), observer.y(wavelength_nm), observer.z(wavelength_nm)});
  const double max_component = *std::max_element(rgb.begin(), rgb.end());
  if (!(max_component > 1e-3)) return "#909090";
  for (double& v : rgb) v /= max_component;
  return css_color(display_code(rgb));
}

std::string layout_drawing(const Scene& scene, const std::vector<DrawnRay>& rays, const std::string& title) {
  const Imath::Box3d box = drawn_box(scene);
  const V3d size = box.size();
  const double scale = std::min(kViewWidth / size.x, kMaxViewHeight / std::max(size.y, size.z));
  std::string elements;
  double top = kLayoutTop;
  for (const View& view : kViews) {
    const Projection to{view.plane, box, scale, top + 18};
    elements += svg_text(kLayoutMargin, top + 8, view.name, "font-weight=\"bold\"");
    elements += camera_elements(scene, to);
    for (const DrawnRay& ray : rays) elements += ray_elements(ray, to);
    elements += shape_elements(scene, to) + light_elements(scene, to);
    top += to.height() + kViewGap;
  }
  elements +=
      svg_scale_bar(kLayoutMargin, top, scale * scene.unit_m, kViewWidth / 5, unit_name(scene.unit_m)) +
      legend(rays, top);
  return svg_document(kViewWidth + 2 * kLayoutMargin, top + 30, title, elements);
}

}  // namespace abbe
