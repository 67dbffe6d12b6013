#include "transport/path/ray_polarisation.h"

namespace abbe {

FullMueller FullMueller::identity() {
  return of({}, 1);
}

FullMueller FullMueller::of(const MuellerElements<double>& m, double power) {
  FullMueller full{{{{1, m.d, 0, 0}, {m.d, m.p, 0, 0}, {0, 0, m.c, 0 - m.s}, {0, 0, m.s, m.c}}}};
  return full *= power;
}

StokesVector FullMueller::operator*(const StokesVector& light) const {
  StokesVector after{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) after[i] += rows[i][j] * light[j];
  return after;
}

FullMueller FullMueller::operator*(const FullMueller& before) const {
  FullMueller both{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) both.rows[i][j] += rows[i][k] * before.rows[k][j];
  return both;
}

FullMueller& FullMueller::operator*=(double power) {
  for (StokesVector& row : rows)
    for (double& element : row) element *= power;
  return *this;
}

// Rotation by the right-handed angle between both axes about the direction. [Born1999, sec. 10.9]
void RayPolarisation::turn_to(const Imath::V3d& axis, const Imath::V3d& direction) {
  const double cosine = last_axis.dot(axis);
  const double sine = direction.dot(last_axis.cross(axis));
  const double scale = 1 / (cosine * cosine + sine * sine);
  const double cos_twice = (cosine - sine) * (cosine + sine) * scale;
  const double sin_twice = 2 * sine * cosine * scale;
  const FullMueller turn{
      {{{1, 0, 0, 0}, {0, cos_twice, sin_twice, 0}, {0, -sin_twice, cos_twice, 0}, {0, 0, 0, 1}}}};
  mueller = turn * mueller;
  last_axis = axis;
}

}  // namespace abbe
