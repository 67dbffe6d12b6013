#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Lets the photons of a plan draw their wavelengths more densely where these leave more noise, if light
/// disperses: then a pixel sees few wavelengths, and what is best for the film as a whole is not for its
/// pixels. What counts is the error of film values, of an observer those of linear sRGB, relative to what is
/// around them on the film, as relMSE takes it.
void learn_wavelengths(Plan& plan, int threads);

}  // namespace abbe
