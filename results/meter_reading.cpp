#include "results/meter_reading.h"

#include <array>

#include "spectral/sources.h"

namespace abbe {
namespace {

constexpr std::array<MeterUnits, kMeterQuantityNames.size()> kUnits{
    {{"W/m2", "lx", "photons/(s m2)"},
     {"W", "lm", "photons/s"},
     {"W/(m2 sr)", "cd/m2", "photons/(s m2 sr)"},
     {"W/sr", "cd", "photons/(s sr)"}}};

Film::Average scaled(Film::Average value, double factor) {
  value.mean *= factor;
  value.standard_error *= factor;
  return value;
}

// Reading of a part of the film: a cell, or all cells.
LightReading light_in(const Film& film, const Crop& part, double factor) {
  const auto read = [&](int plane) {
    return scaled(film.average(plane, part.x0, part.y0, part.x1, part.y1), factor);
  };
  return {read(kRadiantPlane), read(kLuminousPlane), scaled(read(kPhotonPlane), kAvogadro / 1e6)};
}

}  // namespace

const MeterUnits& units_of(MeterQuantity quantity) {
  return kUnits.at(static_cast<std::size_t>(quantity));
}

MeterReading read_meter(const Meter& meter, const Film& film, double exposure_s) {
  const double factor = per_irradiance(meter) / exposure_s;
  const auto& [columns, rows] = meter.cells;
  const int width = film.width() / columns;
  const int height = film.height() / rows;
  MeterReading reading{light_in(film, film.crop(), factor), {}, {}};
  // Flux and intensity are per cell, other quantities per area.
  const double of_cell = meter.quantity == MeterQuantity::flux || meter.quantity == MeterQuantity::intensity
                             ? factor / (columns * rows)
                             : factor;
  for (int y = 0; y < rows && columns * rows > 1; ++y)
    for (int x = 0; x < columns; ++x)
      reading.cells.push_back(
          light_in(film, {x * width, y * height, (x + 1) * width, (y + 1) * height}, of_cell));
  for (int bin = 0; meter.spectrum && bin < meter.spectrum->count; ++bin)
    reading.spectrum.push_back(scaled(film.average(kSpectrumPlane + bin), factor / meter.spectrum->step_nm));
  return reading;
}

}  // namespace abbe
