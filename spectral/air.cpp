#include "spectral/air.h"

namespace abbe {
namespace {

// Index as a function of the vacuum wavenumber sigma [1/um]: n - 1 = a/(b - sigma^2) + c/(d - sigma^2)
// [Ciddor1996, eq. 1 and table 1]. The coefficients give 1e8 (n - 1).
double index_of_vacuum_wavelength(double vacuum_nm) {
  const double sigma = 1e3 / vacuum_nm;
  const double s2 = sigma * sigma;
  return 1 + 1e-8 * (5792105.0 / (238.0185 - s2) + 167917.0 / (57.362 - s2));
}

}  // namespace

double air_to_vacuum(double wavelength_nm) {
  // The fixed-point iteration contracts by about 1e-5 per step, so two steps are exact to the last bits.
  double vacuum_nm = wavelength_nm * index_of_vacuum_wavelength(wavelength_nm);
  for (int step = 0; step < 2; ++step) vacuum_nm = wavelength_nm * index_of_vacuum_wavelength(vacuum_nm);
  return vacuum_nm;
}

double vacuum_to_air(double wavelength_nm) {
  return wavelength_nm / index_of_vacuum_wavelength(wavelength_nm);
}

double air_index(double wavelength_nm) {
  return index_of_vacuum_wavelength(air_to_vacuum(wavelength_nm));
}

}  // namespace abbe
