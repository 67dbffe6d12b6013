#pragma once

#include "io/image.h"
#include "spectral/film_observer.h"

namespace abbe {

/// Unit that films record for the channels of an observer.
[[nodiscard]] const char* photometric_unit(Observer observer);

/// Observer of a film's colours: the one whose X channel it records, otherwise the CIE 1931 observer, with
/// the bands of a spectral film.
[[nodiscard]] FilmObserver recorded_film_observer(const Image& film);

}  // namespace abbe
