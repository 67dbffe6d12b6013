#include "description/sensor.h"

namespace abbe::spec {
namespace {

using namespace schema;

// Above 1 by what a measurement may err, far below a percentage.
constexpr Range kEffectiveIndex{1, 10};
constexpr Range kPixels{1};
constexpr Range kPitch{0, 1e6, true, false};  // um
constexpr Range kFill{0, 1, true, false};
constexpr Range kStep{0.01, kMaxWavelengthNm - kMinWavelengthNm};

Kind filters() {
  return list<Filter>(forms<Filter>("filter", "a filter",
                                    form<InterferenceFilter>(Json::object, thing<InterferenceFilter>(),
                                                             {"transmittance", "effective_index"}),
                                    form<Curve>(Json::any, curve())),
                      "filters", 0);
}

Kind channels() {
  return by_name<ChannelResponse>(
      forms<ChannelResponse>("channel", "a channel",
                             form<FilteredChannel>(Json::object, thing<FilteredChannel>(), {"filters"}),
                             form<Curve>(Json::any, curve())),
      "channels by name", 1);
}

Kind mosaic() {
  using Row = Located<std::vector<Located<std::string>>>;
  return list<Row>(list<Located<std::string>>(text(), "channels' names", 1), "rows", 1);
}

}  // namespace

static const Fields& fields(Tag<InterferenceFilter>) {
  static const Fields kFields = describe<InterferenceFilter>(
      "interference_filter", "A filter that shifts to the blue with the angle of incidence.",
      {field("effective_index", &InterferenceFilter::effective_index, number(kEffectiveIndex),
             "At an angle t of incidence the curve is stretched by sqrt(1 - sin(t)^2/n^2)."),
       field("transmittance", &InterferenceFilter::transmittance, curve(),
             "Transmittance along the normal, in [0, 1.05].")});
  return kFields;
}

static const Fields& fields(Tag<FilteredChannel>) {
  static const Fields kFields = describe<FilteredChannel>(
      "filtered_channel", "A channel behind filters of its own.",
      {field("filters", &FilteredChannel::filters, filters(), "The filters, one behind the other."),
       field("exposure_s", &FilteredChannel::exposure_s, number(kExposure),
             "Exposure time of this channel; the sensor's when absent.")});
  return kFields;
}

static const Fields& fields(Tag<Bins>) {
  static const Fields kFields = describe<Bins>(
      "spectral", "Bins of wavelength that fill a range, 2 to 1000 of them: the film holds radiances.",
      {field("from_nm", &Bins::from_nm, number(kWavelength), "Where the first bin begins."),
       field("to_nm", &Bins::to_nm, number(kWavelength), "Where the last bin ends."),
       field("step_nm", &Bins::step_nm, number(kStep), "Width of each bin.")});
  return kFields;
}

const Fields& fields(Tag<Sensor>) {
  static const Fields kFields = describe<Sensor>(
      "sensor", "The pixels, and what they count.",
      {field("resolution", &Sensor::resolution, vector<std::array<std::int64_t, 2>>(kPixels),
             "[width, height] in pixels, edges up to 65536 and 2^28 pixels in all; [1, 1] of a probe when "
             "absent."),
       field("pixel_pitch_um", &Sensor::pixel_pitch_um, number(kPitch), "Distance between pixels.")
           .or_default(),
       field("exposure_s", &Sensor::exposure_s, number(kExposure), "Exposure time.").or_default(),
       field("fill_factor", &Sensor::fill_factor, number(kFill), "Share of a pixel that takes light.")
           .or_default(),
       one_of(&Sensor::counts,
              under<Channels>("channels", channels(), "Response of each channel by name, or its filters."),
              under<MeasuredCamera>("camera", text(),
                                    "A measured camera, by its name in data/camera or as FILE.csv."),
              under<StandardObserver>("observer", word<Observer>("observer", {"1931", "1964"}, true),
                                      "A CIE standard observer: channels X, Y and Z."),
              under<Bins>("spectral", thing<Bins>(), "Bins of wavelength in place of channels.")),
       field(
           "response", &Sensor::response, word<ResponseKind>("response", {"energy", "quantum"}),
           "What the channels, or a camera's curves, multiply; quantum when `quantum_efficiency` is given."),
       field("quantum_efficiency", &Sensor::quantum_efficiency, curve(),
             "Electrons per photon, in [0, 10], multiplied into every channel."),
       field("filters", &Sensor::filters, filters(), "Filters before every channel, one behind the other."),
       field("lens_transmission", &Sensor::lens_transmission, curve(),
             "Transmittance in [0, 1.05] before all filters."),
       field("mosaic", &Sensor::mosaic, mosaic(),
             "Channels of single pixels, rows of a pattern that repeats from the top left corner."),
       field("readout", &Sensor::readout, thing<Readout>(),
             "The electronics behind channels that count electrons.")});
  return kFields;
}

}  // namespace abbe::spec
