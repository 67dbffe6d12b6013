#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "description/checks.h"

namespace abbe::description {
void extend(Support& support, const Curve& curve) {
  const auto knots = curve.knots();
  if (curve.is_constant() && curve.max() != 0) support = {kMinWavelengthNm, kMaxWavelengthNm};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if (knots[i].value == 0 && knots[i + 1].value == 0) continue;
    const double from = knots[i].wavelength_nm;
    const double to = knots[i + 1].wavelength_nm;
    support.low = std::min(support.low, from);
    // A table that is 0 outside drops to 0 at the number after its last row, where its support ends
    // (`table_curve`).
    support.high = std::max(support.high, to > std::nextafter(from, to) ? to : from);
  }
}

void check_validity(const IndexUse& use, const Support& sensor, const SourcePosition& where,
                    Diagnostics& diagnostics) {
  const RefractiveIndex& index = *use.index;
  const DataRange n{index.low_nm(), index.high_nm()};
  const auto& k = index.k_range();
  const bool k_ends_first =
      k && (std::max(sensor.low, n.low_nm) < k->low_nm || k->high_nm < std::min(sensor.high, n.high_nm));
  if (n.low_nm <= sensor.low && sensor.high <= n.high_nm && !k_ends_first) return;
  diagnostics.warning(
      where, fmt::format("{} has data on [{:g}, {:g}] nm{}, but the sensor responds on [{:g}, {:g}] nm: "
                         "outside its data, the index of the nearer end is used",
                         *use.name, n.low_nm, n.high_nm,
                         k_ends_first ? fmt::format(", its k on [{:g}, {:g}] nm", k->low_nm, k->high_nm) : "",
                         sensor.low, sensor.high));
}

namespace {

void check_clear(const Material& material, const Support& sensor, const SourcePosition& where,
                 Diagnostics& diagnostics) {
  for (double nm = sensor.low; nm <= sensor.high; ++nm)
    if (const auto fault = transparency_fault(material, nm)) return diagnostics.error(where, *fault);
}

}  // namespace

void check_validity(const spec::Materials& materials, const LoadContext& context, const Scene& scene) {
  Support sensor;
  for (const Channel& channel : scene.channels) extend(sensor, envelope(channel));
  for (const Material& material : scene.materials) {
    const auto spec = std::find_if(materials.begin(), materials.end(),
                                   [&](const auto& named) { return named.name == material.name; });
    const SourcePosition where = spec != materials.end() ? spec->where : SourcePosition{};
    for (const IndexUse& use : indices(material)) check_validity(use, sensor, where, context.diagnostics);
    check_clear(material, sensor, where, context.diagnostics);
  }
}

void check_lights(const LoadContext& context, const Scene& scene) {
  std::map<const Curve*, bool> visible;  // For each spectrum, which several lights may have.
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const Curve& spectrum = light.emission.base();
    const bool dark = light.emission.max() <= 0;
    if (!visible.contains(&spectrum))
      visible[&spectrum] =
          std::any_of(scene.channels.begin(), scene.channels.end(), [&](const Channel& channel) {
            const Curve exposed = product(spectrum, envelope(channel));
            return exposed.max() > 0 || exposed.min() < 0;
          });
    if (!dark && visible[&spectrum]) continue;
    context.diagnostics.error_if_strict(
        context.emission_positions.at(i),
        fmt::format("\"{}\" emits nothing{}", light.name, dark ? "" : " that the sensor records"));
  }
}

}  // namespace abbe::description
