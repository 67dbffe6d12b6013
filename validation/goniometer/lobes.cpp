#include "validation/goniometer/lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/poisson.hpp>

#include "sampling/sampler.h"

namespace abbe {
namespace {

// Streams of random numbers. Means use low-discrepancy sequences.
enum class RandomStream : std::uint32_t { cells = 1, counts, albedo, pairs };

class RandomNumbers {
 public:
  RandomNumbers(std::uint64_t seed, RandomStream stream)
      : seed_(seed), stream_(static_cast<std::uint32_t>(stream)) {}

  [[nodiscard]] std::array<float, 4> at(std::uint32_t index, std::uint32_t group = 0) const {
    return Sampler(seed_, Purpose::camera, stream_, 0, index).group(group);
  }
  [[nodiscard]] BsdfRandom event(std::uint32_t index) const {
    const auto u = at(index);
    return {u[2], {u[0], u[1]}};
  }

 private:
  std::uint64_t seed_;
  std::uint32_t stream_;
};

// Independent random numbers. Points of one sequence would fill cells too evenly for a chi-square test, so
// each is the first point of its own sequence.
BsdfRandom independent_event(std::uint64_t seed, RandomStream stream, std::uint32_t index) {
  const auto u = Sampler(seed, Purpose::camera, static_cast<std::uint32_t>(stream), index, 0).group(0);
  return {u[2], {u[0], u[1]}};
}

std::vector<Imath::V3f> non_delta_directions(const LobeSampler& sampler, int hero, int samples,
                                             std::uint64_t seed, RandomStream stream) {
  std::vector<Imath::V3f> directions;
  for (int i = 0; i < samples; ++i) {
    const auto s = sampler(independent_event(seed, stream, static_cast<std::uint32_t>(i)), hero);
    if (s && !s->delta) directions.push_back(s->wi);
  }
  return directions;
}

// Pearson's statistic. Cells with too few expected samples are pooled. If the pool also expects too few, a
// Poisson test replaces its term.
class ChiSquare {
 public:
  explicit ChiSquare(int samples) : unresolved_(kUnresolved * samples) {}

  void add(double counted, double expected) {
    if (expected < kMinExpected) {
      pool_counted_ += counted;
      pool_expected_ += expected;
    } else {
      count(counted, expected);
    }
  }
  double p() {
    const bool rare = pool_expected_ < kMinExpected;
    if (!rare) count(pool_counted_, pool_expected_);
    const double common =
        cells_ < 2 ? 1 : boost::math::cdf(complement(boost::math::chi_squared(cells_ - 1), statistic_));
    if (!rare || pool_counted_ < 1) return common;
    const double smaller_p = std::min(common, rare_p());
    return smaller_p * (2 - smaller_p);  // Šidák correction for two tests
  }

 private:
  static constexpr double kMinExpected = 5;
  // Fraction of all samples that may be missed by the quadrature or by rounding of directions at the edges of
  // a density.
  static constexpr double kUnresolved = 1e-6;

  // Probability of at least the counted number of samples.
  [[nodiscard]] double rare_p() const {
    const boost::math::poisson law(pool_expected_ + unresolved_);
    return boost::math::cdf(complement(law, pool_counted_ - 1));
  }
  void count(double counted, double expected) {
    statistic_ += (counted - expected) * (counted - expected) / expected;
    ++cells_;
  }

  double unresolved_;
  double statistic_ = 0;
  double pool_counted_ = 0;
  double pool_expected_ = 0;
  int cells_ = 0;
};

// A random direction, uniform over the sphere.
Imath::V3f any_direction(const std::array<float, 4>& u) {
  return direction_at(2 * static_cast<double>(u[0]) - 1, 2 * std::numbers::pi * static_cast<double>(u[1]));
}

// Statistics over pairs of directions. The first is random; the second is sampled from the BSDF or random in
// turn.
template <typename Forward, typename Backward>
Asymmetry asymmetry(const Bsdf& bsdf, int pairs, std::uint64_t seed, Forward forward, Backward backward) {
  const RandomNumbers numbers(seed, RandomStream::pairs);
  double largest = 0;
  double differences = 0;
  double values = 0;
  for (int i = 0; i < pairs; ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const Imath::V3f a = any_direction(numbers.at(index, 1));
    Imath::V3f b = any_direction(numbers.at(index, 2));
    if (i % 2 == 0) {
      const auto s = sample(bsdf, a, numbers.event(index), i / 2 % kLanes, TransportMode::power);
      if (!s || s->delta) continue;
      b = s->wi;
    }
    const SampledSpectrum forward_value = forward(a, b);
    const SampledSpectrum backward_value = backward(a, b);
    for (int j = 0; j < kLanes; ++j) {
      const double f = forward_value[j];
      const double g = backward_value[j];
      if (!(std::max(f, g) > 0)) continue;
      largest = std::max(largest, std::abs(f - g) / std::max(f, g));
      differences += std::abs(f - g);
      values += (f + g) / 2;
    }
  }
  return {largest, values > 0 ? differences / values : 0};
}

}  // namespace

LobeSampler sampler_of(const Bsdf& bsdf, const Imath::V3f& wo, TransportMode mode) {
  return [bsdf, wo, mode](const BsdfRandom& u, int hero) { return sample(bsdf, wo, u, hero, mode); };
}

DensityCheck check_density(const LobeSampler& sampler, const SphereDensity& density, int hero, int samples,
                           std::uint64_t seed) {
  constexpr std::size_t kCells = 400;
  const std::vector<Imath::V3f> pilot_directions =
      non_delta_directions(sampler, hero, samples / 2, seed, RandomStream::cells);
  const SphereCells cells(pilot_directions, std::max<std::size_t>(pilot_directions.size() / kCells, 10));
  const std::vector<Imath::V3f> drawn =
      non_delta_directions(sampler, hero, samples, seed, RandomStream::counts);
  std::vector<double> counted(cells.count(), 0.0);
  for (const Imath::V3f& wi : drawn) counted[cells.cell_of(wi)] += 1;
  const double remaining = samples - static_cast<double>(drawn.size());
  const std::vector<double> expected = cells.integrate(density, drawn);
  ChiSquare chi_square(samples);
  double integral = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    chi_square.add(counted[i], expected[i] * samples);
    integral += expected[i];
  }
  chi_square.add(remaining, std::max(0.0, 1 - integral) * samples);
  return {chi_square.p(), integral};
}

Estimate estimate(const Replicates& replicates) {
  double mean = replicates[0];  // exact if all are equal
  for (const double r : replicates) mean += (r - replicates[0]) / kReplicates;
  double squares = 0;
  for (const double r : replicates) squares += (r - mean) * (r - mean);
  return {mean, std::sqrt(squares / (kReplicates * (kReplicates - 1)))};
}

AlbedoReplicates albedo_replicates(const LobeSampler& sampler, const Imath::V3f& wo, int samples,
                                   std::uint64_t seed) {
  AlbedoReplicates sums{};
  const int each = std::max(samples / static_cast<int>(kReplicates), 1);
  for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
    const RandomNumbers numbers(seed * kReplicates + replicate, RandomStream::albedo);
    for (int i = 0; i < each; ++i)
      for (int hero = 0; hero < kLanes; ++hero) {
        const auto s = sampler(numbers.event(static_cast<std::uint32_t>(i)), hero);
        if (!s) continue;
        auto& side = s->wi.z * wo.z < 0 ? sums.transmitted : sums.reflected;
        const double balance = static_cast<double>(s->lane_pdf.sum()) * each;
        for (int j = 0; j < kLanes; ++j)
          side[static_cast<std::size_t>(j)][replicate] += static_cast<double>(s->weight[j]) / balance;
      }
  }
  return sums;
}

std::vector<BsdfSample> delta_events(const Bsdf& bsdf, const Imath::V3f& wo, int hero, TransportMode mode) {
  constexpr int kChoices = 64;
  constexpr float kLast = 0x1.fffffep-1F;
  std::vector<BsdfSample> events;
  for (int i = 0; i <= kChoices; ++i) {
    const float lobe = std::min(static_cast<float>(i) / kChoices, kLast);
    const auto s = sample(bsdf, wo, {lobe, {0.5F, 0.5F}}, hero, mode);
    if (!s || !s->delta) continue;
    const bool known = std::ranges::any_of(
        events, [&](const BsdfSample& event) { return event.wi == s->wi && event.pdf == s->pdf; });
    if (!known) events.push_back(*s);
  }
  return events;
}

Asymmetry reciprocity_error(const Bsdf& bsdf, int pairs, std::uint64_t seed) {
  const auto forward = [&](const Imath::V3f& a, const Imath::V3f& b) {
    return eval(bsdf, a, b, TransportMode::power);
  };
  const auto backward = [&](const Imath::V3f& a, const Imath::V3f& b) {
    SampledSpectrum f = eval(bsdf, b, a, TransportMode::power);
    if (a.z * b.z > 0) return f;
    SampledSpectrum::Values scale;
    for (int j = 0; j < kLanes; ++j) {
      const float n = a.z > 0 ? index_inside(bsdf, j) : 1 / index_inside(bsdf, j);
      scale[static_cast<std::size_t>(j)] = n * n;
    }
    return f * SampledSpectrum(scale);
  };
  return asymmetry(bsdf, pairs, seed, forward, backward);
}

Asymmetry adjoint_error(const Bsdf& bsdf, int pairs, std::uint64_t seed) {
  const auto forward = [&](const Imath::V3f& a, const Imath::V3f& b) {
    return eval(bsdf, a, b, TransportMode::radiance);
  };
  const auto backward = [&](const Imath::V3f& a, const Imath::V3f& b) {
    return eval(bsdf, b, a, TransportMode::power);
  };
  return asymmetry(bsdf, pairs, seed, forward, backward);
}

}  // namespace abbe
