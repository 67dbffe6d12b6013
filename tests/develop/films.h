#pragma once

#include "io/image.h"

namespace abbe::test {

/// A rendered film of two electron-counting pixels of area 1e-10 m^2, with 400 and 900 electrons.
inline Image counting_film() {
  Image film{2, 1, {}, {}};
  film.channels = {{"V", {4e12F, 9e12F}}, {"Variance.V", {1e22F, 3e22F}}};
  film.metadata = {{"sensor_channels", "V"},
                   {"channel.V", "quantum, electrons per m^2"},
                   {"exposure_s", "0.01"},
                   {"gathering_area_m2", "1e-10"},
                   {"seed", "7"},
                   {"to_xyz_d65", "0.95 0 0 1 0 0 1.09 0 0"},
                   {"display_exposure", "8e12"},
                   {"sensor", R"({"readout": {"gain_e_per_dn": 1, "bits": 12, "dark_e_per_s": 2}})"}};
  return film;
}

/// A film of two dark pixels under filters; the first has ten times the sensor's exposure time. The dark
/// current is 1e4 electrons/s.
inline Image mosaic_film() {
  Image film = counting_film();
  film.channels = {{"raw", {0, 0}}, {"Variance.raw", {0, 0}}};
  film.metadata["sensor_channels"] = "raw";
  film.metadata["mosaic"] = "R,G";
  film.metadata["mosaic_channels"] = "R,G";
  for (const char* channel : {"channel.R", "channel.G"}) film.metadata[channel] = film.metadata["channel.V"];
  film.metadata["exposure_s"] = "0.5";
  film.metadata["exposure_s.R"] = "5";
  film.metadata["sensor"] = R"({"readout": {"gain_e_per_dn": 1, "bits": 16, "dark_e_per_s": 1e4}})";
  film.metadata.erase("to_xyz_d65");
  return film;
}

}  // namespace abbe::test
