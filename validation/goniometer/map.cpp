#include "validation/goniometer/map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "materials/bsdf/warp.h"
#include "report/display_color.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr int kDisc = 96;  // edge of a disc [pixels]

// BSDFs at packets of the visible wavelengths, with the contribution of each wavelength to XYZ.
class ObserverColor {
 public:
  ObserverColor(const Material& material, const GoniometerSettings& settings)
      : weights_(tristimulus_weights(settings.illuminant, settings.observer)) {
    const std::vector<double> visible = visible_wavelengths();
    for (std::size_t first = 0; first < visible.size(); first += kLanes)
      models_.push_back(make_bsdf(material, {packet_of(visible, first)}));
    for (const XYZ& weight : weights_)
      for (std::size_t k = 0; k < 3; ++k) white_[k] += weight[k];
  }

  // Colour of f cos relative to the display's white.
  [[nodiscard]] LinearRgb rgb(const Imath::V3f& wo, const Imath::V3f& wi) const {
    XYZ xyz{};
    for (std::size_t p = 0; p < models_.size(); ++p) {
      const SampledSpectrum f = eval(models_[p], wo, wi, TransportMode::power) * std::abs(wi.z);
      for (std::size_t j = 0; j < kLanes && p * kLanes + j < weights_.size(); ++j)
        for (std::size_t k = 0; k < 3; ++k)
          xyz[k] += static_cast<double>(f[static_cast<int>(j)]) * weights_[p * kLanes + j][k];
    }
    const XYZ display_white = unit_xyz(kD65);
    for (std::size_t k = 0; k < 3; ++k) xyz[k] *= display_white[k] / white_[k];
    return linear_rgb_of_xyz(xyz);
  }

 private:
  std::vector<Bsdf> models_;
  std::vector<XYZ> weights_;
  XYZ white_{};
};

// Direction of a point of an equal-area disc, with x and y in [-1, 1]; empty outside the disc.
std::optional<Imath::V3f> from_disc(double x, double y, bool above) {
  const double r2 = x * x + y * y;
  if (r2 >= 1) return std::nullopt;
  return direction_at(above ? 1 - r2 : r2 - 1, std::atan2(y, x));
}

// Colours of two discs, one above the other, in row order.
std::vector<LinearRgb> column(const ObserverColor& observer_color, const Imath::V3f& wo) {
  std::vector<LinearRgb> colors;
  for (int y = 0; y < 2 * kDisc; ++y)
    for (int x = 0; x < kDisc; ++x) {
      const bool same_side = y < kDisc;
      const auto wi =
          from_disc(2 * (x + 0.5) / kDisc - 1, 1 - 2 * (y % kDisc + 0.5) / kDisc, same_side == (wo.z > 0));
      colors.push_back(wi ? observer_color.rgb(wo, *wi) : LinearRgb{});
    }
  return colors;
}

}  // namespace

Image lobe_map(const Material& material, const GoniometerSettings& settings) {
  const ObserverColor observer_color(material, settings);
  const int columns = static_cast<int>(settings.angles_deg.size());
  Image map{columns * kDisc, 2 * kDisc, {}, {}};
  for (const char* name : {"R", "G", "B"})
    map.channels.push_back({name, std::vector<float>(map.pixels(), 0.0F)});
  for (int i = 0; i < columns; ++i) {
    const std::vector<LinearRgb> colors =
        column(observer_color, incidence(settings, settings.angles_deg[static_cast<std::size_t>(i)]));
    double max_channel = 0;
    for (const LinearRgb& color : colors) max_channel = std::max({max_channel, color[0], color[1], color[2]});
    for (std::size_t pixel = 0; max_channel > 0 && pixel < colors.size(); ++pixel) {
      LinearRgb color = colors[pixel];
      for (double& v : color) v /= max_channel;
      const DisplayColor code = display_code(color);
      const std::size_t at = pixel / kDisc * static_cast<std::size_t>(map.width) +
                             static_cast<std::size_t>(i) * kDisc + pixel % kDisc;
      for (std::size_t k = 0; k < 3; ++k) map.channels[k].values[at] = static_cast<float>(code[k]);
    }
  }
  return map;
}

}  // namespace abbe
