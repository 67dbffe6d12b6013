#include "spectral/wavelength_distribution.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace abbe {
namespace {

/// Fraction of the density that is uniform over the support. It bounds every weight if the given curves are
/// incomplete.
constexpr double kUniformFraction = 0.05;

/// Edges closer than this [nm] are merged. It is far below the spacing of float wavelengths and far above
/// that of doubles.
constexpr double kEdgeResolutionNm = 1e-9;

/// Entries of the guide table per cell; more entries shorten the search.
constexpr std::size_t kGuideFineness = 4;

/// Cells with two interior points each, whose mean integrates a product of two lines exactly
/// (Gauss-Legendre).
struct Cells {
  std::vector<double> edges;

  [[nodiscard]] std::size_t count() const { return edges.size() - 1; }
  [[nodiscard]] double width(std::size_t cell) const { return edges[cell + 1] - edges[cell]; }
  [[nodiscard]] std::vector<double> values(const Curve& curve) const {
    static const double kOffset = 0.5 / std::sqrt(3.0);
    std::vector<double> at;
    at.reserve(2 * count());
    for (std::size_t i = 0; i < count(); ++i) {
      at.push_back(std::abs(curve(edges[i] + (0.5 - kOffset) * width(i))));
      at.push_back(std::abs(curve(edges[i] + (0.5 + kOffset) * width(i))));
    }
    return at;
  }
};

Cells cells_of(std::span<const Curve> emissions, std::span<const Curve> responses) {
  std::vector<double> edges;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) edges.push_back(nm);
  for (const auto curves : {emissions, responses})
    for (const Curve& curve : curves)
      for (const Knot& knot : curve.knots()) edges.push_back(knot.wavelength_nm);
  std::sort(edges.begin(), edges.end());
  const auto same = [](double a, double b) { return b - a < kEdgeResolutionNm; };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  return {std::move(edges)};
}

/// Normalises `density` to an integral of 1 over the cells. Returns false if it is zero everywhere.
bool normalize(const Cells& cells, std::vector<double>& density) {
  double total = 0;
  for (std::size_t i = 0; i < density.size(); ++i) total += density[i] * cells.width(i);
  if (!(total > 0)) return false;
  for (double& d : density) d /= total;
  return true;
}

bool same_shape(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kTolerance = 1e-9;
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double x, double y) { return std::abs(x - y) <= kTolerance * std::max(x, y); });
}

/// Normalised densities |emission x response| of all (light, channel) pairs, without duplicates. A hundred
/// equal lights must not outweigh the single one of another kind.
std::vector<std::vector<double>> pair_densities(const Cells& cells, std::span<const Curve> emissions,
                                                const std::vector<std::vector<double>>& responses) {
  std::vector<std::vector<double>> pairs;
  std::vector<double> density(cells.count());
  for (const Curve& emission : emissions) {
    const std::vector<double> light = cells.values(emission);
    for (const std::vector<double>& channel : responses) {
      for (std::size_t i = 0; i < density.size(); ++i)
        density[i] = 0.5 * (light[2 * i] * channel[2 * i] + light[2 * i + 1] * channel[2 * i + 1]);
      const auto known = [&density](const std::vector<double>& pair) { return same_shape(pair, density); };
      if (normalize(cells, density) && std::none_of(pairs.begin(), pairs.end(), known))
        pairs.push_back(density);
    }
  }
  return pairs;
}

/// 1 in cells where some channel responds, or everywhere if none does.
std::vector<double> support_of(const Cells& cells, const std::vector<std::vector<double>>& responses) {
  std::vector<double> support(cells.count());
  for (const std::vector<double>& channel : responses)
    for (std::size_t i = 0; i < support.size(); ++i)
      if (channel[2 * i] + channel[2 * i + 1] > 0) support[i] = 1;
  if (std::ranges::count(support, 1.0) == 0) std::ranges::fill(support, 1.0);
  return support;
}

/// Smallest float that is not below `wavelength_nm`.
float float_from(double wavelength_nm) {
  const auto value = static_cast<float>(wavelength_nm);
  const bool below = static_cast<double>(value) < wavelength_nm;
  return below ? std::nextafter(value, std::numeric_limits<float>::max()) : value;
}

SampledSpectrum larger(const SampledSpectrum& a, const SampledSpectrum& b) {
  return SampledSpectrum::map(a, b, [](float x, float y) { return x > y ? x : y; });
}
SampledSpectrum smaller(const SampledSpectrum& a, const SampledSpectrum& b) {
  return SampledSpectrum::map(a, b, [](float x, float y) { return x < y ? x : y; });
}

}  // namespace

WavelengthDistribution::WavelengthDistribution(std::span<const Curve> emissions,
                                               std::span<const Curve> responses) {
  Cells cells = cells_of(emissions, responses);
  std::vector<std::vector<double>> channels;
  for (const Curve& response : responses) channels.push_back(cells.values(response));

  std::vector<double> mixture(cells.count());
  for (const std::vector<double>& pair : pair_densities(cells, emissions, channels))
    for (std::size_t i = 0; i < mixture.size(); ++i) mixture[i] += pair[i];
  std::vector<double> support = support_of(cells, channels);
  const bool overlap = normalize(cells, mixture);
  normalize(cells, support);

  const auto first = static_cast<std::size_t>(
      std::find_if(support.begin(), support.end(), [](double s) { return s > 0; }) - support.begin());
  std::size_t last = support.size();
  while (!(support[last - 1] > 0)) --last;
  const double uniform_fraction = overlap ? kUniformFraction : 1;
  double cdf = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double density = (1 - uniform_fraction) * mixture[i] + uniform_fraction * support[i];
    cells_.push_back({cells.edges[i], cdf, density, density > 0 ? 1 / density : 0});
    cdf += density * cells.width(i);
  }
  cells_.push_back({cells.edges[last], 1, 0, 0});
  prepare_to_sample();
}

void WavelengthDistribution::prepare_to_sample() {
  for (std::size_t i = 0; i + 1 < cells_.size(); ++i)
    float_cells_.push_back({float_from(cells_[i].low_nm),
                            std::nextafter(float_from(cells_[i + 1].low_nm), 0.0F),
                            static_cast<float>(cells_[i].density)});
  const std::size_t size = kGuideFineness * (cells_.size() - 1);
  std::size_t cell = 0;
  for (std::size_t i = 0; i < size; ++i) {
    while (cells_[cell + 1].cdf * static_cast<double>(size) <= static_cast<double>(i)) ++cell;
    guide_.push_back(static_cast<std::uint32_t>(cell));
  }
}

WavelengthDistribution WavelengthDistribution::weighted(std::span<const double> importance) const {
  const auto parts = static_cast<double>(importance.size());
  std::vector<double> sums{0};
  for (const double part : importance) sums.push_back(sums.back() + part);
  const auto cdf_at = [&](double cdf) {
    const auto part = std::min(static_cast<std::size_t>(cdf * parts), importance.size() - 1);
    return (sums[part] + (cdf * parts - static_cast<double>(part)) * importance[part]) / sums.back();
  };
  WavelengthDistribution weighted;
  for (std::size_t i = 0; i + 1 < cells_.size(); ++i) {
    const double cdf = cdf_at(cells_[i].cdf);
    const double density = (cdf_at(cells_[i + 1].cdf) - cdf) / (cells_[i + 1].low_nm - cells_[i].low_nm);
    weighted.cells_.push_back({cells_[i].low_nm, cdf, density, density > 0 ? 1 / density : 0});
  }
  weighted.cells_.push_back({cells_.back().low_nm, 1, 0, 0});
  weighted.prepare_to_sample();
  return weighted;
}

// Separate loops, so that all but the look-ups operate on whole vectors.
SampledWavelengths WavelengthDistribution::sample(float u) const {
  LaneValues v;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    v[lane] = static_cast<double>(u) + static_cast<double>(lane) / kLanes;
  for (double& x : v) x = x >= 1 ? x - 1 : x;
  const std::array<std::uint32_t, kLanes> cell = cells_at(v);
  SampledSpectrum::Values lambda_nm;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Cell& in = cells_[cell[lane]];
    lambda_nm[lane] = static_cast<float>(in.low_nm + (v[lane] - in.cdf) * in.nm_per_cdf);
  }
  SampledSpectrum::Values lowest;
  SampledSpectrum::Values highest;
  SampledSpectrum::Values pdf;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const FloatCell& in = float_cells_[cell[lane]];
    lowest[lane] = in.min_nm;
    highest[lane] = in.max_nm;
    pdf[lane] = in.density;
  }
  const SampledSpectrum from = larger(SampledSpectrum(lambda_nm), SampledSpectrum(lowest));
  return {smaller(from, SampledSpectrum(highest)), SampledSpectrum(pdf)};
}

// The guide table gives the cell or one shortly before it. The first step from there is unpredictable, so it
// is taken without a branch.
std::array<std::uint32_t, kLanes> WavelengthDistribution::cells_at(const LaneValues& cdf) const {
  const auto size = static_cast<double>(guide_.size());
  std::array<std::int32_t, kLanes> entry;
  for (std::size_t lane = 0; lane < kLanes; ++lane) entry[lane] = static_cast<std::int32_t>(cdf[lane] * size);
  std::array<std::uint32_t, kLanes> cell;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::uint32_t at = guide_[static_cast<std::uint32_t>(entry[lane])];
    at += cells_[at + 1].cdf <= cdf[lane] ? 1U : 0U;
    while (cells_[at + 1].cdf <= cdf[lane]) ++at;
    cell[lane] = at;
  }
  return cell;
}

double WavelengthDistribution::pdf(double wavelength_nm) const {
  if (!(wavelength_nm >= low_nm() && wavelength_nm < high_nm())) return 0;
  const auto above = std::upper_bound(cells_.begin(), cells_.end(), wavelength_nm,
                                      [](double nm, const Cell& cell) { return nm < cell.low_nm; });
  return std::prev(above)->density;
}

}  // namespace abbe
