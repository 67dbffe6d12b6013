// Coherent layers against closed forms, conservation laws and the textbook matrices in 128 bits.
#include "materials/interface/thin_film.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_complex.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace abbe {
namespace {

using Layers = std::vector<FilmLayer<double>>;

FresnelPower<double> stack(double cos_i, const Layers& layers, double eta, double k = 0) {
  return film_power<double>(cos_i, layers, eta, k);
}
// A layer of `quarters` quarter waves at normal incidence from air.
FilmLayer<double> quarter(double n, double quarters = 1) {
  return {n, 0, quarters / (4 * n)};
}
double power(double r) {
  return r * r;
}
Layers reversed(const Layers& layers, double n_i, double n_t) {
  Layers back(layers.rbegin(), layers.rend());
  for (FilmLayer<double>& layer : back) {
    layer.eta *= n_i / n_t;
    layer.k *= n_i / n_t;
    layer.thickness *= n_t / n_i;
  }
  return back;
}
double cosine_inside(double cos_i, double eta) {
  return refracted_cosine(cos_i, eta);
}

constexpr double kExact = 1e-9;

TEST(ThinFilm, QuarterWaveMatchesItsClosedForm) {
  for (const double n_i : {1.0, 1.33}) {
    for (const double n_1 : {1.22, 1.38, 2.35, 0.7}) {
      for (const double n_s : {1.52, 1.9, 1.0}) {
        const FresnelPower<double> f = stack(1, {{n_1 / n_i, 0, n_i / (4 * n_1)}}, n_s / n_i);
        EXPECT_NEAR(f.Rs, power((n_i * n_s - n_1 * n_1) / (n_i * n_s + n_1 * n_1)), kExact);
        EXPECT_NEAR(f.Rp, f.Rs, kExact);
      }
    }
  }
  EXPECT_NEAR(stack(1, {quarter(std::sqrt(1.52))}, 1.52).R(), 0, 1e-30) << "the perfect coat";
}

TEST(ThinFilm, HalfWavesAreAbsent) {
  for (const double cos_i : {1.0, 0.8}) {
    const double n = 2.1;
    const double inside = cosine_inside(cos_i, n);
    const FilmLayer<double> absent{n, 0, 3 / (2 * n * inside)};
    const FresnelPower<double> bare = fresnel_dielectric(cos_i, 1.52);
    const FresnelPower<double> f = stack(cos_i, {absent}, 1.52);
    EXPECT_NEAR(f.Rs, bare.Rs, kExact);
    EXPECT_NEAR(f.Rp, bare.Rp, kExact);
    EXPECT_NEAR(f.Ts, bare.Ts, kExact);
    EXPECT_NEAR(f.Tp, bare.Tp, kExact);
  }
}

TEST(ThinFilm, QuarterWaveStacksMatchTheirClosedForm) {
  constexpr double kH = 2.35, kL = 1.38, kGlass = 1.52;
  Layers mirror;
  for (int pairs = 1; pairs <= 12; ++pairs) {
    mirror.push_back(quarter(kH));
    mirror.push_back(quarter(kL));
    const double y = std::pow(kH / kL, 2 * pairs) * kGlass;  // admittance of (HL)^N on glass
    EXPECT_NEAR(stack(1, mirror, kGlass).R(), power((1 - y) / (1 + y)), kExact) << pairs;
    Layers odd = mirror;  // (HL)^N H
    odd.push_back(quarter(kH));
    const double z = std::pow(kH / kL, 2 * pairs) * kH * kH / kGlass;
    EXPECT_NEAR(stack(1, odd, kGlass).R(), power((1 - z) / (1 + z)), kExact) << pairs;
    EXPECT_NEAR(stack(1, odd, kGlass).transmitted(), 4 * z / power(1 + z), kExact) << pairs;
  }
}

// A half wave between two equal mirrors opens a pass band: its center transmits everything, whatever the
// mirrors.
TEST(ThinFilm, BandpassOpensAtItsMiddle) {
  Layers filter;
  for (int i = 0; i < 6; ++i) filter.insert(filter.end(), {quarter(2.35), quarter(1.38)});
  filter.push_back(quarter(2.35, 2));
  for (int i = 0; i < 6; ++i) filter.insert(filter.end(), {quarter(1.38), quarter(2.35)});
  EXPECT_NEAR(stack(1, filter, 1).transmitted(), 1, kExact);
  for (FilmLayer<double>& layer : filter) layer.thickness *= 1.02;
  EXPECT_LT(stack(1, filter, 1).transmitted(), 1e-3);
}

TEST(ThinFilm, WithoutLayersOrThicknessIsTheBareInterface) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(0.01, 1);
  for (int i = 0; i < 2000; ++i) {
    const double cos_i = u(rng), eta = 0.4 + 2 * u(rng), k = i % 2 ? 5 * u(rng) : 0;
    const auto bare = k > 0 ? fresnel_conductor(cos_i, eta, k) : fresnel_dielectric(cos_i, eta);
    for (const Layers& layers : {Layers{}, Layers{{1.7, 0.2, 0}, {0.9, 0, 0}}}) {
      const auto f = stack(cos_i, layers, eta, k);
      EXPECT_NEAR(f.Rs, bare.Rs, 1e-12);
      EXPECT_NEAR(f.Rp, bare.Rp, 1e-12);
      EXPECT_NEAR(f.Ts, bare.Ts, 1e-12);
      EXPECT_NEAR(f.Tp, bare.Tp, 1e-12);
      EXPECT_NEAR(f.cos_t, bare.cos_t, 1e-15);
    }
  }
}

// A layer with the index of the substrate or of the first medium has no effect, even at Brewster's angle.
TEST(ThinFilm, BrewstersAngleReflectsNoP) {
  const double n = 1.5;
  const double cos_b = 1 / std::sqrt(1 + n * n);
  EXPECT_NEAR(stack(cos_b, {{n, 0, 0.37}}, n).Rp, 0, kExact);
  EXPECT_NEAR(stack(cos_b, {{1, 0, 0.37}}, n).Rp, 0, kExact);
  EXPECT_NEAR(stack(cos_b, {{n, 0, 0.37}}, n).Rs, fresnel_dielectric(cos_b, n).Rs, kExact);
}

TEST(ThinFilm, TotalReflectionStaysTotal) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double eta = 0.66;
    const double cos_i = std::sqrt(1 - eta * eta) * 0.9999 * u(rng);
    Layers layers;
    for (int j = 0; j < i % 5; ++j) layers.push_back({0.5 + u(rng), 0, 3 * u(rng)});
    const auto f = stack(cos_i, layers, eta);
    EXPECT_NEAR(f.Rs, 1, 1e-12);
    EXPECT_NEAR(f.Rp, 1, 1e-12);
    EXPECT_EQ(f.Ts, 0);
    EXPECT_EQ(f.Tp, 0);
    EXPECT_EQ(f.cos_t, 0);
  }
  // Light tunnels through an air gap thinner than the wavelength, more for thinner gaps.
  double before = 1;
  for (const double gap : {0.01, 0.1, 0.3, 1.0, 3.0}) {
    const auto f = stack(0.5, {{1 / 1.5, 0, gap}}, 1);
    EXPECT_LT(f.transmitted(), before);
    EXPECT_GT(f.transmitted(), 0);
    EXPECT_NEAR(f.R() + f.transmitted(), 1, 1e-12);
    before = f.transmitted();
  }
}

TEST(ThinFilm, LosesOnlyWhatLayersAbsorb) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const bool absorbing = i % 2;
    Layers layers;
    for (int j = 0; j <= i % 9; ++j)
      layers.push_back({0.1 + 3 * u(rng), absorbing ? 4 * u(rng) : 0.0, 2 * u(rng)});
    const double eta = 0.3 + 2 * u(rng), cos_i = u(rng);
    const auto f = stack(cos_i, layers, eta, i % 3 ? 0 : 3 * u(rng));
    for (const double total : {f.Rs + f.Ts, f.Rp + f.Tp}) {
      EXPECT_LE(total, 1 + 1e-12);
      if (!absorbing) {
        EXPECT_NEAR(total, 1, 1e-9);
      }
    }
  }
}

// Stokes: a stack between transparent media transmits equally in both directions, even if it absorbs.
TEST(ThinFilm, TransmitsTheSameBothWays) {
  std::mt19937 rng(9);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double n_t = 1.2 + u(rng), cos_i = 0.02 + 0.98 * u(rng);
    Layers layers;
    for (int j = 0; j <= i % 6; ++j) layers.push_back({0.2 + 2 * u(rng), i % 2 ? u(rng) : 0.0, u(rng)});
    const auto forth = stack(cos_i, layers, n_t);
    const auto back = stack(forth.cos_t, reversed(layers, 1, n_t), 1 / n_t);
    EXPECT_NEAR(forth.Ts, back.Ts, 1e-10);
    EXPECT_NEAR(forth.Tp, back.Tp, 1e-10);
    if (i % 2 == 0) {
      EXPECT_NEAR(forth.Rs, back.Rs, 1e-10);
    }
  }
}

TEST(ThinFilm, ThickMetalIsOpaqueAndHidesItsSubstrate) {
  for (const double cos_i : {1.0, 0.5, 0.05}) {
    const auto metal = fresnel_conductor(cos_i, 0.9, 6.7);
    for (const double thickness : {100.0, 1e6}) {
      const auto f = stack(cos_i, {{0.9, 6.7, thickness}}, 1.5);
      EXPECT_NEAR(f.Rs, metal.Rs, 1e-12);
      EXPECT_NEAR(f.Rp, metal.Rp, 1e-12);
      EXPECT_EQ(f.transmitted(), 0);
    }
  }
  Layers opaque;  // 400 layers whose fields would overflow float
  std::vector<FilmLayer<float>> in_float;
  for (int i = 0; i < 400; ++i) {
    opaque.push_back(quarter(i % 2 ? 1.38 : 4));
    in_float.push_back({i % 2 ? 1.38F : 4.0F, 0, static_cast<float>(opaque.back().thickness)});
  }
  EXPECT_NEAR(stack(1, opaque, 1.5).R(), 1, 1e-12);
  EXPECT_NEAR((film_power<float>(1, in_float, 1.5F, 0).R()), 1, 1e-6);
}

TEST(ThinFilm, NothingEntersASubstrateOfIndexZero) {
  for (const Layers& layers : {Layers{}, Layers{quarter(1.5)}, Layers{quarter(2.4, 0.3), quarter(1.4, 7)}})
    for (const double cos_i : {1e-4, 0.3, 0.9, 1.0}) {
      const FresnelPower<double> f = stack(cos_i, layers, 0);
      EXPECT_NEAR(f.Rs, 1, kExact) << cos_i;
      EXPECT_NEAR(f.Rp, 1, kExact) << cos_i;
      EXPECT_EQ(f.Ts, 0);
      EXPECT_EQ(f.Tp, 0);
      const FresnelPower<double> nearly = stack(cos_i, layers, 1e-9);
      EXPECT_NEAR(nearly.Rp, f.Rp, 1e-6);
    }
  const FresnelPower<double> absorbing = stack(0.7, {{1.5, 0.1, 0.5}}, 0);
  EXPECT_GT(absorbing.Rp, 0);
  EXPECT_LT(absorbing.Rp, 1);
}

TEST(ThinFilm, HoldsAtTheCriticalAngleOfALayer) {
  const double eta = 0.8;
  const double cos_i = std::sqrt(1 - eta * eta);
  const auto at = stack(cos_i, {{eta, 0, 0.4}}, 1);
  const auto beside = stack(cos_i * (1 + 1e-9), {{eta, 0, 0.4}}, 1);
  EXPECT_NEAR(at.Rs, beside.Rs, 1e-7);
  EXPECT_NEAR(at.Rp, beside.Rp, 1e-7);
  EXPECT_NEAR(at.Rs + at.Ts, 1, 1e-12);
  EXPECT_GT(at.Ts, 0.1);
  const auto grazing =
      stack(0, {{1, 0, 0.4}}, 1.5);  // the wave in the layer has no component along the normal
  EXPECT_EQ(grazing.Rs, 1);
  EXPECT_EQ(grazing.Rp, 1);
  EXPECT_EQ(grazing.transmitted(), 0);
}

using Wide = boost::multiprecision::cpp_complex_quad;
using Quad = Wide::value_type;

// The textbook method: fields E, H of each polarisation through [[cos d, -i sin d/Y], [-i Y sin d, cos d]].
FresnelPower<Quad> textbook(const Quad& cos_i, const Layers& layers, const Quad& eta, const Quad& k) {
  const Quad sin2 = 1 - cos_i * cos_i;
  const auto normal = [&](const Wide& n) {
    Wide q = sqrt(n * n - Wide(sin2));
    return q.imag() < 0 ? Wide(-q) : q;
  };
  const auto solve = [&](bool p) {
    const auto admittance = [&](const Wide& n) { return p ? Wide(n * n / normal(n)) : normal(n); };
    const Wide substrate(eta, k);
    Wide e(1), h = admittance(substrate);
    for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
      const Wide n(Quad(layer->eta), Quad(layer->k));
      const Wide d = Wide(2 * boost::math::constants::pi<Quad>() * Quad(layer->thickness)) * normal(n);
      const Wide i(0, 1);
      const Wide y = admittance(n);
      const Wide next = cos(d) * e - i * sin(d) / y * h;
      h = cos(d) * h - i * y * sin(d) * e;
      e = next;
    }
    const Wide y0 = p ? Wide(1 / cos_i) : Wide(cos_i);
    const Wide r = (y0 * e - h) / (y0 * e + h);
    const Wide t = Wide(2) * y0 / (y0 * e + h);
    return std::pair<Quad, Quad>(norm(r), norm(t) * admittance(substrate).real() / y0.real());
  };
  const auto s = solve(false);
  const auto p = solve(true);
  return {s.first, p.first, s.second, p.second, 0};
}

template <typename T>
void compare_with_textbook(int count, double tolerance) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> u(0, 1);
  const auto rounded = [](double x) { return static_cast<double>(static_cast<T>(x)); };
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) {
    Layers layers;
    std::vector<FilmLayer<T>> own;
    for (int j = 0; j < i % 12; ++j) {
      layers.push_back(
          {rounded(0.3 + 3 * u(rng)), rounded(j % 3 == 1 ? 3 * u(rng) : 0), rounded(0.6 * u(rng))});
      own.push_back({static_cast<T>(layers.back().eta), static_cast<T>(layers.back().k),
                     static_cast<T>(layers.back().thickness)});
    }
    const double eta = rounded(0.4 + 2 * u(rng)), k = rounded(i % 2 ? 6 * u(rng) : 0);
    const double cos_i = rounded(i % 5 ? u(rng) : std::pow(10, -4 * u(rng)));
    const auto exact = textbook(cos_i, layers, eta, k);
    const auto f = film_power<T>(static_cast<T>(cos_i), own, static_cast<T>(eta), static_cast<T>(k));
    const auto near = [&](T got, const Quad& wanted) {
      ASSERT_NEAR(double(got), wanted.convert_to<double>(), tolerance)
          << i << " cos " << cos_i << " eta " << eta;
    };
    near(f.Rs, exact.Rs);
    near(f.Rp, exact.Rp);
    near(f.Ts, exact.Ts);
    near(f.Tp, exact.Tp);
  }
}

TEST(ThinFilm, AgreesWithTheTextbookIn128Bits) {
  compare_with_textbook<double>(1500, 1e-9);
}

TEST(ThinFilm, FloatKeepsWhatAPictureNeeds) {
  compare_with_textbook<float>(1000, 1e-3);
}

}  // namespace
}  // namespace abbe
