#include "transport/plan/aim.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "materials/bsdf/warp.h"
#include "sampling/discrete.h"
#include "scene/lights/emission.h"
#include "scene/shapes/basis.h"

namespace abbe {
namespace {

constexpr float kEmissionShare = 0.05F;
constexpr float kInverseTurn = std::numbers::inv_pi_v<float> / 2;
constexpr float kAnyRadius = 1;  // of the scene, which only light from infinity asks for

}  // namespace

Aim::Aim(const Imath::V3f& light_center, const Imath::V3f& target_center, float target_radius) {
  const Imath::V3f to_target = target_center - light_center;
  const float distance = to_target.length();
  if (!(target_radius > 0)) return;
  around_ = !(distance > 1.2F * target_radius);
  if (around_) return;
  // The cone that touches the sphere cuts the plane through its centre in a circle of this radius.
  face(to_target / distance, target_center,
       target_radius * distance / std::sqrt((distance - target_radius) * (distance + target_radius)));
  guide();
}

// The shadow of the sphere on the plane through its centre is an ellipse, 1/cos as long as it is wide.
Aim Aim::from_afar(const Imath::V3f& axis, double least_cosine, const Imath::V3f& target_center,
                   double target_radius) {
  Aim aim;
  aim.face(axis, target_center, static_cast<float>(target_radius / least_cosine));
  return aim;
}

void Aim::guide() {
  guided_ = true;
  build(std::vector<double>(kGrid, 1.0));
}

void Aim::face(const Imath::V3f& axis, const Imath::V3f& target_center, float half_size) {
  center_ = target_center;
  axis_ = axis;
  const Basis<float> frame(axis_);
  side_ = frame.x;
  top_ = frame.y;
  half_size_ = half_size;
}

void Aim::learn(const std::vector<double>& importance, int reach) {
  const double total = std::accumulate(importance.begin(), importance.end(), 0.0);
  if (importance.empty() || !(total > 0)) return;
  std::vector<double> spread(kGrid, 0.1 * total / kGrid);
  const double share = 0.9 / ((2 * reach + 1) * (2 * reach + 1));
  for (int row = 0; row < kCells; ++row)
    for (int column = 0; column < kCells; ++column) {
      const double amount = share * importance[static_cast<std::size_t>(row * kCells + column)];
      if (amount == 0) continue;
      for (int dr = -reach; dr <= reach; ++dr)
        for (int dc = -reach; dc <= reach; ++dc) {
          const int r = std::clamp(row + dr, 0, kCells - 1);
          const int c = std::clamp(column + dc, 0, kCells - 1);
          spread[static_cast<std::size_t>(r * kCells + c)] += amount;
        }
    }
  guided_ = true;
  build(spread);
}

void Aim::build(const std::vector<double>& weights) {
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  density_.resize(kGrid);
  row_cdf_.resize(kCells);
  column_cdf_.resize(kGrid);
  double rows = 0;
  for (std::size_t row = 0; row < kCells; ++row) {
    const double* cells = &weights[row * kCells];
    const double row_total = std::accumulate(cells, cells + kCells, 0.0);
    double columns = 0;
    for (std::size_t column = 0; column < kCells; ++column) {
      density_[row * kCells + column] = static_cast<float>(cells[column] / total * kGrid);
      columns += cells[column];
      column_cdf_[row * kCells + column] = static_cast<float>(columns / row_total);
    }
    rows += row_total;
    row_cdf_[row] = static_cast<float>(rows / total);
  }
}

int Aim::cell_of(float a, float b) const {
  const int column = std::min(static_cast<int>(a * kCells), kCells - 1);
  const int row = std::min(static_cast<int>(b * kCells), kCells - 1);
  return row * kCells + column;
}

int Aim::cell_met(const Imath::V3f& from, const Imath::V3f& direction) const {
  if (around_) {
    const float turn = std::atan2(direction.dot(top_), direction.dot(side_)) * kInverseTurn;
    return cell_of(turn < 0 ? turn + 1 : turn, (1 - direction.dot(axis_)) / 2);
  }
  const float t = (center_ - from).dot(axis_) / direction.dot(axis_);
  if (!(t > 0)) return -1;
  const Imath::V3f offset = from + direction * t - center_;
  const float a = 0.5F + offset.dot(side_) / (2 * half_size_);
  const float b = 0.5F + offset.dot(top_) / (2 * half_size_);
  return a >= 0 && a < 1 && b >= 0 && b < 1 ? cell_of(a, b) : -1;
}

float Aim::target_pdf(const Imath::V3f& from, const Imath::V3f& direction, int cell) const {
  if (cell < 0) return 0;
  if (around_) return density_[static_cast<std::size_t>(cell)] * kInverseTurn / 2;
  const float cos_theta = direction.dot(axis_);
  const float t = (center_ - from).dot(axis_) / cos_theta;
  return density_[static_cast<std::size_t>(cell)] / (4 * half_size_ * half_size_) * t * t /
         std::abs(cos_theta);
}

AimedPoint Aim::point(Imath::V2f u) const {
  const float even = 1 / (4 * half_size_ * half_size_);
  const auto on_target = [this](float a, float b) {
    return center_ + side_ * ((2 * a - 1) * half_size_) + top_ * ((2 * b - 1) * half_size_);
  };
  if (!guided_) return {on_target(u.x, u.y), even, -1};
  const GridPoint at = grid_point(u);
  return {on_target(at.a, at.b), density_[static_cast<std::size_t>(at.cell)] * even, at.cell};
}

Aim::GridPoint Aim::grid_point(Imath::V2f u) const {
  const std::span<const float> columns(column_cdf_);
  const CdfStep<float> row = invert_cdf(std::span<const float>(row_cdf_), u.y);
  const CdfStep<float> column = invert_cdf(columns.subspan(row.index * kCells, kCells), u.x);
  return {(static_cast<float>(column.index) + column.within) / kCells,
          (static_cast<float>(row.index) + row.within) / kCells,
          static_cast<int>(row.index * kCells + column.index)};
}

AimedDirection Aim::sample(const Light& light, const EmissionPoint& from, float choice, Imath::V2f u,
                           float time) const {
  AimedDirection aimed;
  if (!guided_ || choice < kEmissionShare) {
    aimed.wi = emission_direction(light, from.normal, u, time);
    if (around_) aimed.cell = cell_met(from.point, aimed.wi);
  } else if (around_) {
    const GridPoint at = grid_point(u);
    const Imath::V3f local = direction_at(1 - 2 * at.b, 2 * std::numbers::pi * at.a);
    aimed.wi = side_ * local.x + top_ * local.y + axis_ * local.z;
    aimed.cell = at.cell;
  } else {
    const AimedPoint target = point(u);
    aimed.wi = (target.point - from.point).normalized();
    aimed.cell = target.cell;
  }
  const float by_emission = emission_density(light, from.normal, aimed.wi, kAnyRadius, time).pdf_direction;
  aimed.pdf = by_emission;
  if (!guided_) return aimed;
  // A direction drawn through a cell counts as through that cell: rounded, it may meet the next one.
  const int cell = aimed.cell >= 0 ? aimed.cell : cell_met(from.point, aimed.wi);
  aimed.pdf = kEmissionShare * by_emission + (1 - kEmissionShare) * target_pdf(from.point, aimed.wi, cell);
  return aimed;
}

}  // namespace abbe
