#include "scene/shapes/quadric.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "materials/bsdf/warp.h"

namespace abbe {
namespace {

using Imath::V3d;

constexpr double kPi = std::numbers::pi;

// a b - c d with one rounding error of the result [Kahan].
template <typename T>
T difference_of_products(T a, T b, T c, T d) {
  const T cd = c * d;
  return std::fma(a, b, -cd) - std::fma(c, d, -cd);
}

// A quadric and a ray in the coordinates of T. `along` is the component along the axis, `across` the vector
// perpendicular to it.
template <typename T>
struct QuadricRay {
  using V = Imath::Vec3<T>;

  V axis;
  T shift;  // t at the point of the ray that is nearest to the shape's center
  V from_across, towards_across;
  T from_along, towards_along;
  T constant, linear, quadratic, low, high;
  bool caps;

  QuadricRay(const Quadric& quadric, const BasicRay<T>& ray)
      : axis(quadric.axis),
        constant(static_cast<T>(quadric.constant)),
        linear(static_cast<T>(quadric.linear)),
        quadratic(static_cast<T>(quadric.quadratic)),
        low(static_cast<T>(quadric.low)),
        high(static_cast<T>(quadric.high)),
        caps(quadric.caps) {
    const V from = ray.origin - V(quadric.origin);
    const V halfway = axis * ((low + high) / 2);
    shift = (halfway - from).dot(ray.direction) / ray.direction.length2();
    const V near = from + ray.direction * shift;
    from_along = near.dot(axis);
    from_across = near - axis * from_along;
    towards_along = ray.direction.dot(axis);
    towards_across = ray.direction - axis * towards_along;
  }

  [[nodiscard]] T radius2(T z) const { return constant + z * (linear + z * quadratic); }
  [[nodiscard]] T along(T t) const { return from_along + towards_along * t; }
  [[nodiscard]] V across(T t) const { return from_across + towards_across * t; }

  // Values of t, relative to `shift`, at which the ray crosses the infinite quadric; NaN or infinite if it
  // does not.
  [[nodiscard]] std::array<T, 2> roots() const {
    const T a = towards_across.length2() - quadratic * towards_along * towards_along;
    const T b = -from_across.dot(towards_across) + towards_along * (linear / 2 + quadratic * from_along);
    const T c = from_across.length2() - radius2(from_along);
    const T q = b + std::copysign(std::sqrt(difference_of_products(b, b, a, c)), b);
    return {c / q, q / a};
  }
  // The value of t, relative to `shift`, at which the ray crosses the plane at height z.
  [[nodiscard]] T crossing(T z) const { return (z - from_along) / towards_along; }
};

// Rims of the side and of a cap overlap by the width of rounding, so that no ray passes between them.
template <typename T>
constexpr T kRim = 8 * std::numeric_limits<T>::epsilon();

V3d radial_direction(const Quadric& quadric, double azimuth) {
  const Basis<double> frame(quadric.axis);
  return frame.x * std::cos(azimuth) + frame.y * std::sin(azimuth);
}

// Normal of the side, by the gradient, at that height and unit vector away from the axis.
template <typename T>
Imath::Vec3<T> side_normal(const Imath::Vec3<T>& radial, const Imath::Vec3<T>& axis, T radius, T slope) {
  const Imath::Vec3<T> normal = (radial * radius - axis * slope).normalized();
  return normal.length2() > 0 ? normal : axis;  // the apex of a cone
}

// Half the derivative of the squared radius.
double half_slope(const Quadric& quadric, double z) {
  return quadric.linear / 2 + quadric.quadratic * z;
}

double area_of_side(const Quadric& quadric) {
  const double radius = std::max(quadric.radius(quadric.low), quadric.radius(quadric.high));
  const double height = quadric.high - quadric.low;
  if (quadric.linear > 0) {  // with u = (radius / 2f)^2: 8 pi f^2 / 3 ((1 + u)^(3/2) - 1)
    const double f = quadric.linear / 4;
    return 8 * kPi / 3 * f * f * std::expm1(1.5 * std::log1p(height / f));
  }
  return quadric.quadratic > 0 ? kPi * radius * std::hypot(radius, height) : 2 * kPi * radius * height;
}

double area_of_cap(const Quadric& quadric, double z) {
  const double radius = quadric.radius(z);
  return quadric.caps ? kPi * radius * radius : 0;
}

// The height below which a fraction of the side's area lies; for a cone, above.
double height_of(const Quadric& quadric, double fraction) {
  if (quadric.linear > 0) {
    const double f = quadric.linear / 4;
    return f * std::expm1(std::log1p(fraction * std::expm1(1.5 * std::log1p(quadric.high / f))) / 1.5);
  }
  if (quadric.quadratic > 0) return quadric.low * std::sqrt(fraction);
  return quadric.low + fraction * (quadric.high - quadric.low);
}

// Largest coordinate of the side along a unit direction, relative to its origin.
double max_extent(const Quadric& quadric, const V3d& direction) {
  const double n = direction.dot(quadric.axis);
  const double s = std::sqrt(std::max(0.0, (1 - n) * (1 + n)));
  const auto at = [&](double z) { return n * z + s * quadric.radius(z); };
  double reached = std::max(at(quadric.low), at(quadric.high));
  if (quadric.linear > 0 && n < 0) {  // where the paraboloid is perpendicular to the direction
    const double radius = s * quadric.linear / (-2 * n);
    const double z = radius * radius / quadric.linear;
    if (z < quadric.high) reached = std::max(reached, at(z));
  }
  return reached;
}

Quadric between(const V3d& origin, const V3d& axis, double low, double high) {
  Quadric quadric;
  quadric.origin = origin;
  quadric.axis = axis.normalized();
  quadric.low = low;
  quadric.high = high;
  return quadric;
}

}  // namespace

Quadric cylinder(const V3d& from, const V3d& to, double radius, bool caps) {
  Quadric quadric = between(from, to - from, 0, (to - from).length());
  quadric.constant = radius * radius;
  quadric.caps = caps;
  return quadric;
}

Quadric cone(const V3d& base, const V3d& apex, double radius, bool caps) {
  const double height = (apex - base).length();
  Quadric quadric = between(apex, apex - base, -height, 0);
  quadric.quadratic = radius / height * (radius / height);
  quadric.caps = caps;
  return quadric;
}

Quadric paraboloid(const V3d& vertex, const V3d& axis, double focal_length, double radius) {
  Quadric quadric = between(vertex, axis, 0, radius * radius / (4 * focal_length));
  quadric.linear = 4 * focal_length;
  return quadric;
}

template <typename T>
std::optional<ShapeHit<T>> intersect(const Quadric& quadric, const BasicRay<T>& ray, T t_min) {
  using V = Imath::Vec3<T>;
  const QuadricRay<T> local(quadric, ray);
  const T shift = local.shift;
  const T slack = kRim<T> * (local.high - local.low);
  std::optional<T> nearest;  // relative to the shift
  T nearest_cap = 0;
  bool on_cap = false;
  const auto is_nearest = [&](T t) {
    return shift + t > t_min && shift + t < ray.t_max && (!nearest || t < *nearest);
  };
  for (const T t : local.roots()) {
    const T z = local.along(t);
    if (is_nearest(t) && z >= local.low - slack && z <= local.high + slack) nearest = t;
  }
  for (const T z : {local.low, local.high}) {
    if (!local.caps || !(local.radius2(z) > 0)) continue;
    const T t = local.crossing(z);
    if (!is_nearest(t) || local.across(t).length2() > local.radius2(z) * (1 + kRim<T>)) continue;
    nearest = t;
    nearest_cap = z;
    on_cap = true;
  }
  if (!nearest) return std::nullopt;
  const V across = local.across(*nearest);
  const V origin(quadric.origin);
  const T t = local.shift + *nearest;
  if (on_cap)
    return ShapeHit<T>{t, origin + local.axis * nearest_cap + across,
                       nearest_cap == local.low ? -local.axis : local.axis};
  const T z = std::clamp(local.along(*nearest), local.low, local.high);
  const V radial = across.normalized();
  const T radius = std::sqrt(local.radius2(z));
  return ShapeHit<T>{t, origin + local.axis * z + radial * radius,
                     side_normal(radial, local.axis, radius, local.linear / 2 + local.quadratic * z)};
}
template std::optional<ShapeHit<float>> intersect(const Quadric&, const BasicRay<float>&, float);
template std::optional<ShapeHit<double>> intersect(const Quadric&, const BasicRay<double>&, double);

double area(const Quadric& quadric) {
  return area_of_side(quadric) + area_of_cap(quadric, quadric.low) + area_of_cap(quadric, quadric.high);
}

Imath::Box3d bounds(const Quadric& quadric) {
  Imath::Box3d box;
  for (int i = 0; i < 3; ++i) {
    V3d direction(0);
    direction[i] = 1;
    box.max[i] = quadric.origin[i] + max_extent(quadric, direction);
    box.min[i] = quadric.origin[i] - max_extent(quadric, -direction);
  }
  return box;
}

SurfacePoint sample_area(const Quadric& quadric, Imath::V2f u) {
  double left = static_cast<double>(u.x) * area(quadric);
  for (const double z : {quadric.low, quadric.high}) {
    const double cap = area_of_cap(quadric, z);
    if (left < cap) {
      const Imath::V2d p(concentric_disc(Imath::V2f(static_cast<float>(left / cap), u.y)));
      const V3d across = Basis<double>(quadric.axis).to_world({p.x, p.y, 0}) * quadric.radius(z);
      return {Imath::V3f(quadric.origin + quadric.axis * z + across),
              Imath::V3f(z == quadric.low ? -quadric.axis : quadric.axis)};
    }
    left -= cap;
  }
  const double z = height_of(quadric, std::clamp(left / area_of_side(quadric), 0.0, 1.0));
  const V3d radial = radial_direction(quadric, 2 * kPi * static_cast<double>(u.y));
  const double radius = quadric.radius(z);
  return {Imath::V3f(quadric.origin + quadric.axis * z + radial * radius),
          Imath::V3f(side_normal(radial, quadric.axis, radius, half_slope(quadric, z)))};
}

SurfaceCoordinates coordinates_on(const Quadric& quadric, const V3d& point, std::size_t /*triangle*/) {
  const Basis<double> frame(quadric.axis);
  const V3d local = frame.to_local(point - quadric.origin);
  const double distance = std::hypot(local.x, local.y);
  const double azimuth = std::atan2(local.y, local.x);
  const double u = azimuth / (2 * kPi) + (azimuth < 0 ? 1 : 0);
  const V3d dp_du = (frame.y * local.x - frame.x * local.y) * (2 * kPi);
  const V3d radial = distance > 0 ? (frame.x * local.x + frame.y * local.y) / distance : V3d(0);
  const double height = quadric.high - quadric.low;
  const double z = std::clamp(local.z, quadric.low, quadric.high);
  const double radius = quadric.radius(z);
  for (const double end : {quadric.low, quadric.high})
    if (area_of_cap(quadric, end) > 0 && std::abs(local.z - end) < std::abs(distance - radius))
      return {{u, distance / quadric.radius(end)}, dp_du, radial * quadric.radius(end)};
  if (!(distance > 0 && radius > 0)) return {{u, (z - quadric.low) / height}, dp_du, V3d(0)};
  return {{u, (z - quadric.low) / height},
          dp_du,
          (quadric.axis + radial * (half_slope(quadric, z) / radius)) * height};
}

double enclosed_volume(const Quadric& quadric) {
  if (!quadric.caps) return 0;
  const double base = std::max(area_of_cap(quadric, quadric.low), area_of_cap(quadric, quadric.high));
  return base * (quadric.high - quadric.low) / (quadric.quadratic > 0 ? 3 : 1);
}

// Opposite parts of cones and paraboloids are far from parallel unless they are very slender or flat.
double thickness(const Quadric& quadric) {
  const double height = quadric.high - quadric.low;
  const double radius = std::max(quadric.radius(quadric.low), quadric.radius(quadric.high));
  if (quadric.constant > 0) return quadric.caps ? std::min(2 * radius, height) : 2 * radius;
  constexpr double kSlender = 0.05;
  constexpr double kFlat = 10;
  const double slope =
      std::abs(half_slope(quadric, quadric.quadratic > 0 ? quadric.low : quadric.high)) / radius;
  return slope > kSlender && slope < kFlat ? radius : 0;
}

Outline outline(const Quadric& quadric, const Imath::M44d& to_world, const DrawingPlane& plane) {
  Outline lines;
  for (const double z : {quadric.low, quadric.high}) {
    const double radius = quadric.radius(z);
    if (!(radius > 0)) continue;
    std::vector<V3d>& rim = lines.emplace_back();
    for (int i = 0; i <= kOutlineCorners; ++i)
      rim.push_back(
          (quadric.origin + quadric.axis * z + radial_direction(quadric, outline_angle(i)) * radius) *
          to_world);
  }
  const V3d view = moved_direction(plane.right.cross(plane.up), to_world.inverse());
  const V3d side = quadric.axis.cross(view);
  if (side.length() < 1e-6 * view.length()) return lines;
  constexpr int kSteps = 16;
  for (const V3d& radial : {side.normalized(), -side.normalized()}) {
    std::vector<V3d>& meridian = lines.emplace_back();
    for (int i = 0; i <= kSteps; ++i) {
      const double z = quadric.low + (quadric.high - quadric.low) * i / kSteps;
      meridian.push_back((quadric.origin + quadric.axis * z + radial * quadric.radius(z)) * to_world);
    }
  }
  return lines;
}

void shift(Quadric& quadric, const V3d& by) {
  quadric.origin += by;
}

void transform(Quadric& quadric, const Imath::M44d& by, double scale) {
  quadric.origin *= by;
  quadric.axis = moved_direction(quadric.axis, by).normalized();
  quadric.constant *= scale * scale;
  quadric.linear *= scale;
  quadric.low *= scale;
  quadric.high *= scale;
}

}  // namespace abbe
