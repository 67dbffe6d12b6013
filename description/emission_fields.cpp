#include "description/emission.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr char kOnASurface[] = "On a surface that faces the lamp that far from its middle, on its normal.";
constexpr char kDistance[] = "Distance from the middle of the lamp along its normal.";

auto radiant_flux() {
  return under<RadiantFlux>("radiant_flux_W", number(kPower), "Power that the lamp sends out [W].");
}
auto luminous_flux() {
  return under<LuminousFlux>("luminous_flux_lm", number(kPower),
                             "Luminous flux that the lamp sends out [lm].");
}
auto radiance() {
  return under<Radiance>("radiance", number(kPower), "Radiance [W/(m2 sr)] over 300-1100 nm.");
}
auto luminance() {
  return under<Luminance>("luminance", number(kPower), "Luminance [cd/m2].");
}

// One spectrum and at most one of the scales.
template <typename E, typename... Choices>
Fields describe_emission(std::string_view name, std::string_view text, bool has_flux, Choices... scale) {
  decltype(Emission::spectrum) E::*spectrum = &Emission::spectrum;
  decltype(Emission::scale) E::*scales = &Emission::scale;
  const auto sources = [&](auto... more) {
    return one_of(
        spectrum,
        under<Illuminant>("illuminant", schema::text(),
                          "A relative spectrum: a name of data/illuminant, blackbody:<K>, daylight:<K>, or "
                          "FILE.csv:COLUMN."),
        under<Blackbody>("blackbody_K", blackbody_K(), "Planck's spectral radiance at this temperature [K]."),
        under<Daylight>("daylight_K", daylight_K(),
                        "CIE daylight of this correlated colour temperature [K], relative."),
        under<Spectrum>("spectrum", curve(),
                        "Spectral radiance [W/(m2 sr nm)], intensity [W/(sr nm)] of a point or spot, or "
                        "irradiance [W/(m2 nm)] "
                        "of a directional light; 0 or more."),
        under<Lines>("lines", lines(), "Spectral lines, in the unit of a spectrum."), std::move(more)...);
  };
  return describe<E>(name, text,
                     {has_flux ? sources(under<SpectralFlux>(
                                     "spectral_flux_W_per_nm", curve(),
                                     "What the lamp sends out at each wavelength [W/nm], 0 or more."))
                               : sources(),
                      at_most_one(scales, "an emission has one scale", std::move(scale)...)});
}

}  // namespace

static const Fields& fields(Tag<IrradianceAt>) {
  static const Fields kFields =
      describe<IrradianceAt>("irradiance_at", "",
                             {field("irradiance", &IrradianceAt::irradiance, number(kPower), kOnASurface),
                              field("distance", &IrradianceAt::distance, length(), kDistance)});
  return kFields;
}
static const Fields& fields(Tag<IlluminanceAt>) {
  static const Fields kFields =
      describe<IlluminanceAt>("illuminance_at", "",
                              {field("illuminance", &IlluminanceAt::illuminance, number(kPower), kOnASurface),
                               field("distance", &IlluminanceAt::distance, length(), kDistance)});
  return kFields;
}

const Fields& fields(Tag<MeshEmission>) {
  static const Fields kFields =
      describe_emission<MeshEmission>("mesh_emission", "What each triangle sends out.", true, radiant_flux(),
                                      luminous_flux(), radiance(), luminance());
  return kFields;
}
const Fields& fields(Tag<LampEmission>) {
  static const Fields kFields = describe_emission<LampEmission>(
      "lamp_emission", "What a surface sends out, the same radiance in all directions.", true, radiant_flux(),
      luminous_flux(), radiance(), luminance(), beside<IrradianceAt>("irradiance"),
      beside<IlluminanceAt>("illuminance"));
  return kFields;
}
const Fields& fields(Tag<PointEmission>) {
  static const Fields kFields = describe_emission<PointEmission>(
      "point_emission", "What a point sends out.", true, radiant_flux(), luminous_flux(),
      under<Intensity>("intensity", number(kPower), "Intensity [W/sr] over 300-1100 nm."),
      under<LuminousIntensity>("luminous_intensity", number(kPower), "Luminous intensity [cd]."),
      beside<IrradianceAt>("irradiance"), beside<IlluminanceAt>("illuminance"));
  return kFields;
}
const Fields& fields(Tag<BeamEmission>) {
  static const Fields kFields = describe_emission<BeamEmission>(
      "beam_emission", "What comes from one direction.", false,
      under<Irradiance>("irradiance", number(kPower),
                        "Of a surface that faces the light [W/m2] over 300-1100 nm."),
      under<Illuminance>("illuminance", number(kPower), "Of a surface that faces the light [lx]."));
  return kFields;
}
const Fields& fields(Tag<SunEmission>) {
  static const Fields kFields = describe_emission<SunEmission>(
      "sun_emission", "What a disc at infinity sends here.", false, radiance(), luminance(),
      under<Irradiance>("irradiance", number(kPower),
                        "Of a surface that faces the light [W/m2] over 300-1100 nm."),
      under<Illuminance>("illuminance", number(kPower), "Of a surface that faces the light [lx]."));
  return kFields;
}
const Fields& fields(Tag<SkyEmission>) {
  static const Fields kFields = describe_emission<SkyEmission>(
      "sky_emission", "What comes from all directions.", false, radiance(), luminance());
  return kFields;
}

}  // namespace abbe::spec
