#include "validation/goniometer/lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>

#include "sampling/sampler.h"

namespace abbe {
namespace {

// Streams of random numbers; low-discrepancy where means are wanted.
enum class Stream : std::uint32_t { cells = 1, counts, albedo, pairs };

class Numbers {
 public:
  Numbers(std::uint64_t seed, Stream stream) : seed_(seed), stream_(static_cast<std::uint32_t>(stream)) {}

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

// Independent numbers: points of a sequence would fill cells too evenly for chi-square, so each is the first
// of a sequence of its own.
BsdfRandom independent_event(std::uint64_t seed, Stream stream, std::uint32_t index) {
  const auto u = Sampler(seed, Purpose::camera, static_cast<std::uint32_t>(stream), index, 0).group(0);
  return {u[2], {u[0], u[1]}};
}

std::vector<Imath::V3f> spread_directions(const LobeSampler& sampler, int hero, int samples,
                                          std::uint64_t seed, Stream stream) {
  std::vector<Imath::V3f> directions;
  for (int i = 0; i < samples; ++i) {
    const auto s = sampler(independent_event(seed, stream, static_cast<std::uint32_t>(i)), hero);
    if (s && !s->delta) directions.push_back(s->wi);
  }
  return directions;
}

// Pearson's statistic, cells that expect too little counted as one.
class ChiSquare {
 public:
  void add(double counted, double expected) {
    if (expected < kLeastExpected) {
      pool_counted_ += counted;
      pool_expected_ += expected;
    } else {
      count(counted, expected);
    }
  }
  // What cannot happen must not: below this many expected there is nothing to divide by.
  double p() {
    constexpr double kNothing = 1e-3;
    if (pool_expected_ < kNothing && pool_counted_ > 0) return 0;
    if (pool_expected_ >= kNothing) count(pool_counted_, pool_expected_);
    if (cells_ < 2) return 1;
    return boost::math::cdf(complement(boost::math::chi_squared(cells_ - 1), statistic_));
  }

 private:
  static constexpr double kLeastExpected = 5;

  void count(double counted, double expected) {
    statistic_ += (counted - expected) * (counted - expected) / expected;
    ++cells_;
  }

  double statistic_ = 0;
  double pool_counted_ = 0;
  double pool_expected_ = 0;
  int cells_ = 0;
};

// A direction against the surface at random, evenly over both sides.
Imath::V3f any_direction(const std::array<float, 4>& u) {
  return direction_at(2 * static_cast<double>(u[0]) - 1, 2 * std::numbers::pi * static_cast<double>(u[1]));
}

// Over pairs of a random direction and one that it scatters to, or a random one too.
template <typename Forth, typename Back>
Asymmetry asymmetry(const Bsdf& bsdf, int pairs, std::uint64_t seed, Forth forth, Back back) {
  const Numbers numbers(seed, Stream::pairs);
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
    const SampledSpectrum there = forth(a, b);
    const SampledSpectrum here = back(a, b);
    for (int j = 0; j < kLanes; ++j) {
      const double f = there[j];
      const double g = here[j];
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
  const std::vector<Imath::V3f> guides = spread_directions(sampler, hero, samples / 2, seed, Stream::cells);
  const SphereCells cells(guides, std::max<std::size_t>(guides.size() / kCells, 10));
  std::vector<double> counted(cells.count(), 0.0);
  double elsewhere = samples;
  for (const Imath::V3f& wi : spread_directions(sampler, hero, samples, seed, Stream::counts)) {
    counted[cells.of(wi)] += 1;
    elsewhere -= 1;
  }
  const std::vector<double> expected = cells.integrate(density);
  ChiSquare chi_square;
  double integral = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    chi_square.add(counted[i], expected[i] * samples);
    integral += expected[i];
  }
  chi_square.add(elsewhere, std::max(0.0, 1 - integral) * samples);
  return {chi_square.p(), integral};
}

Albedo albedo(const LobeSampler& sampler, const Imath::V3f& wo, int samples, std::uint64_t seed) {
  constexpr int kBatches = 16;  // scrambles of their own, for the standard errors
  std::array<std::array<std::array<double, kBatches>, kLanes>, 2> sums{};
  const int per_batch = std::max(samples / kBatches, 1);
  for (std::size_t batch = 0; batch < kBatches; ++batch) {
    const Numbers numbers(seed * kBatches + batch, Stream::albedo);
    for (int i = 0; i < per_batch; ++i)
      for (int hero = 0; hero < kLanes; ++hero) {
        const auto s = sampler(numbers.event(static_cast<std::uint32_t>(i)), hero);
        if (!s) continue;
        auto& side = sums[s->wi.z * wo.z < 0 ? 1 : 0];
        const double balance = static_cast<double>(s->lane_pdf.sum()) * per_batch;
        for (int j = 0; j < kLanes; ++j)
          side[static_cast<std::size_t>(j)][batch] += static_cast<double>(s->weight[j]) / balance;
      }
  }
  const auto estimate = [](const std::array<double, kBatches>& batches) {
    double mean = 0;
    double squares = 0;
    for (const double b : batches) mean += b / kBatches;
    for (const double b : batches) squares += (b - mean) * (b - mean);
    return Estimate{mean, std::sqrt(squares / (kBatches * (kBatches - 1)))};
  };
  Albedo result{};
  for (std::size_t j = 0; j < kLanes; ++j) {
    result.reflected[j] = estimate(sums[0][j]);
    result.transmitted[j] = estimate(sums[1][j]);
  }
  return result;
}

std::vector<BsdfSample> delta_events(const Bsdf& bsdf, const Imath::V3f& wo, int hero, TransportMode mode) {
  constexpr int kChoices = 64;
  constexpr float kLast = 0x1.fffffep-1F;
  std::vector<BsdfSample> events;
  for (int i = 0; i <= kChoices; ++i) {
    const float lobe = std::min(static_cast<float>(i) / kChoices, kLast);
    const auto s = sample(bsdf, wo, {lobe, {0.5F, 0.5F}}, hero, mode);
    if (!s || !s->delta) continue;
    const bool known = std::any_of(events.begin(), events.end(), [&](const BsdfSample& event) {
      return event.wi == s->wi && event.pdf == s->pdf;
    });
    if (!known) events.push_back(*s);
  }
  return events;
}

Asymmetry reciprocity_error(const Bsdf& bsdf, int pairs, std::uint64_t seed) {
  const auto forth = [&](const Imath::V3f& a, const Imath::V3f& b) {
    return eval(bsdf, a, b, TransportMode::power);
  };
  const auto back = [&](const Imath::V3f& a, const Imath::V3f& b) {
    SampledSpectrum f = eval(bsdf, b, a, TransportMode::power);
    if (a.z * b.z > 0) return f;
    SampledSpectrum::Values scale;
    for (int j = 0; j < kLanes; ++j) {
      const float n = a.z > 0 ? index_inside(bsdf, j) : 1 / index_inside(bsdf, j);
      scale[static_cast<std::size_t>(j)] = n * n;
    }
    return f * SampledSpectrum(scale);
  };
  return asymmetry(bsdf, pairs, seed, forth, back);
}

Asymmetry adjoint_error(const Bsdf& bsdf, int pairs, std::uint64_t seed) {
  const auto forth = [&](const Imath::V3f& a, const Imath::V3f& b) {
    return eval(bsdf, a, b, TransportMode::radiance);
  };
  const auto back = [&](const Imath::V3f& a, const Imath::V3f& b) {
    return eval(bsdf, b, a, TransportMode::power);
  };
  return asymmetry(bsdf, pairs, seed, forth, back);
}

}  // namespace abbe
