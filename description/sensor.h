#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "description/curve.h"
#include "description/load_context.h"
#include "io/schema/fields.h"
#include "scene/scene.h"
#include "scene/shutter.h"
#include "sensor/readout/readout_json.h"
#include "spectral/colorimetry.h"

namespace abbe::spec {

/// Times and transmission of the shutter of each row of a sensor. A row is open for the exposure time of the
/// sensor.
struct Shutter {
  double open_s = 0;  ///< Time at which the first row opens, on the clock of keyframes.
  double rise_s = 0;  ///< Duration of opening, as part of the exposure time.
  double fall_s = 0;  ///< Duration of closing, as part of the exposure time.
  /// Pairs of the elapsed fraction of the exposure time and the transmittance then. They replace `rise_s` and
  /// `fall_s`.
  std::optional<schema::Located<std::vector<std::array<double, 2>>>> transmission;
  double row_delay_s = 0;  ///< Delay of each row after the row above it, 0 or more.
  SourcePosition where;
};
/// A filter whose transmittance shifts with the angle of incidence.
struct InterferenceFilter {
  Curve transmittance;         ///< At normal incidence, in [0, 1.05].
  double effective_index = 1;  ///< n in [1, 10]: wavelengths shift by sqrt(1 - sin(t)^2/n^2) at the angle t.
};
using Filter = std::variant<Curve, InterferenceFilter>;
using Filters = std::vector<Filter>;  ///< Filters in series.
/// A polariser for linearly polarised light, in front of the film.
struct PolarisingFilter {
  double angle_deg = 0;                   ///< Angle of the axis, from the right of the picture towards up.
  std::optional<Curve> transmittance;     ///< Along the axis, in [0, 1.05]; 1 if absent.
  std::optional<Curve> extinction_ratio;  ///< Transmittance along over across the axis; infinite if absent.
  SourcePosition where;
};
/// A channel with its own filters, and optionally a polariser.
struct FilteredChannel {
  std::optional<Filters> filters;             ///< None if absent.
  std::optional<PolarisingFilter> polariser;  ///< Polariser before these filters; none if absent.
  std::optional<double> exposure_s;  ///< Exposure time of this channel; that of the sensor if absent.
};
/// The response of a channel: a curve, or filters in front of a detector that all channels have in common.
using ChannelResponse = std::variant<Curve, FilteredChannel>;

struct Channels : schema::Located<std::vector<schema::Named<ChannelResponse>>> {};
/// A measured camera: its name in `data/camera`, or FILE.csv.
struct MeasuredCamera : schema::Located<std::string> {};
/// A CIE standard observer, with channels X, Y and Z.
struct StandardObserver : schema::Located<Observer> {};
/// Wavelength bins of equal width that fill a range; 2 to 1000 of them. The film then records radiances.
struct Bins {
  double from_nm = 0;  ///< Lower end of the first bin.
  double to_nm = 0;    ///< Upper end of the last bin.
  double step_nm = 0;  ///< Width of each bin.
  SourcePosition where;
};

/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Bins>);

/// The pixels of a sensor and the quantities they record.
struct Sensor {
  std::optional<std::string> model;  ///< Its keys were merged into this struct before the scene was read.
  /// Width and height [px]. Required except for a probe, which then has one pixel.
  std::optional<schema::Located<std::array<std::int64_t, 2>>> resolution;
  double pixel_pitch_um = 4.5;     ///< Distance between the centers of pixels.
  double exposure_s = 1;           ///< Exposure time, above 0.
  std::optional<Shutter> shutter;  ///< If absent, all rows are open for the exposure time.
  double fill_factor = 1;          ///< Fraction of the pixel area that is sensitive to light, in (0, 1].
  /// Quantities that the pixels record; `std::monostate` if neither the scene nor its model gives them.
  std::variant<std::monostate, Channels, MeasuredCamera, StandardObserver, Bins> counts;
  /// Kind of the responses; if absent it follows from the table and other keys.
  std::optional<schema::Located<ResponseKind>> response;
  std::optional<Curve> quantum_efficiency;  ///< Electrons per photon, in [0, 10], a factor of every channel.
  /// Electrons per photon of the most sensitive channel at its maximum, which sets a common scale.
  std::optional<schema::Located<double>> peak_quantum_efficiency;
  /// Sets the same scale, by electrons per lx s of daylight (D55).
  std::optional<schema::Located<double>> electrons_per_lx_s;
  std::optional<schema::Located<Filters>> filters;  ///< Filters in series before all channels.
  std::optional<Curve> lens_transmission;           ///< Transmittance of the lens, in [0, 1.05]; 1 if absent.
  std::optional<PolarisingFilter> polariser;        ///< Polariser before all channels; none if absent.
  std::optional<schema::Located<bool>> stokes;      ///< True to measure Stokes vectors; false if absent.
  /// Names of channels: rows of a pattern that repeats from the top left. If absent, pixels record all.
  std::optional<schema::Located<std::vector<schema::Located<std::vector<schema::Located<std::string>>>>>>
      mosaic;
  std::optional<schema::Located<Readout>> readout;  ///< Conversion of electrons to codes; none if absent.
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Sensor>);

}  // namespace abbe::spec

namespace abbe::description {

/// A sensor in SI units.
struct Sensor {
  int width = 1;                ///< [px]
  int height = 1;               ///< [px]
  double pixel_pitch = 4.5e-6;  ///< Distance between pixels [m].
  double fill_factor = 1;       ///< Fraction of the pixel area that is sensitive to light.
  double exposure_s = 1;        ///< Exposure time of a row.
  Shutter shutter;
  std::vector<Channel> channels;  ///< One per wavelength bin for a spectral sensor.
  std::optional<Readout> readout;
  std::optional<Mosaic> mosaic;
  std::optional<SpectralBins> spectral;  ///< Wavelength bins of a spectral sensor; nothing for others.
};
/// Builds a sensor and reports its errors to `context.diagnostics`; parts with an error are missing or have
/// defaults: a shutter is then open for the exposure time. `probe` is true for the sensor of an irradiance
/// probe: it has one pixel unless the file gives a resolution, and may not record polarisation. Reports more
/// than 65536 pixels along an edge, or 2^28 in all, with ErrorCode::resource.
[[nodiscard]] Sensor build(const spec::Sensor& sensor, bool probe, LoadContext& context);

/// Builds the wavelength bins. Reports bins that do not fill their range, fewer than 2 and more than 1000,
/// and returns nothing.
[[nodiscard]] std::optional<SpectralBins> build_bins(const spec::Bins& spec, LoadContext& context);

/// Sets `sensor.channels`, with all filters applied, and `sensor.spectral`. A channel with an error is
/// missing. Reports to `context.diagnostics`:
/// - keys that exclude each other, names that are not plain, and bins that do not fill their range;
/// - a channel that responds to no wavelength;
/// - tables that end, without a declared extrapolation, within the range of a channel.
/// Warns of filters that end there and are declared 0 outside. The range excludes a negligible fraction.
void build_channels(const spec::Sensor& spec, Sensor& sensor, LoadContext& context);

/// Merges the file of a camera sensor into a scene whose `sensor` has the key `model`. The value is the name
/// of a file of `data/sensor`, or a user's `FILE.json`. Such a file is an object with `title`, `source`,
/// `status` and `sensor`; the last has the keys of a scene's sensor.
/// Keys of the scene replace those of the file; in `readout` each key separately. A scene that sets the
/// channels, the gain or the speed replaces all keys of the file with that meaning.
/// `scene` is the root of the scene's JSON; it stays unchanged without such a key, and after an error.
/// Reports an unknown name and the errors of the file to `context.diagnostics`. The file is recorded in
/// `context`.
void include_sensor_model(JsonValue& scene, LoadContext& context);

}  // namespace abbe::description
