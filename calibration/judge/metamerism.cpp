#include "calibration/judge/metamerism.h"

#include "calibration/chart/delta_e.h"
#include "io/error.h"

namespace abbe {

Metamerism metamerism(const Curve& first, const Curve& second, const Curve& reference, const Curve& test,
                      SumRange range) {
  const auto seen = [range](const Curve& light, const Curve& reflectance) {
    return tristimulus(light, reflectance, Observer::cie1931, range);
  };
  const auto lab = [&](const XYZ& xyz, const Curve& light) { return xyz_to_lab(xyz, seen(light, Curve(1))); };
  const XYZ wanted = seen(reference, first);
  const XYZ matching = seen(reference, second);
  XYZ corrected = seen(test, second);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(matching[i] > 0))
      throw Error(ErrorCode::input, "metamerism", "a reflectance is black in the reference light");
    corrected[i] *= wanted[i] / matching[i];
  }
  const Lab here = lab(seen(test, first), test);
  const Lab there = lab(corrected, test);
  return {delta_e_76(lab(wanted, reference), lab(matching, reference)), delta_e_76(here, there),
          delta_e_2000(here, there)};
}

}  // namespace abbe
