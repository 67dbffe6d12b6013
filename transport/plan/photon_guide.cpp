#include "transport/plan/photon_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "materials/bsdf/warp.h"
#include "sampling/discrete.h"
#include "scene/lights/light.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

constexpr std::size_t kCells = 128;  // per side of the grid
constexpr std::size_t kGrid = kCells * kCells;
constexpr float kEmissionFraction = 0.05F;
// Fraction of the guided photons outside the windows, and the uniform fraction after training from few rays.
constexpr float kOutsideFraction = 0.1F;
constexpr float kUniformFractionOfFew = 0.5F;
constexpr float kUniformFractionOfStrata = 0.5F;
constexpr std::size_t kMaxStrata = 64;
constexpr double kMinPhotonsOfWindow = 8;      // per branch
constexpr double kUniformOverBranches = 0.25;  // fraction of the guided photons
constexpr double kUniformCellFraction = 0.1;   // of the photons within a grid
constexpr float kInverseTurn = std::numbers::inv_pi_v<float> / 2;
constexpr float kAnyRadius = 1;  // of the scene; only lights at infinity use it

using AxisWeights = std::vector<std::pair<float, double>>;  // (coordinate, weight), sorted

// Weighted quantile of the coordinates, interpolated between the midpoints of the weights, so that it is
// continuous in all of them.
float quantile(const AxisWeights& weights, double fraction) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0,
                                       [](double sum, const auto& one) { return sum + one.second; });
  double before = 0;
  std::pair<double, float> last{0, weights.front().first};
  for (const auto& [at, weight] : weights) {
    const double midpoint = (before + weight / 2) / total;
    if (midpoint >= fraction) {
      const double step = midpoint > last.first ? (fraction - last.first) / (midpoint - last.first) : 1;
      return last.second + static_cast<float>(step) * (at - last.second);
    }
    last = {midpoint, at};
    before += weight;
  }
  return last.second;
}

// Interval between the first and last percentile of the weight, extended by an eighth at both ends: its start
// and its size in [0, 1]. Rounded to steps, so that rounding errors do not move the grid.
std::pair<float, float> interval_of(AxisWeights& weights) {
  constexpr double kTail = 0.01;
  constexpr float kMargin = 0.125F;
  constexpr float kSteps = 2048;
  std::sort(weights.begin(), weights.end());
  const float low = quantile(weights, kTail);
  const float high = quantile(weights, 1 - kTail);
  const float margin = kMargin * (high - low);
  const float from = std::max(std::floor((low - margin) * kSteps), 0.0F);
  const float to = std::min(std::floor((high + margin) * kSteps) + 1, kSteps);
  return {from / kSteps, (to - from) / kSteps};
}

// Distributes a weight over the four cells around a point of the unit square by bilinear interpolation, so
// that the cell values are continuous in the point.
void add_between(std::vector<double>& cells, const Imath::V2f& at, double weight) {
  const auto split = [](float x) {
    const float from_center = std::clamp(x * kCells - 0.5F, 0.0F, static_cast<float>(kCells - 1));
    const auto below = std::min(static_cast<std::size_t>(from_center), kCells - 2);
    return std::pair(below, static_cast<double>(from_center) - static_cast<double>(below));
  };
  const auto [column, right] = split(at.x);
  const auto [row, up] = split(at.y);
  double* cell = &cells[row * kCells + column];
  cell[0] += weight * (1 - right) * (1 - up);
  cell[1] += weight * right * (1 - up);
  cell[kCells] += weight * (1 - right) * up;
  cell[kCells + 1] += weight * right * up;
}

// Replaces each cell by the mean over `radius` cells on both sides along one axis, with mirrored edges.
// `step` is the index distance of neighbours along that axis, `other` along the other axis.
void average(std::vector<double>& cells, int radius, std::size_t step, std::size_t other) {
  constexpr int kEdge = static_cast<int>(kCells);
  const auto mirrored = [](int i) {
    return static_cast<std::size_t>(i < 0 ? -1 - i : i < kEdge ? i : 2 * kEdge - 1 - i);
  };
  std::array<double, kCells> line;
  for (std::size_t k = 0; k < kCells; ++k) {
    for (int i = 0; i < kEdge; ++i) {
      double sum = 0;
      for (int near = i - radius; near <= i + radius; ++near) sum += cells[k * other + mirrored(near) * step];
      line[static_cast<std::size_t>(i)] = sum / (2 * radius + 1);
    }
    for (std::size_t i = 0; i < kCells; ++i) cells[k * other + i * step] = line[i];
  }
}

// Smooths the cells twice with a box filter, which makes the density continuous in the positions of the rays.
// A small uniform fraction is added, because few or no rays pass where there is little light.
std::vector<double> smoothed(std::vector<double> cells, int radius) {
  const double even = std::accumulate(cells.begin(), cells.end(), 0.0) / kGrid;
  for (int time = 0; time < 2; ++time) {
    average(cells, (radius + 1) / 2, 1, kCells);
    average(cells, (radius + 1) / 2, kCells, 1);
  }
  for (double& cell : cells) cell = (1 - kUniformCellFraction) * cell + kUniformCellFraction * even;
  return cells;
}

// Cell of a point in the unit square.
std::size_t cell_of(const Imath::V2f& at) {
  const auto step = [](float x) {
    return std::min(static_cast<std::size_t>(std::max(x, 0.0F) * kCells), kCells - 1);
  };
  return step(at.y) * kCells + step(at.x);
}

constexpr double kRaysAround = 16;
constexpr int kMaxRadius = 16;

// Smoothing radius [cells] whose square contains about sixteen of the rays if they are uniform over the grid.
int smoothing_radius(std::size_t rays) {
  const double side = std::sqrt(kRaysAround * kGrid / static_cast<double>(rays));
  return static_cast<int>(std::clamp(std::ceil((side - 1) / 2), 1.0, double{kMaxRadius}));
}

// True if nine in ten rays have sixteen rays, themselves included, within `radius` cells. `cells` has the
// cell of each ray.
bool rays_are_dense(const std::vector<std::size_t>& cells, int radius) {
  std::vector<double> counts(kGrid, 0.0);
  for (const std::size_t cell : cells) counts[cell] += 1;
  const double square = (2 * radius + 1) * (2 * radius + 1);
  average(counts, radius, 1, kCells);
  average(counts, radius, kCells, 1);
  constexpr double kRounding = 1e-6;
  const auto lone = std::ranges::count_if(
      cells, [&](std::size_t cell) { return counts[cell] * square < kRaysAround - kRounding; });
  return 10 * lone <= std::ssize(cells);
}

// Rays concentrated on a few spots of the grid are dense with a smaller radius.
int smoothing_radius(const std::vector<std::size_t>& cells) {
  int radius = smoothing_radius(cells.size());
  while (radius > 1 && rays_are_dense(cells, radius - 1)) --radius;
  return radius;
}

}  // namespace

PhotonGuide::PhotonGuide(const Imath::V3f& light_center, float light_radius, const Imath::V3f& target_center,
                         float target_radius, const std::optional<Imath::V3f>& beam) {
  const Imath::V3f to_target = target_center - light_center;
  const float distance = to_target.length();
  if (!(target_radius > 0)) return;
  all_directions_ = !(distance > 1.2F * target_radius);
  if (all_directions_ && beam) {
    // Single precision separates few directions near the poles, so the spot's axis is on the equator.
    const Basis<float> frame(*beam);
    axis_ = frame.x;
    side_ = frame.y;
    top_ = *beam;
  }
  if (all_directions_) return;
  // The cone tangent to the sphere cuts the plane through its center in a circle of this radius.
  face(to_target / distance, target_center,
       target_radius * distance / std::sqrt((distance - target_radius) * (distance + target_radius)));
  distance_ = distance;
  // Close to a light its own size blurs the target.
  max_offset_ = std::max(0.0F, std::min(0.9F * distance, distance - 2 * light_radius));
  growth_ = (light_radius - target_half_size_) / distance;
  enable_guiding();
}

// The sphere projects onto the plane through its center as an ellipse, longer than wide by 1/cos.
PhotonGuide PhotonGuide::for_distant_light(const Imath::V3f& axis, double min_cosine,
                                           const Imath::V3f& target_center, double target_radius) {
  PhotonGuide guide;
  guide.distant_ = true;
  guide.distance_ = std::numeric_limits<float>::infinity();
  guide.face(axis, target_center, static_cast<float>(target_radius / min_cosine));
  guide.max_offset_ = 2 * guide.half_size_;
  guide.growth_ = static_cast<float>(std::sqrt(std::max(0.0, 1 - min_cosine * min_cosine)) / min_cosine);
  return guide;
}

void PhotonGuide::face(const Imath::V3f& axis, const Imath::V3f& target_center, float half_size) {
  target_center_ = target_center;
  target_half_size_ = half_size;
  axis_ = axis;
  const Basis<float> frame(axis_);
  side_ = frame.x;
  top_ = frame.y;
  set_target_distance(0);
}

// Moves the target towards the light by `offset` [m], with the size that covers the sphere from all points of
// the light.
void PhotonGuide::set_target_distance(float offset) {
  center_ = target_center_ - axis_ * offset;
  half_size_ = target_half_size_ + growth_ * offset;
}

void PhotonGuide::stratify(std::span<const BoundingSphere> casters) {
  if (!guided_ || all_directions_ || casters.size() < 2 || casters.size() > kMaxStrata) return;
  uniform_fraction_ = kUniformFractionOfStrata;
  for (const BoundingSphere& caster : casters)
    grids_.emplace_back(window_of(caster), (1 - uniform_fraction_) / static_cast<float>(casters.size()));
  stratified_ = true;
}

// Part of the target through which the rays of the light that hit a sphere pass. From the center of a light
// of radius R, at the distance D from the target, the sphere has the angular radius b. Its center is at the
// angle a from the axis and at the distance z along it. The part has the radius
//     D (tan(a + b) - tan a) + R |1 - D/z|.
// Rays of a distant light deviate from the axis by at most the slope `growth_`.
PhotonGuide::Window PhotonGuide::window_of(const BoundingSphere& caster) const {
  Imath::V3f offset = caster.center - center_;
  float radius = 0;
  if (distant_) {
    radius = caster.radius * std::sqrt(1 + growth_ * growth_) + growth_ * std::abs(offset.dot(axis_));
    offset -= axis_ * offset.dot(axis_);
  } else {
    const Imath::V3f to_caster = offset + axis_ * distance_;
    const float depth = to_caster.dot(axis_);
    const float length = to_caster.length();
    if (!(depth > 0 && caster.radius < length)) return {};
    const float angle = std::acos(std::min(depth / length, 1.0F));
    const float outer = angle + std::asin(caster.radius / length);
    if (!(outer < std::numbers::pi_v<float> / 2)) return {};
    const float light_radius = std::max(0.0F, growth_ * distance_ + target_half_size_);
    radius = distance_ * (std::tan(outer) - std::tan(angle)) + light_radius * std::abs(1 - distance_ / depth);
    offset = to_caster * (distance_ / depth) - axis_ * distance_;
  }
  const Imath::V2f center(0.5F + offset.dot(side_) / (2 * half_size_),
                          0.5F + offset.dot(top_) / (2 * half_size_));
  const float margin = radius / (2 * half_size_);
  const Imath::V2f low(std::clamp(center.x - margin, 0.0F, 1.0F), std::clamp(center.y - margin, 0.0F, 1.0F));
  const Imath::V2f high(std::clamp(center.x + margin, 0.0F, 1.0F), std::clamp(center.y + margin, 0.0F, 1.0F));
  const Window window{low, high - low};
  return window.area() > 0 ? window : Window();
}

void PhotonGuide::train(std::span<const PilotRay> pilot_rays, std::size_t max_branches) {
  if (!can_train() || pilot_rays.empty()) return;
  if (!all_directions_) minimise_footprint(pilot_rays);
  const std::vector<Branch> branches = branches_of(to_square(pilot_rays), max_branches);
  if (branches.empty()) return;
  guided_ = trained_ = true;
  if (stratified_) uniform_fraction_ = kUniformFraction;
  stratified_ = false;
  grids_.clear();
  Branch outside_windows;
  double total = 0;
  for (const Branch& branch : branches) {
    const Branch outside =
        add_grid_of(branch, branches.size() > 1 && photons_of(branch) < kMinPhotonsOfWindow);
    outside_windows.insert(outside_windows.end(), outside.begin(), outside.end());
    total += weight_of(branch);
  }
  const float aimed =
      outside_windows.empty() ? 1 - uniform_fraction_ : 1 - uniform_fraction_ - kOutsideFraction;
  const auto n = static_cast<double>(branches.size());
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double fraction = weight_of(branches[i]) / total;
    const double with_even = (1 - kUniformOverBranches) * fraction + kUniformOverBranches / n;
    grids_[i].fraction = branches.size() == 1 ? aimed : aimed * static_cast<float>(with_even);
  }
  if (!outside_windows.empty()) grids_.emplace_back(Window(), outside_windows).fraction = kOutsideFraction;
}

double PhotonGuide::weight_of(const Branch& branch) {
  return std::accumulate(branch.begin(), branch.end(), 0.0,
                         [](double sum, const WeightedPoint& point) { return sum + point.weight; });
}

// Branches by falling weight. All branches from number `max_branches` on are merged into one.
std::vector<PhotonGuide::Branch> PhotonGuide::branches_of(const std::vector<WeightedPoint>& points,
                                                          std::size_t max_branches) {
  std::map<std::uint32_t, double> weights;
  for (const WeightedPoint& point : points) weights[point.branch] += point.weight;
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const auto& [branch, weight] : weights) order.emplace_back(-weight, branch);
  std::sort(order.begin(), order.end());
  std::map<std::uint32_t, std::size_t> index;
  for (std::size_t i = 0; i < order.size(); ++i) index[order[i].second] = std::min(i, max_branches - 1);
  std::vector<Branch> branches(std::min(order.size(), max_branches));
  for (const WeightedPoint& point : points) branches[index[point.branch]].push_back(point);
  return branches;
}

// Effective number of photons, (sum w)^2 / sum w^2 of their weights w.
double PhotonGuide::photons_of(const Branch& branch) {
  double squares = 0;
  for (const WeightedPoint& point : branch) squares += point.weight * point.weight;
  return squares > 0 ? weight_of(branch) * weight_of(branch) / squares : 0;
}

// Adds the grid of a branch. Returns the few rays outside of its window.
PhotonGuide::Branch PhotonGuide::add_grid_of(Branch branch, bool from_few) {
  if (from_few) {
    grids_.emplace_back(Window(), spread_over_scales(branch));
    return {};
  }
  const Window window = window_of(branch);
  const auto first_outside = std::stable_partition(
      branch.begin(), branch.end(), [&](const WeightedPoint& one) { return window.holds(one.at); });
  Branch outside(first_outside, branch.end());
  branch.erase(first_outside, branch.end());
  grids_.emplace_back(window, branch);
  return outside;
}

void PhotonGuide::train_from_few(std::span<const PilotRay> pilot_rays) {
  if (!can_train() || trained_ || pilot_rays.empty()) return;
  if (!all_directions_) set_target_distance(0);
  const std::vector<WeightedPoint> points = spread_over_scales(to_square(pilot_rays));
  if (points.empty()) return;
  guided_ = true;
  stratified_ = false;
  uniform_fraction_ = kUniformFractionOfFew;
  grids_.clear();
  grids_.emplace_back(Window(), points).fraction = 1 - uniform_fraction_;
}

// Points around the given ones, distributed evenly in the logarithm of the distance, down to half a cell of
// the grid. They use the given points in turn, in directions that differ by the golden angle.
std::vector<PhotonGuide::WeightedPoint> PhotonGuide::spread_over_scales(
    const std::vector<WeightedPoint>& points) {
  constexpr double kMinDistance = 0.5 / kCells;
  constexpr double kMaxDistance = 0.5;
  constexpr double kGoldenAngle = 2 * std::numbers::pi / (std::numbers::phi * std::numbers::phi);
  std::vector<WeightedPoint> spread;
  for (std::size_t i = 0; !points.empty() && i < kGrid; ++i) {
    const auto distance = static_cast<float>(
        kMinDistance * std::pow(kMaxDistance / kMinDistance, (static_cast<double>(i) + 0.5) / kGrid));
    const auto angle = static_cast<float>(kGoldenAngle * static_cast<double>(i));
    const Imath::V2f at =
        points[i % points.size()].at + Imath::V2f(std::cos(angle), std::sin(angle)) * distance;
    if (Window().holds(at)) spread.push_back({at, 1});
  }
  return spread;
}

// Moves the target to the distance, one of a few, at which the rays pass through the smallest part of it. A
// move must make that part smaller by five per cent.
void PhotonGuide::minimise_footprint(std::span<const PilotRay> pilot_rays) {
  constexpr std::size_t kMaxTestRays = 1024;  // rays used for the test
  constexpr int kSteps = 20;
  constexpr float kMinGain = 1.05F;
  const auto test_rays = pilot_rays.first(std::min(kMaxTestRays, pilot_rays.size()));
  float smallest = 0;
  float best = 0;
  for (int step = 0; step <= kSteps; ++step) {
    const float offset = max_offset_ * static_cast<float>(step) / kSteps;
    set_target_distance(offset);
    const std::vector<WeightedPoint> points = to_square(test_rays);
    if (points.empty()) continue;
    const float footprint = footprint_of(window_of(points), offset);
    if (smallest > 0 && footprint * kMinGain > smallest) continue;
    smallest = footprint;
    best = offset;
  }
  set_target_distance(best);
}

// Area of a window on a target moved by `offset`, projected from the light's center onto the original plane.
float PhotonGuide::footprint_of(const Window& window, float offset) const {
  const float edge = half_size_ / (1 - offset / distance_);
  return window.area() * edge * edge;
}

std::vector<PhotonGuide::WeightedPoint> PhotonGuide::to_square(std::span<const PilotRay> pilot_rays) const {
  std::vector<WeightedPoint> points;
  for (const PilotRay& ray : pilot_rays)
    if (const auto at = to_square(ray.from, ray.direction)) points.push_back({*at, ray.weight, ray.branch});
  return points;
}

PhotonGuide::Window PhotonGuide::window_of(const std::vector<WeightedPoint>& points) {
  AxisWeights a;
  AxisWeights b;
  for (const auto& [at, weight, branch] : points) {
    a.emplace_back(at.x, weight);
    b.emplace_back(at.y, weight);
  }
  const auto [left, width] = interval_of(a);
  const auto [bottom, height] = interval_of(b);
  return {{left, bottom}, {width, height}};
}

bool PhotonGuide::Window::holds(const Imath::V2f& at) const {
  const Imath::V2f within = (at - corner) / size;
  return within.x >= 0 && within.x < 1 && within.y >= 0 && within.y < 1;
}

PhotonGuide::Grid::Grid(const Window& over, const std::vector<WeightedPoint>& points)
    : window(over), density(kGrid), row_cdf(kCells), column_cdf(kGrid) {
  std::vector<double> cells(kGrid, 0.0);
  std::vector<std::size_t> ray_cells;
  for (const auto& [at, weight, branch] : points) {
    const Imath::V2f within = (at - window.corner) / window.size;
    add_between(cells, within, weight);
    ray_cells.push_back(cell_of(within));
  }
  const std::vector<double> weights = smoothed(cells, smoothing_radius(ray_cells));
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  double rows = 0;
  for (std::size_t row = 0; row < kCells; ++row) {
    const double* in_row = &weights[row * kCells];
    const double row_total = std::accumulate(in_row, in_row + kCells, 0.0);
    double columns = 0;
    for (std::size_t column = 0; column < kCells; ++column) {
      density[row * kCells + column] = static_cast<float>(in_row[column] / total * kGrid) / window.area();
      columns += in_row[column];
      column_cdf[row * kCells + column] = static_cast<float>(columns / row_total);
    }
    rows += row_total;
    row_cdf[row] = static_cast<float>(rows / total);
  }
}

// A sample counts for the cell in which it was drawn, although rounding may move it into the next one.
PhotonGuide::SquarePoint PhotonGuide::Grid::draw(Imath::V2f u) const {
  if (density.empty()) return {window.corner + u * window.size, 1 / window.area()};
  const std::span<const float> columns(column_cdf);
  const CdfStep<float> row = invert_cdf(std::span<const float>(row_cdf), u.y);
  const CdfStep<float> column = invert_cdf(columns.subspan(row.index * kCells, kCells), u.x);
  const Imath::V2f within((static_cast<float>(column.index) + column.within) / kCells,
                          (static_cast<float>(row.index) + row.within) / kCells);
  return {window.corner + within * window.size, density[row.index * kCells + column.index]};
}

float PhotonGuide::Grid::pdf(const Imath::V2f& at) const {
  if (!window.holds(at)) return 0;
  return density.empty() ? 1 / window.area() : density[cell_of((at - window.corner) / window.size)];
}

// Point at which a ray passes through the target: ahead of the ray's origin, except for distant lights, whose
// rays start anywhere.
std::optional<Imath::V2f> PhotonGuide::to_square(const Imath::V3f& from, const Imath::V3f& direction) const {
  if (all_directions_) {
    const float turn = std::atan2(direction.dot(top_), direction.dot(side_)) * kInverseTurn;
    return Imath::V2f(turn < 0 ? turn + 1 : turn, (1 - direction.dot(axis_)) / 2);
  }
  const Imath::V3d axis(axis_);
  const Imath::V3d ray_direction(direction);
  const Imath::V3d from_center = Imath::V3d(from) - Imath::V3d(center_);
  const double t = -from_center.dot(axis) / ray_direction.dot(axis);
  if (!(distant_ || t > 0)) return std::nullopt;
  const Imath::V3d offset = (from_center + ray_direction * t) / (2 * static_cast<double>(half_size_));
  const Imath::V2f at(static_cast<float>(0.5 + offset.dot(Imath::V3d(side_))),
                      static_cast<float>(0.5 + offset.dot(Imath::V3d(top_))));
  if (!(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1)) return std::nullopt;
  return at;
}

// Pdf of a point of the unit square: uniform fraction plus grids.
float PhotonGuide::pdf_at(const Imath::V2f& at) const {
  if (grids_.empty()) return 1;
  float pdf = uniform_fraction_;
  for (const Grid& grid : grids_) pdf += grid.fraction * grid.pdf(at);
  return pdf;
}

// Samples a point of the unit square; `u.x` first selects a grid or the uniform fraction. The pdf is that of
// the mixture.
PhotonGuide::SquarePoint PhotonGuide::draw(Imath::V2f u) const {
  if (grids_.empty()) return {u, 1};
  for (const Grid& grid : grids_) {
    if (u.x < grid.fraction) {
      const SquarePoint drawn = grid.draw({u.x / grid.fraction, u.y});
      float pdf = uniform_fraction_ + grid.fraction * drawn.pdf;
      for (const Grid& other : grids_)
        if (&other != &grid) pdf += other.fraction * other.pdf(drawn.at);
      return {drawn.at, pdf};
    }
    u.x -= grid.fraction;
  }
  const Imath::V2f at(std::min(u.x / uniform_fraction_, 1.0F), u.y);
  return {at, pdf_at(at)};
}

Imath::V3f PhotonGuide::point_at(const Imath::V2f& at) const {
  return center_ + side_ * ((2 * at.x - 1) * half_size_) + top_ * ((2 * at.y - 1) * half_size_);
}

GuidedPoint PhotonGuide::point(Imath::V2f u) const {
  const SquarePoint drawn = draw(u);
  return {point_at(drawn.at), drawn.pdf / (4 * half_size_ * half_size_)};
}

Imath::V3f PhotonGuide::direction_to(const Imath::V3f& from, const Imath::V2f& at) const {
  if (!all_directions_) return (point_at(at) - from).normalized();
  const Imath::V3f local = direction_at(1 - 2 * at.y, 2 * std::numbers::pi * at.x);
  return side_ * local.x + top_ * local.y + axis_ * local.z;
}

float PhotonGuide::pdf_of_direction(const Imath::V3f& from, const Imath::V3f& direction, float pdf) const {
  if (all_directions_) return pdf * kInverseTurn / 2;
  const float cos_theta = direction.dot(axis_);
  const float t = (center_ - from).dot(axis_) / cos_theta;
  return pdf / (4 * half_size_ * half_size_) * t * t / std::abs(cos_theta);
}

GuidedDirection PhotonGuide::sample(const Light& light, const EmissionPoint& from, float choice, Imath::V2f u,
                                    float time) const {
  const auto by_emission = [&](const Imath::V3f& wi) {
    return emission_density(light, from.normal, wi, kAnyRadius, time).pdf_direction;
  };
  if (!guided_) {
    const Imath::V3f wi = emission_direction(light, from.normal, u, time);
    return {wi, by_emission(wi)};
  }
  Imath::V3f wi;
  float at_target = 0;
  if (choice < kEmissionFraction) {
    wi = emission_direction(light, from.normal, u, time);
    if (const auto at = to_square(from.point, wi)) at_target = pdf_at(*at);
  } else {
    const auto [at, pdf] = draw(u);
    wi = direction_to(from.point, at);
    at_target = pdf;
  }
  return {wi, kEmissionFraction * by_emission(wi) +
                  (1 - kEmissionFraction) * pdf_of_direction(from.point, wi, at_target)};
}

}  // namespace abbe
