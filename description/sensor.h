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
  std::optional<Curve> transmittance;     ///< 1 if absent.
  std::optional<Curve> extinction_ratio;  ///< Infinite if absent.
  SourcePosition where;
};
/// A channel with its own filters, and optionally a polariser.
struct FilteredChannel {
  std::optional<Filters> filters;
  std::optional<PolarisingFilter> polariser;
  std::optional<double> exposure_s;  ///< Exposure time of the sensor if absent.
};
using ChannelResponse = std::variant<Curve, FilteredChannel>;

struct Channels : schema::Located<std::vector<schema::Named<ChannelResponse>>> {};
struct MeasuredCamera : schema::Located<std::string> {};
struct StandardObserver : schema::Located<Observer> {};
/// Wavelength bins of equal width that fill a range.
struct Bins {
  double from_nm = 0;
  double to_nm = 0;
  double step_nm = 0;
  SourcePosition where;
};

[[nodiscard]] schema::Fields fields(schema::Tag<Bins>);

/// The pixels of a sensor and the quantities they record.
struct Sensor {
  std::optional<std::string> model;  ///< Its keys were merged into this struct before the scene was read.
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

/// A sensor in SI units.
struct Sensor {
  int width = 1;
  int height = 1;
  double pixel_pitch = 4.5e-6;  ///< Distance between pixels [m].
  double fill_factor = 1;
  double exposure_s = 1;
  Shutter shutter;
  std::vector<Channel> channels;
  std::optional<Readout> readout;
  std::optional<Mosaic> mosaic;
  std::optional<SpectralBins> spectral;
};
/// Builds a sensor and reports its errors. The sensor of an irradiance probe (`probe`) has one pixel unless
/// the file gives a resolution.
[[nodiscard]] Sensor build(const spec::Sensor& sensor, bool probe, LoadContext& context);

/// Builds the wavelength bins. Returns nothing if they do not fill their range, or if there are too few or
/// too many.
[[nodiscard]] std::optional<SpectralBins> build_bins(const spec::Bins& spec, LoadContext& context);

/// Sets the channels or wavelength bins of a sensor, with all filters applied. Channels without their own
/// exposure time have that of the sensor. Reports tables of filters and responses that end, without a
/// declared extrapolation, where a channel records more than a negligible fraction. Warns of filters that are
/// declared 0 there.
void build_channels(const spec::Sensor& spec, Sensor& sensor, LoadContext& context);

}  // namespace abbe::description
