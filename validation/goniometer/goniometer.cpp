#include "validation/goniometer/goniometer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "materials/bsdf/warp.h"
#include "report/display_color.h"
#include "report/svg.h"
#include "sampling/angle.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

// Unit direction towards the incident beam's source, in the local frame whose z is the normal. Its azimuth
// is that of -x; z is negative if the beam arrives from inside.
Imath::V3f incidence(const GoniometerSettings& settings, double angle_deg) {
  const double cosine = std::cos(angle_deg * std::numbers::pi / 180);
  return direction_at(settings.from_inside ? -cosine : cosine, std::numbers::pi);
}

// The eight wavelengths from index `first` on. The last wavelength fills an incomplete packet. There must be
// at least one.
SampledSpectrum packet_of(const std::vector<double>& wavelengths_nm, std::size_t first) {
  SampledSpectrum::Values packet;
  for (std::size_t j = 0; j < kLanes; ++j)
    packet[j] = static_cast<float>(wavelengths_nm[std::min(first + j, wavelengths_nm.size() - 1)]);
  return SampledSpectrum(packet);
}

// Albedo of a material with delta events only, which needs no sampling.
AlbedoReplicates exact_albedo(const Bsdf& bsdf, const Imath::V3f& wo) {
  AlbedoReplicates all{};
  for (int lane = 0; lane < kLanes; ++lane)
    for (const BsdfSample& event : delta_events(bsdf, wo, lane, TransportMode::power)) {
      auto& side = event.transmitted ? all.transmitted : all.reflected;
      for (double& replicate : side[static_cast<std::size_t>(lane)])
        replicate += static_cast<double>(event.pdf * event.weight[lane]);
    }
  return all;
}

// Reflectance and transmittance at many wavelengths. Each packet uses its own random numbers, so that errors
// average out over wavelengths.
struct Spectra {
  std::vector<Replicates> reflected, transmitted;
};
Spectra spectra(const Material& material, const std::vector<double>& wavelengths_nm, const Imath::V3f& wo,
                int samples) {
  Spectra all;
  for (std::size_t first = 0; first < wavelengths_nm.size(); first += kLanes) {
    const SampledSpectrum packet = packet_of(wavelengths_nm, first);
    const Bsdf bsdf = make_bsdf(material, {packet});
    const AlbedoReplicates part =
        scatters(bsdf)
            ? albedo_replicates(sampler_of(bsdf, wo, TransportMode::power), wo, samples, first / kLanes)
            : exact_albedo(bsdf, wo);
    for (std::size_t j = 0; j < kLanes && first + j < wavelengths_nm.size(); ++j) {
      all.reflected.push_back(part.reflected[j]);
      all.transmitted.push_back(part.transmitted[j]);
    }
  }
  return all;
}

std::vector<Estimate> estimates(const std::vector<Replicates>& spectrum) {
  std::vector<Estimate> all;
  for (const Replicates& at : spectrum) all.push_back(estimate(at));
  return all;
}

// Standard error of Y from the Y of each replicate.
double standard_error_of_Y(const std::vector<Replicates>& visible, const GoniometerSettings& settings) {
  const std::vector<XYZ> weights = tristimulus_weights(settings.illuminant, settings.observer);
  double white = 0;
  for (const XYZ& weight : weights) white += weight[1];
  Replicates Y{};
  for (std::size_t i = 0; i < visible.size(); ++i)
    for (std::size_t r = 0; r < kReplicates; ++r) Y[r] += 100 * weights[i][1] / white * visible[i][r];
  return estimate(Y).standard_error;
}

ScatteredColor color_of(const std::vector<Replicates>& visible, const GoniometerSettings& settings) {
  std::vector<Knot> knots;
  for (const double nm : visible_wavelengths()) knots.push_back({nm, estimate(visible[knots.size()]).mean});
  const XYZ xyz = tristimulus(settings.illuminant, Curve(std::move(knots)), settings.observer);
  return {xyz, xyz_to_lab(xyz, tristimulus(settings.illuminant, Curve(1.0), settings.observer)),
          standard_error_of_Y(visible, settings)};
}

// A colour is a mean over wavelengths, so few samples of each are enough.
void add_colors(const Material& material, const Imath::V3f& wo, const GoniometerSettings& settings,
                GoniometerAngle& at) {
  constexpr int kSampleDivisor = 32;
  constexpr int kMinSamples = 64;
  const Spectra measured =
      spectra(material, visible_wavelengths(), wo, std::max(settings.samples / kSampleDivisor, kMinSamples));
  at.reflected_color = color_of(measured.reflected, settings);
  at.transmitted_color = color_of(measured.transmitted, settings);
}

GoniometerAngle measure_angle(const Material& material, const GoniometerSettings& settings,
                              double angle_deg) {
  const Imath::V3f wo = incidence(settings, angle_deg);
  const Spectra measured = spectra(material, settings.wavelengths_nm, wo, settings.samples);
  GoniometerAngle at{angle_deg, estimates(measured.reflected), estimates(measured.transmitted), {}, {}, 1, 0};
  add_colors(material, wo, settings, at);
  const SampledSpectrum packet = packet_of(settings.wavelengths_nm, 0);
  const Bsdf bsdf = make_bsdf(material, {packet});
  if (!scatters(bsdf)) return at;
  const DensityCheck check = check_density(
      sampler_of(bsdf, wo, TransportMode::radiance),
      [&](const Imath::V3f& wi) { return static_cast<double>(pdf(bsdf, wo, wi)[0]); }, 0);
  at.sampling_p = check.p;
  at.non_delta_probability = check.integral;
  return at;
}

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

constexpr double kPanel = 220;  // edge of a panel [pixels]
constexpr double kRadius = 92;
constexpr double kPanelTop = 40;
constexpr double kSwatch = 24;

// Colour of a line: that of its wavelength, within the display's gamut.
std::string line_color(double nm, Observer observer) {
  const ColorMatching& eye = color_matching(observer);
  LinearRgb linear = linear_rgb_of_xyz({eye.x(nm), eye.y(nm), eye.z(nm)});
  const double max_value = std::max({linear[0], linear[1], linear[2]});
  if (!(max_value > 0.02)) return "#555555";  // invisible wavelength
  for (double& v : linear) v /= max_value;
  return css_color(display_code(linear));
}

// Values of f cos around the plane of incidence, by wavelength.
struct Slice {
  static constexpr int kSteps = 720;
  std::vector<std::vector<double>> values;
  double max_value = 0;
};
Slice slice(const Material& material, const GoniometerSettings& settings, const Imath::V3f& wo) {
  Slice all;
  for (std::size_t i = 0; i < settings.wavelengths_nm.size(); ++i) {
    const SampledSpectrum packet = packet_of(settings.wavelengths_nm, i);
    const Bsdf bsdf = make_bsdf(material, {packet});
    std::vector<double>& line = all.values.emplace_back();
    for (int step = 0; step < Slice::kSteps; ++step) {
      const double angle = 360 * kDegree * (step + 0.5) / Slice::kSteps;
      const Imath::V3f wi = direction_at(std::cos(angle), angle < 180 * kDegree ? 0 : std::numbers::pi);
      line.push_back(static_cast<double>(eval(bsdf, wo, wi, TransportMode::power)[0] * std::abs(wi.z)));
      all.max_value = std::max(all.max_value, line.back());
    }
  }
  return all;
}

std::string lobe(const std::vector<double>& line, double max_value, double x, double y,
                 const std::string& color) {
  SvgPoints points;
  for (std::size_t step = 0; step < line.size(); ++step) {
    const double angle = 360 * kDegree * (static_cast<double>(step) + 0.5) / static_cast<double>(line.size());
    const double radius = kRadius * std::sqrt(line[step] / max_value);
    points.emplace_back(x + radius * std::sin(angle), y - radius * std::cos(angle));
  }
  return svg_polygon(points, fmt::format("stroke=\"{}\" stroke-width=\"1.5\"", color));
}

// Arrows for the delta events of the first wavelength; the length is the square root of the fraction of
// power.
std::string arrows(const Material& material, const GoniometerSettings& settings, const Imath::V3f& wo,
                   double x, double y) {
  const SampledSpectrum packet = packet_of(settings.wavelengths_nm, 0);
  std::string all;
  for (const BsdfSample& event : delta_events(make_bsdf(material, {packet}), wo, 0, TransportMode::power)) {
    const double length = kRadius * std::sqrt(static_cast<double>(event.pdf * event.weight[0]));
    all += svg_line(x, y, x + length * static_cast<double>(event.wi.x),
                    y - length * static_cast<double>(event.wi.z), "stroke=\"#333333\" stroke-width=\"2.5\"");
  }
  return all;
}

std::string panel(const Material& material, const GoniometerSettings& settings, const GoniometerAngle& at,
                  double left) {
  const double x = left + kPanel / 2;
  const double y = kPanelTop + kPanel / 2;
  const Imath::V3f wo = incidence(settings, at.angle_deg);
  std::string all = svg_circle(x, y, kRadius, "fill=\"none\" stroke=\"#dddddd\"");
  all += svg_line(x - kRadius, y, x + kRadius, y, "stroke=\"#888888\"");
  all +=
      svg_line(x + (kRadius + 12) * static_cast<double>(wo.x), y - (kRadius + 12) * static_cast<double>(wo.z),
               x, y, "stroke=\"#bbbbbb\" stroke-dasharray=\"4 3\"");
  const Slice lines = slice(material, settings, wo);
  if (lines.max_value > 0)
    for (std::size_t i = 0; i < lines.values.size(); ++i)
      all += lobe(lines.values[i], lines.max_value, x, y,
                  line_color(settings.wavelengths_nm[i], settings.observer));
  all += arrows(material, settings, wo, x, y);
  const double bottom = kPanelTop + kPanel;
  all += svg_rect(x - kSwatch, bottom, 2 * kSwatch, kSwatch,
                  fmt::format("fill=\"{}\" stroke=\"#888888\"",
                              css_color(display_code(linear_rgb(at.reflected_color.lab)))));
  const std::string centered = "text-anchor=\"middle\"";
  all += svg_text(x, kPanelTop, fmt::format("{:g}\u00b0", at.angle_deg), centered);
  return all + svg_text(x, bottom + kSwatch + 16,
                        lines.max_value > 0 ? fmt::format("largest f cos {:.3g}/sr", lines.max_value) : "",
                        centered);
}

}  // namespace

std::vector<double> visible_wavelengths() {
  std::vector<double> visible;
  for (int nm = SumRange{}.low_nm; nm <= SumRange{}.high_nm; ++nm) visible.push_back(nm);
  return visible;
}

GoniometerReport measure(const Material& material, const GoniometerSettings& settings) {
  GoniometerReport report{lobes(material), is_dispersive(material), {}, {}, 0};
  for (const double angle : settings.angles_deg)
    report.angles.push_back(measure_angle(material, settings, angle));
  const SampledSpectrum packet = packet_of(settings.wavelengths_nm, 0);
  report.reciprocity = reciprocity_error(make_bsdf(material, {packet}));
  for (const GoniometerAngle& at : report.angles)
    for (std::size_t i = 0; i < at.reflected.size(); ++i)
      report.max_albedo = std::max(report.max_albedo, at.reflected[i].mean + at.transmitted[i].mean);
  return report;
}

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

std::string lobe_plot(const Material& material, const GoniometerSettings& settings,
                      const GoniometerReport& report, const std::string& title) {
  const double width = kPanel * static_cast<double>(report.angles.size());
  const double height = kPanelTop + kPanel + kSwatch + 50;
  std::string all;
  double legend = 10;
  for (const double nm : settings.wavelengths_nm) {
    all += svg_line(legend, height - 14, legend + 20, height - 14,
                    fmt::format("stroke=\"{}\" stroke-width=\"2\"", line_color(nm, settings.observer)));
    all += svg_text(legend + 24, height - 10, fmt::format("{:g} nm", nm), "");
    legend += 90;
  }
  for (std::size_t i = 0; i < report.angles.size(); ++i)
    all += panel(material, settings, report.angles[i], kPanel * static_cast<double>(i));
  return svg_document(width, height, title, all);
}

}  // namespace abbe
