#pragma once

#include "io/image.h"
#include "spectral/film_observer.h"

namespace abbe {

/// What films tell of the unit of an observer's channels.
[[nodiscard]] const char* photometric_unit(Observer observer);

/// Who sees a film's colours, by what it tells: the observer whose X it has, else that of 1931, who sees of a
/// spectral film its bands.
[[nodiscard]] FilmObserver recorded_film_observer(const Image& film);

}  // namespace abbe
