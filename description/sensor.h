#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "description/shutter.h"
#include "scene/scene.h"
#include "sensor/readout/readout_json.h"
#include "spectral/colorimetry.h"

namespace abbe::spec {

/// A filter whose transmittance shifts with the angle of incidence.
struct InterferenceFilter {
  Curve transmittance;
  double effective_index = 1;
};
using Filter = std::variant<Curve, InterferenceFilter>;
using Filters = std::vector<Filter>;
/// A polariser for linearly polarised light.
struct PolarisingFilter {
  double angle_deg = 0;
  std::optional<Curve> transmittance;     ///< 1 when absent.
  std::optional<Curve> extinction_ratio;  ///< Infinite when absent.
  SourcePosition where;
};
/// A channel behind filters of its own, perhaps behind a polariser.
struct FilteredChannel {
  std::optional<Filters> filters;
  std::optional<PolarisingFilter> polariser;
  std::optional<double> exposure_s;  ///< The sensor's when absent.
};
using ChannelResponse = std::variant<Curve, FilteredChannel>;

struct Channels : schema::Located<std::vector<schema::Named<ChannelResponse>>> {};
struct MeasuredCamera : schema::Located<std::string> {};
struct StandardObserver : schema::Located<Observer> {};
/// Bins of wavelength that fill a range.
struct Bins {
  double from_nm = 0;
  double to_nm = 0;
  double step_nm = 0;
  SourcePosition where;
};

[[nodiscard]] schema::Fields fields(schema::Tag<Bins>);

/// The film: its pixels, and what they count.
struct Sensor {
  std::optional<std::string> model;  ///< Which was put in here before the scene was read.
  std::optional<schema::Located<std::array<std::int64_t, 2>>> resolution;
  double pixel_pitch_um = 4.5;
  double exposure_s = 1;
  std::optional<Shutter> shutter;
  double fill_factor = 1;
  std::variant<std::monostate, Channels, MeasuredCamera, StandardObserver, Bins> counts;
  std::optional<schema::Located<ResponseKind>> response;
  std::optional<Curve> quantum_efficiency;
  std::optional<schema::Located<double>> peak_quantum_efficiency;
  std::optional<schema::Located<double>> electrons_per_lx_s;
  std::optional<schema::Located<Filters>> filters;
  std::optional<Curve> lens_transmission;
  std::optional<PolarisingFilter> polariser;
  std::optional<schema::Located<bool>> stokes;
  std::optional<schema::Located<std::vector<schema::Located<std::vector<schema::Located<std::string>>>>>>
      mosaic;
  std::optional<schema::Located<Readout>> readout;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Sensor>);

}  // namespace abbe::spec

namespace abbe::description {

/// The sensor ready to be used.
struct Sensor {
  int width = 1;
  int height = 1;
  double pixel_pitch = 4.5e-6;  ///< [m]
  double fill_factor = 1;
  double exposure_s = 1;
  Shutter shutter;
  std::vector<Channel> channels;
  std::optional<Readout> readout;
  std::optional<Mosaic> mosaic;
  std::optional<SpectralBins> spectral;
};
/// Reports what no table can say. `probe`: the sensor of an irradiance probe has one pixel unless it says
/// otherwise.
[[nodiscard]] Sensor build(const spec::Sensor& sensor, bool probe, LoadContext& context);

/// Reports bins that do not fill their range, or are too few or too many; nothing then.
[[nodiscard]] std::optional<SpectralBins> build_bins(const spec::Bins& said, LoadContext& context);

/// What the pixels of a sensor count, with its filters: its channels or its bins; the sensor's exposure is
/// that of channels without their own. Reports tables of filters and responses that do not say what holds
/// beyond their rows where a channel counts more than a negligible share, and warns of filters that are 0
/// there.
void build_channels(const spec::Sensor& said, Sensor& sensor, LoadContext& context);

}  // namespace abbe::description
