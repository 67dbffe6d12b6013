#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Trains the wavelength distribution of the plan's photons, if the scene has dispersion: wavelengths that
/// leave more noise are sampled more densely. With dispersion each pixel receives few wavelengths, so the
/// best distribution for the mean of the film is not the best for its pixels. The criterion is the squared
/// error of film values relative to the local mean, as in relMSE. For an observer it is that of linear sRGB.
/// Does nothing without dispersion, without traced lights, or if no pilot photon arrives at the film. The
/// result does not depend on `threads`, which is at least 1.
void train_photon_wavelengths(Plan& plan, int threads);

}  // namespace abbe
