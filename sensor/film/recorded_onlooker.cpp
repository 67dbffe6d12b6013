#include "sensor/film/recorded_onlooker.h"

namespace abbe {

const char* photometric_unit(Observer observer) {
  return observer == Observer::cie1931 ? "photometric, lx s"
                                       : "photometric of CIE 1964, 683.002 lm/W times J per m^2";
}

Onlooker recorded_onlooker(const Image& film) {
  const auto unit = film.metadata.find("channel.X");
  if (unit != film.metadata.end() && unit->second == photometric_unit(Observer::cie1964))
    return {Observer::cie1964};
  return {};
}

}  // namespace abbe
