#include <cmath>

#include <fmt/format.h>

#include "description/sensor.h"
#include "description/values.h"

namespace abbe::description {
namespace {

constexpr Range kStep{0.01, kMaxWavelengthNm - kMinWavelengthNm};
constexpr int kFewest = 2;  // the files tell widths by the distances of centres
constexpr int kMost = 1000;

}  // namespace

std::optional<SpectralBins> read_spectral(const JsonValue& json, const LoadContext& context) {
  ObjectReader reader(json, context.diagnostics);
  const auto from = reader.require_number("from_nm", kWavelength);
  const auto to = reader.require_number("to_nm", kWavelength);
  const auto step = reader.require_number("step_nm", kStep);
  reader.finish();
  if (!from || !to || !step) return std::nullopt;
  const double bins = (*to - *from) / *step;
  if (bins > kFewest - 0.5 && bins < kMost + 0.5 && std::abs(bins - std::round(bins)) < 1e-6)
    return SpectralBins{*from, *step, static_cast<int>(std::round(bins))};
  context.diagnostics.error(
      json.where,
      fmt::format("the bins do not fill the range (got {} of {} nm in [{}, {}] nm, allowed {} to {})", bins,
                  *step, *from, *to, kFewest, kMost));
  return std::nullopt;
}

}  // namespace abbe::description
