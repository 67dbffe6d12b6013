#pragma once

#include "io/image.h"
#include "spectral/film_observer.h"

namespace abbe {

/// Unit that films record for the channels X, Y and Z of an observer, in the attribute `channel.X`.
[[nodiscard]] const char* photometric_unit(Observer observer);

/// Observer of a film's colours: the one whose X channel it records, otherwise the CIE 1931 observer, with
/// the bands of a spectral film. A single band, whose width is unknown, counts as none. Never throws.
[[nodiscard]] FilmObserver recorded_film_observer(const Image& film);

}  // namespace abbe
