#include <array>
#include <cmath>

#include <ImathMatrix.h>

#include "materials/index/library.h"
#include "materials/interface/snell.h"
#include "tests/scenes/scene_fixture.h"

// What a spectroscopist does with `spectrograph.json`: finds the lines of mercury on the array, works out the
// index of the prism for each, and fits its dispersion.

namespace abbe {
namespace {

using Imath::V3d;

constexpr std::array kMercury_nm{404.6561, 435.8343, 546.0740, 576.9598, 579.0663};

// Centroids of what stands out of the dark, from left to right [columns].
std::vector<double> line_columns(const Film& film) {
  const auto value = [&film](int x) { return film.mean(static_cast<std::size_t>(x), 0); };
  double brightest = 0;
  for (int x = 0; x < film.width(); ++x) brightest = std::max(brightest, value(x));
  std::vector<double> columns;
  for (int x = 0; x < film.width(); ++x) {
    double sum = 0;
    double moment = 0;
    for (; x < film.width() && value(x) > 0.01 * brightest; ++x) {
      sum += value(x);
      moment += value(x) * (x + 0.5);
    }
    if (sum > 0) columns.push_back(moment / sum);
  }
  return columns;
}

// How far beside the middle of the slit the ray from a column through the middle of the lens arrives, were
// the prism of index `n` [m].
double miss(const Scene& scene, double column, double n) {
  const Ray start =
      sample_ray(scene.camera, {static_cast<float>(column), 0.5F}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0)
          .ray;
  BasicRay<double> ray{V3d(start.origin), V3d(start.direction)};
  for (int event = 0; event < 2; ++event) {
    const auto hit = intersect_exact(scene, ray, 1e-9);
    if (!hit) throw Error(ErrorCode::internal, "miss", "no prism");
    const V3d& normal = hit->hit.normal;
    const bool entering = normal.dot(ray.direction) < 0;
    ray = {hit->hit.point, *refract(-ray.direction, entering ? normal : -normal, entering ? n : 1 / n)};
  }
  const auto& slit = std::get<Quad>(scene.shapes[std::get<AreaLight>(scene.lights[0].kind).shape].shape);
  const V3d middle = slit.corner + (slit.edge_u + slit.edge_v) / 2;
  const V3d normal = slit.edge_u.cross(slit.edge_v);
  const double t = (middle - ray.origin).dot(normal) / ray.direction.dot(normal);
  return (ray.origin + ray.direction * t - middle).dot(slit.edge_u.normalized());
}

// The index that brings a column's ray to the slit.
double index_of(const Scene& scene, double column) {
  double low = 1.6;
  double high = 1.67;
  const bool rises = miss(scene, column, high) > 0;
  for (int i = 0; i < 60; ++i) {
    const double n = (low + high) / 2;
    ((miss(scene, column, n) > 0) == rises ? high : low) = n;
  }
  return (low + high) / 2;
}

// n^2 = a + b lambda^2 + c/lambda^2 + d/lambda^4 by least squares (Schott's formula, cut), lambda in um.
class Dispersion {
 public:
  explicit Dispersion(const std::vector<double>& n) {
    Imath::M44d normal(0.0);
    Imath::V4d right(0.0);
    for (std::size_t i = 0; i < n.size(); ++i) {
      const Imath::V4d terms = powers(kMercury_nm.at(i));
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) normal[row][column] += terms[row] * terms[column];
      right += terms * (n[i] * n[i]);
    }
    coefficients_ = right * normal.gjInverse();
  }
  [[nodiscard]] double operator()(double nm) const { return std::sqrt(coefficients_.dot(powers(nm))); }

 private:
  static Imath::V4d powers(double nm) {
    const double square = nm * nm * 1e-6;
    return {1, square, 1 / square, 1 / (square * square)};
  }
  Imath::V4d coefficients_;
};

TEST(Spectrograph, ItsCalibrationOnMercuryReturnsTheDispersionOfTheGlass) {
  const Scene scene = test::load("spectrograph.json");
  const std::vector<double> columns = line_columns(render(scene, {}).film);
  ASSERT_EQ(columns.size(), kMercury_nm.size());
  Diagnostics diagnostics;
  const auto glass = load_index("F2", {}, diagnostics);
  ASSERT_TRUE(glass) << diagnostics.text();
  const bool blue_left = index_of(scene, columns.front()) > index_of(scene, columns.back());
  std::vector<double> measured;
  double pixel = 0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double column = columns.at(blue_left ? i : columns.size() - 1 - i);
    measured.push_back(index_of(scene, column));
    pixel = std::abs(index_of(scene, column + 1) - measured.back());
    const double n = glass->index.n(kMercury_nm.at(i));
    std::printf("%.4f nm: column %.2f, n = %.6f, off by %.2f pixels\n", kMercury_nm.at(i), column,
                measured.back(), (measured.back() - n) / pixel);
    EXPECT_NEAR(measured.back(), n, 0.3 * pixel) << kMercury_nm.at(i);
  }
  EXPECT_LT(pixel, 3e-5);
  const Dispersion fit(measured);
  for (const double nm : {415.0, 450.0, 480.0, 486.1327, 508.5822, 530.0, 560.0, 587.5618}) {
    const double apart = (fit(nm) - glass->index.n(nm)) / pixel;
    std::printf("%.4f nm: the fit is off by %.2f pixels\n", nm, apart);
    EXPECT_LT(std::abs(apart), 1) << nm;
  }
}

}  // namespace
}  // namespace abbe
