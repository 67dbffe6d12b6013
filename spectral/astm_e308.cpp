#include "spectral/astm_e308.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "spectral/curve_use.h"

namespace abbe {
namespace {

/// The first sample that does not fit the wavelengths of the ASTM E308 weights, or nothing.
std::optional<SampleFault> astm_fault(const std::vector<double>& wavelengths_nm) {
  constexpr double kTolerance_nm = 1e-3;
  const double first = wavelengths_nm[0];
  const double step = wavelengths_nm[1] - first;
  if (std::abs(step - 10) > kTolerance_nm && std::abs(step - 20) > kTolerance_nm)
    return SampleFault{1, fmt::format("{:g} nm", step)};
  if (auto fault = step_fault(wavelengths_nm)) return fault;
  if (std::abs(std::remainder(first - kAstmRange.low_nm, step)) > kTolerance_nm)
    return SampleFault{0, fmt::format("{:g} nm from {:g} nm", step, first)};
  return std::nullopt;
}

}  // namespace

TristimulusWeights astm_weights(const Curve& illuminant, Observer observer, int step_nm, SumRange range) {
  const std::vector<XYZ> fine = tristimulus_weights(illuminant, observer, range);
  std::vector<double> nodes;
  for (int nm = range.low_nm; nm <= range.high_nm; nm += step_nm) nodes.push_back(nm);
  TristimulusWeights table{range.low_nm, step_nm, std::vector<XYZ>(nodes.size(), XYZ{})};
  const std::size_t last = nodes.size() - 2;  // interval
  double sum_y = 0;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm) {
    const auto interval = std::min(static_cast<std::size_t>((nm - range.low_nm) / step_nm), last);
    const bool at_an_end = interval == 0 || interval == last;
    const std::size_t first = interval == 0 ? 0 : interval - 1;
    const std::vector<double> lagrange = lagrange_weights(std::span(nodes).subspan(first, at_an_end ? 3 : 4),
                                                          std::min<double>(nm, nodes.back()));
    const XYZ& xyz = fine[static_cast<std::size_t>(nm - range.low_nm)];
    sum_y += xyz[1];
    for (std::size_t i = 0; i < lagrange.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) table.weights[first + i][c] += lagrange[i] * xyz[c];
  }
  for (XYZ& weight : table.weights)
    for (double& value : weight) value *= 100 / sum_y;
  return table;
}

XYZ astm_white(const TristimulusWeights& weights) {
  return astm_tristimulus(weights, {{static_cast<double>(weights.low_nm)}, {1}});
}

XYZ astm_tristimulus(const TristimulusWeights& weights, const Samples& samples) {
  const auto begin = std::lround((samples.wavelengths_nm.front() - weights.low_nm) / weights.step_nm);
  XYZ xyz{};
  for (std::size_t i = 0; i < weights.weights.size(); ++i) {
    const auto row =
        std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(i) - begin, 0, std::ssize(samples.values) - 1);
    for (std::size_t c = 0; c < 3; ++c)
      xyz[c] += weights.weights[i][c] * samples.values[static_cast<std::size_t>(row)];
  }
  return xyz;
}

std::optional<Samples> load_astm_samples(const std::string& name, const SourcePosition& where,
                                         Diagnostics& diagnostics) {
  const auto read = load_samples(kReflectanceUse.folder, name, where, diagnostics);
  if (!read) return std::nullopt;
  const std::vector<double>& nm = read->samples.wavelengths_nm;
  const Curve curve = table_curve(nm, read->samples.values, Outside::clamp);
  if (!check_use(name, read->table.provenance.unit, curve, kReflectanceUse, where, diagnostics))
    return std::nullopt;
  if (const auto fault = astm_fault(nm))
    return diagnostics.refuse(
        read->table.position(fault->row),
        fmt::format("ASTM E308 sums need a reflectance measured every 10 or 20 nm at whole steps "
                    "from {} nm (got {})",
                    kAstmRange.low_nm, fault->text),
        ErrorCode::input);
  Samples within;
  for (std::size_t i = 0; i < nm.size(); ++i) {
    const double whole = std::round(nm[i]);
    if (whole < kAstmRange.low_nm || whole > kAstmRange.high_nm) continue;
    within.wavelengths_nm.push_back(whole);
    within.values.push_back(read->samples.values[i]);
  }
  if (within.values.size() > 1) return within;
  return diagnostics.refuse(
      read->table.where,
      fmt::format("ASTM E308 sums need two samples or more from {} to {} nm (got {} to {} nm)",
                  kAstmRange.low_nm, kAstmRange.high_nm, nm.front(), nm.back()),
      ErrorCode::input);
}

}  // namespace abbe
