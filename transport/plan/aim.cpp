#include "transport/plan/aim.h"

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
#include "scene/lights/emission.h"
#include "scene/shapes/basis.h"

namespace abbe {
namespace {

constexpr std::size_t kCells = 128;  // along each side of the grid
constexpr std::size_t kGrid = kCells * kCells;
constexpr float kEmissionShare = 0.05F;
// Of those that are aimed: at most where few others have gone, and, once guessed, anywhere.
constexpr float kApart = 0.1F;
constexpr float kAnywhereByGuess = 0.5F;
constexpr double kFewestOfWindow = 8;       // photons of a branch
constexpr double kEvenOverBranches = 0.25;  // fraction of the photons that follow others
constexpr double kEvenShare = 0.1;          // of those within a grid
constexpr float kInverseTurn = std::numbers::inv_pi_v<float> / 2;
constexpr float kAnyRadius = 1;  // of the scene, which only light from infinity asks for

using Worths = std::vector<std::pair<float, double>>;  // of places along one axis, in their order

// Where a share of the worth lies before: between the middles of two, so that it is continuous in them all.
float quantile(const Worths& worths, double share) {
  const double total = std::accumulate(worths.begin(), worths.end(), 0.0,
                                       [](double sum, const auto& one) { return sum + one.second; });
  double before = 0;
  std::pair<double, float> last{0, worths.front().first};
  for (const auto& [at, worth] : worths) {
    const double middle = (before + worth / 2) / total;
    if (middle >= share) {
      const double step = middle > last.first ? (share - last.first) / (middle - last.first) : 1;
      return last.second + static_cast<float>(step) * (at - last.second);
    }
    last = {middle, at};
    before += worth;
  }
  return last.second;
}

// What lies between the first and the last hundredth of the worth, and an eighth on either side: its
// beginning and its size, in [0, 1]. In steps, so that rounding moves no grid.
std::pair<float, float> interval_of(Worths& worths) {
  constexpr double kTail = 0.01;
  constexpr float kMargin = 0.125F;
  constexpr float kSteps = 2048;
  std::sort(worths.begin(), worths.end());
  const float low = quantile(worths, kTail);
  const float high = quantile(worths, 1 - kTail);
  const float margin = kMargin * (high - low);
  const float from = std::max(std::floor((low - margin) * kSteps), 0.0F);
  const float to = std::min(std::floor((high + margin) * kSteps) + 1, kSteps);
  return {from / kSteps, (to - from) / kSteps};
}

// Adds to the four cells whose middles are around a place of the unit square, so that what they hold is
// continuous in it.
void add_between(std::vector<double>& cells, const Imath::V2f& at, double worth) {
  const auto split = [](float x) {
    const float from_middle = std::clamp(x * kCells - 0.5F, 0.0F, static_cast<float>(kCells - 1));
    const auto below = std::min(static_cast<std::size_t>(from_middle), kCells - 2);
    return std::pair(below, static_cast<double>(from_middle) - static_cast<double>(below));
  };
  const auto [column, right] = split(at.x);
  const auto [row, up] = split(at.y);
  double* cell = &cells[row * kCells + column];
  cell[0] += worth * (1 - right) * (1 - up);
  cell[1] += worth * right * (1 - up);
  cell[kCells] += worth * (1 - right) * up;
  cell[kCells + 1] += worth * right * up;
}

// Means over so many cells before and after each along one axis, mirrored beyond the edges: `step` leads from
// a cell to the next along it, `other` along the other axis.
void average(std::vector<double>& cells, int reach, std::size_t step, std::size_t other) {
  constexpr int kEdge = static_cast<int>(kCells);
  const auto mirrored = [](int i) {
    return static_cast<std::size_t>(i < 0 ? -1 - i : i < kEdge ? i : 2 * kEdge - 1 - i);
  };
  std::array<double, kCells> line;
  for (std::size_t k = 0; k < kCells; ++k) {
    for (int i = 0; i < kEdge; ++i) {
      double sum = 0;
      for (int near = i - reach; near <= i + reach; ++near) sum += cells[k * other + mirrored(near) * step];
      line[static_cast<std::size_t>(i)] = sum / (2 * reach + 1);
    }
    for (std::size_t i = 0; i < kCells; ++i) cells[k * other + i * step] = line[i];
  }
}

// Each spread over the cells within so many of it, the less the farther, twice by half of that, so that the
// density is continuous in where rays pass; but for a share that is spread over all, as where little light
// passes few rays or none have shown it.
std::vector<double> smoothed(std::vector<double> cells, int reach) {
  const double even = std::accumulate(cells.begin(), cells.end(), 0.0) / kGrid;
  for (int time = 0; time < 2; ++time) {
    average(cells, (reach + 1) / 2, 1, kCells);
    average(cells, (reach + 1) / 2, kCells, 1);
  }
  for (double& cell : cells) cell = (1 - kEvenShare) * cell + kEvenShare * even;
  return cells;
}

// Of a place within the unit square.
std::size_t cell_of(const Imath::V2f& at) {
  const auto step = [](float x) {
    return std::min(static_cast<std::size_t>(std::max(x, 0.0F) * kCells), kCells - 1);
  };
  return step(at.y) * kCells + step(at.x);
}

constexpr double kRaysAround = 16;
constexpr int kMostReach = 16;

// So many that a square of them holds about sixteen of the rays, were they all over the grid.
int reach_for(std::size_t rays) {
  const double side = std::sqrt(kRaysAround * kGrid / static_cast<double>(rays));
  return static_cast<int>(std::clamp(std::ceil((side - 1) / 2), 1.0, double{kMostReach}));
}

// True if nine in ten of the rays have sixteen, themselves included, within so many cells on either side.
// `cells` has the cell of each ray.
bool rays_are_dense(const std::vector<std::size_t>& cells, int reach) {
  std::vector<double> counts(kGrid, 0.0);
  for (const std::size_t cell : cells) counts[cell] += 1;
  const double square = (2 * reach + 1) * (2 * reach + 1);
  average(counts, reach, 1, kCells);
  average(counts, reach, kCells, 1);
  constexpr double kRounding = 1e-6;
  const auto lone = std::ranges::count_if(
      cells, [&](std::size_t cell) { return counts[cell] * square < kRaysAround - kRounding; });
  return 10 * lone <= std::ssize(cells);
}

// Rays that are concentrated on a few spots of the grid are dense at a smaller reach.
int reach_for(const std::vector<std::size_t>& cells) {
  int reach = reach_for(cells.size());
  while (reach > 1 && rays_are_dense(cells, reach - 1)) --reach;
  return reach;
}

}  // namespace

Aim::Aim(const Imath::V3f& light_center, float light_radius, const Imath::V3f& target_center,
         float target_radius, const std::optional<Imath::V3f>& beam) {
  const Imath::V3f to_target = target_center - light_center;
  const float distance = to_target.length();
  if (!(target_radius > 0)) return;
  around_ = !(distance > 1.2F * target_radius);
  if (around_ && beam) {
    // Near the poles single precision tells few directions apart: the beam is at the equator.
    const Basis<float> frame(*beam);
    axis_ = frame.x;
    side_ = frame.y;
    top_ = *beam;
  }
  if (around_) return;
  // The cone that touches the sphere cuts the plane through its centre in a circle of this radius.
  face(to_target / distance, target_center,
       target_radius * distance / std::sqrt((distance - target_radius) * (distance + target_radius)));
  distance_ = distance;
  // Close to a lamp its own size spreads what comes there.
  nearest_ = std::max(0.0F, std::min(0.9F * distance, distance - 2 * light_radius));
  growth_ = (light_radius - target_half_size_) / distance;
  guide();
}

// The shadow of the sphere on the plane through its centre is an ellipse, 1/cos as long as it is wide.
Aim Aim::from_afar(const Imath::V3f& axis, double least_cosine, const Imath::V3f& target_center,
                   double target_radius) {
  Aim aim;
  aim.far_ = true;
  aim.distance_ = std::numeric_limits<float>::infinity();
  aim.face(axis, target_center, static_cast<float>(target_radius / least_cosine));
  aim.nearest_ = 2 * aim.half_size_;
  aim.growth_ = static_cast<float>(std::sqrt(std::max(0.0, 1 - least_cosine * least_cosine)) / least_cosine);
  return aim;
}

void Aim::face(const Imath::V3f& axis, const Imath::V3f& target_center, float half_size) {
  target_center_ = target_center;
  target_half_size_ = half_size;
  axis_ = axis;
  const Basis<float> frame(axis_);
  side_ = frame.x;
  top_ = frame.y;
  stand(0);
}

// Nearer to the light by so much, where it covers what it covers from all of the light at its place.
void Aim::stand(float nearer) {
  center_ = target_center_ - axis_ * nearer;
  half_size_ = target_half_size_ + growth_ * nearer;
}

void Aim::learn(std::span<const ShownRay> shown, std::size_t most_branches) {
  if (!learns() || shown.empty()) return;
  if (!around_) stand_where_fewest_pass(shown);
  const std::vector<Branch> branches = branches_of(places_of(shown), most_branches);
  if (branches.empty()) return;
  guided_ = has_learned_ = true;
  grids_.clear();
  Branch apart;
  double total = 0;
  for (const Branch& branch : branches) {
    const Branch outside = add_grid_of(branch, branches.size() > 1 && photons_of(branch) < kFewestOfWindow);
    apart.insert(apart.end(), outside.begin(), outside.end());
    total += weight_of(branch);
  }
  const float aimed = apart.empty() ? 1 - anywhere_ : 1 - anywhere_ - kApart;
  const auto n = static_cast<double>(branches.size());
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const double fraction = weight_of(branches[i]) / total;
    const double with_even = (1 - kEvenOverBranches) * fraction + kEvenOverBranches / n;
    grids_[i].share = branches.size() == 1 ? aimed : aimed * static_cast<float>(with_even);
  }
  if (!apart.empty()) grids_.emplace_back(Window(), apart).share = kApart;
}

double Aim::weight_of(const Branch& branch) {
  return std::accumulate(branch.begin(), branch.end(), 0.0,
                         [](double sum, const WeighedPlace& place) { return sum + place.worth; });
}

// The branches by falling weight. All but the first `most` - 1 are merged into the last one.
std::vector<Aim::Branch> Aim::branches_of(const std::vector<WeighedPlace>& places, std::size_t most) {
  std::map<std::uint32_t, double> weights;
  for (const WeighedPlace& place : places) weights[place.branch] += place.worth;
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const auto& [branch, weight] : weights) order.emplace_back(-weight, branch);
  std::sort(order.begin(), order.end());
  std::map<std::uint32_t, std::size_t> index;
  for (std::size_t i = 0; i < order.size(); ++i) index[order[i].second] = std::min(i, most - 1);
  std::vector<Branch> branches(std::min(order.size(), most));
  for (const WeighedPlace& place : places) branches[index[place.branch]].push_back(place);
  return branches;
}

// Effective number of photons, (sum w)^2 / sum w^2 of their weights w.
double Aim::photons_of(const Branch& branch) {
  double squares = 0;
  for (const WeighedPlace& place : branch) squares += place.worth * place.worth;
  return squares > 0 ? weight_of(branch) * weight_of(branch) / squares : 0;
}

// Adds the grid of a branch. Returns the rays outside of its window, which are few.
Aim::Branch Aim::add_grid_of(Branch branch, bool guesses) {
  if (guesses) {
    grids_.emplace_back(Window(), spread_over_scales(branch));
    return {};
  }
  const Window window = window_of(branch);
  const auto apart = std::stable_partition(branch.begin(), branch.end(),
                                           [&](const WeighedPlace& one) { return window.holds(one.at); });
  const Branch outside(apart, branch.end());
  branch.erase(apart, branch.end());
  grids_.emplace_back(window, branch);
  return outside;
}

void Aim::guess(std::span<const ShownRay> shown) {
  if (!learns() || has_learned_ || shown.empty()) return;
  if (!around_) stand(0);
  const std::vector<WeighedPlace> places = spread_over_scales(places_of(shown));
  if (places.empty()) return;
  guided_ = true;
  anywhere_ = kAnywhereByGuess;
  grids_.clear();
  grids_.emplace_back(Window(), places).share = 1 - anywhere_;
}

// Many places around the given ones, as many at distances from one to twice any, down to half a cell of the
// grid: in turn about each, in directions a golden angle apart.
std::vector<Aim::WeighedPlace> Aim::spread_over_scales(const std::vector<WeighedPlace>& places) {
  constexpr double kLeast = 0.5 / kCells;
  constexpr double kMost = 0.5;
  constexpr double kGoldenAngle = 2 * std::numbers::pi / (std::numbers::phi * std::numbers::phi);
  std::vector<WeighedPlace> spread;
  for (std::size_t i = 0; !places.empty() && i < kGrid; ++i) {
    const auto distance =
        static_cast<float>(kLeast * std::pow(kMost / kLeast, (static_cast<double>(i) + 0.5) / kGrid));
    const auto angle = static_cast<float>(kGoldenAngle * static_cast<double>(i));
    const Imath::V2f at =
        places[i % places.size()].at + Imath::V2f(std::cos(angle), std::sin(angle)) * distance;
    if (Window().holds(at)) spread.push_back({at, 1});
  }
  return spread;
}

void Aim::stand_where_fewest_pass(std::span<const ShownRay> shown) {
  constexpr std::size_t kEnough = 1024;  // rays to tell
  constexpr int kSteps = 20;
  constexpr float kLeastGain = 1.05F;
  const auto some = shown.first(std::min(kEnough, shown.size()));
  float smallest = 0;
  float best = 0;
  for (int step = 0; step <= kSteps; ++step) {
    const float nearer = nearest_ * static_cast<float>(step) / kSteps;
    stand(nearer);
    const std::vector<WeighedPlace> places = places_of(some);
    if (places.empty()) continue;
    const float extent = extent_of(window_of(places), nearer);
    if (smallest > 0 && extent * kLeastGain > smallest) continue;
    smallest = extent;
    best = nearer;
  }
  stand(best);
}

// Of a window on a target that stands so much nearer, as seen from the middle of the light.
float Aim::extent_of(const Window& window, float nearer) const {
  const float edge = half_size_ / (1 - nearer / distance_);
  return window.area() * edge * edge;
}

std::vector<Aim::WeighedPlace> Aim::places_of(std::span<const ShownRay> shown) const {
  std::vector<WeighedPlace> places;
  for (const ShownRay& ray : shown)
    if (const auto at = place_of(ray.from, ray.direction)) places.push_back({*at, ray.worth, ray.branch});
  return places;
}

Aim::Window Aim::window_of(const std::vector<WeighedPlace>& places) {
  Worths a;
  Worths b;
  for (const auto& [at, worth, branch] : places) {
    a.emplace_back(at.x, worth);
    b.emplace_back(at.y, worth);
  }
  const auto [left, width] = interval_of(a);
  const auto [bottom, height] = interval_of(b);
  return {{left, bottom}, {width, height}};
}

bool Aim::Window::holds(const Imath::V2f& at) const {
  const Imath::V2f within = (at - corner) / size;
  return within.x >= 0 && within.x < 1 && within.y >= 0 && within.y < 1;
}

Aim::Grid::Grid(const Window& over, const std::vector<WeighedPlace>& places)
    : window(over), density(kGrid), row_cdf(kCells), column_cdf(kGrid) {
  std::vector<double> cells(kGrid, 0.0);
  std::vector<std::size_t> ray_cells;
  for (const auto& [at, worth, branch] : places) {
    const Imath::V2f within = (at - window.corner) / window.size;
    add_between(cells, within, worth);
    ray_cells.push_back(cell_of(within));
  }
  const std::vector<double> weights = smoothed(cells, reach_for(ray_cells));
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

// What is drawn in a cell counts as in that cell: rounded, it may lie in the next one.
Aim::Place Aim::Grid::draw(Imath::V2f u) const {
  const std::span<const float> columns(column_cdf);
  const CdfStep<float> row = invert_cdf(std::span<const float>(row_cdf), u.y);
  const CdfStep<float> column = invert_cdf(columns.subspan(row.index * kCells, kCells), u.x);
  const Imath::V2f within((static_cast<float>(column.index) + column.within) / kCells,
                          (static_cast<float>(row.index) + row.within) / kCells);
  return {window.corner + within * window.size, density[row.index * kCells + column.index]};
}

float Aim::Grid::pdf(const Imath::V2f& at) const {
  return window.holds(at) ? density[cell_of((at - window.corner) / window.size)] : 0;
}

// Where a ray goes through the target: before it, but for those from afar, which begin anywhere.
std::optional<Imath::V2f> Aim::place_of(const Imath::V3f& from, const Imath::V3f& direction) const {
  if (around_) {
    const float turn = std::atan2(direction.dot(top_), direction.dot(side_)) * kInverseTurn;
    return Imath::V2f(turn < 0 ? turn + 1 : turn, (1 - direction.dot(axis_)) / 2);
  }
  const Imath::V3d axis(axis_);
  const Imath::V3d way(direction);
  const Imath::V3d apart = Imath::V3d(from) - Imath::V3d(center_);
  const double t = -apart.dot(axis) / way.dot(axis);
  if (!(far_ || t > 0)) return std::nullopt;
  const Imath::V3d offset = (apart + way * t) / (2 * static_cast<double>(half_size_));
  const Imath::V2f at(static_cast<float>(0.5 + offset.dot(Imath::V3d(side_))),
                      static_cast<float>(0.5 + offset.dot(Imath::V3d(top_))));
  if (!(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1)) return std::nullopt;
  return at;
}

float Aim::pdf_at(const Imath::V2f& at) const {
  if (grids_.empty()) return 1;
  float pdf = anywhere_;
  for (const Grid& grid : grids_) pdf += grid.share * grid.pdf(at);
  return pdf;
}

Aim::Place Aim::draw(Imath::V2f u) const {
  if (grids_.empty()) return {u, 1};
  for (const Grid& grid : grids_) {
    if (u.x < grid.share) {
      const Place drawn = grid.draw({u.x / grid.share, u.y});
      float pdf = anywhere_ + grid.share * drawn.pdf;
      for (const Grid& other : grids_)
        if (&other != &grid) pdf += other.share * other.pdf(drawn.at);
      return {drawn.at, pdf};
    }
    u.x -= grid.share;
  }
  const Imath::V2f at(std::min(u.x / anywhere_, 1.0F), u.y);
  return {at, pdf_at(at)};
}

Imath::V3f Aim::point_at(const Imath::V2f& at) const {
  return center_ + side_ * ((2 * at.x - 1) * half_size_) + top_ * ((2 * at.y - 1) * half_size_);
}

AimedPoint Aim::point(Imath::V2f u) const {
  const Place place = draw(u);
  return {point_at(place.at), place.pdf / (4 * half_size_ * half_size_)};
}

Imath::V3f Aim::direction_to(const Imath::V3f& from, const Imath::V2f& at) const {
  if (!around_) return (point_at(at) - from).normalized();
  const Imath::V3f local = direction_at(1 - 2 * at.y, 2 * std::numbers::pi * at.x);
  return side_ * local.x + top_ * local.y + axis_ * local.z;
}

float Aim::pdf_of_direction(const Imath::V3f& from, const Imath::V3f& direction, float pdf) const {
  if (around_) return pdf * kInverseTurn / 2;
  const float cos_theta = direction.dot(axis_);
  const float t = (center_ - from).dot(axis_) / cos_theta;
  return pdf / (4 * half_size_ * half_size_) * t * t / std::abs(cos_theta);
}

AimedDirection Aim::sample(const Light& light, const EmissionPoint& from, float choice, Imath::V2f u,
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
  if (choice < kEmissionShare) {
    wi = emission_direction(light, from.normal, u, time);
    if (const auto at = place_of(from.point, wi)) at_target = pdf_at(*at);
  } else {
    const auto [at, pdf] = draw(u);
    wi = direction_to(from.point, at);
    at_target = pdf;
  }
  return {wi, kEmissionShare * by_emission(wi) +
                  (1 - kEmissionShare) * pdf_of_direction(from.point, wi, at_target)};
}

}  // namespace abbe
