#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "description/checks.h"

namespace abbe::description {
void extend(Support& support, const Curve& curve) {
  const auto knots = curve.knots();
  if (curve.is_constant() && curve.max() != 0) support = {kMinWavelengthNm, kMaxWavelengthNm};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if (knots[i].value == 0 && knots[i + 1].value == 0) continue;
    support.low = std::min(support.low, knots[i].wavelength_nm);
    support.high = std::max(support.high, knots[i + 1].wavelength_nm);
  }
}

void check_validity(const spec::Materials& materials, const LoadContext& context, const Scene& scene) {
  Support sensor;
  for (const Channel& channel : scene.channels) extend(sensor, channel.weight);
  const auto check = [&](const Material& material, const std::string& name, const RefractiveIndex& index) {
    if (index.low_nm() <= sensor.low && sensor.high <= index.high_nm()) return;
    const auto said = std::find_if(materials.begin(), materials.end(),
                                   [&](const auto& named) { return named.name == material.name; });
    context.diagnostics.warning(
        said != materials.end() ? said->where : SourcePosition{},
        fmt::format("{} holds on [{:g}, {:g}] nm, the sensor sees [{:g}, {:g}] nm: outside, the index is "
                    "held from the nearer end",
                    name, index.low_nm(), index.high_nm(), sensor.low, sensor.high));
  };
  for (const Material& material : scene.materials)
    for (const IndexUse& use : indices(material)) check(material, *use.name, *use.index);
}

void check_lamps(const LoadContext& context, const Scene& scene) {
  std::map<const Curve*, bool> seen;  // of each spectrum that lamps share
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const Curve& spectrum = light.emission.base();
    const bool dark = light.emission.max() <= 0;
    if (!seen.contains(&spectrum))
      seen[&spectrum] =
          std::any_of(scene.channels.begin(), scene.channels.end(), [&](const Channel& channel) {
            const Curve exposed = product(spectrum, channel.weight);
            return exposed.max() > 0 || exposed.min() < 0;
          });
    if (!dark && seen[&spectrum]) continue;
    context.diagnostics.error_if_strict(
        context.emissions.at(i),
        fmt::format("\"{}\" emits nothing{}", light.name, dark ? "" : " that the sensor sees"));
  }
}

}  // namespace abbe::description
