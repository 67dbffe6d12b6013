#include "calibration/metrics/metamerism.h"

#include "calibration/chart/delta_e.h"
#include "io/error.h"

namespace abbe {

// X, Y, Z of the second under the test light are multiplied by first/second under the reference light.
Metamerism metamerism(const Curve& first, const Curve& second, const Curve& reference, const Curve& test,
                      SumRange range) {
  const auto xyz_of = [range](const Curve& light, const Curve& reflectance) {
    return tristimulus(light, reflectance, Observer::cie1931, range);
  };
  const auto lab = [&](const XYZ& xyz, const Curve& light) {
    return xyz_to_lab(xyz, xyz_of(light, Curve(1)));
  };
  const XYZ first_xyz = xyz_of(reference, first);
  const XYZ second_xyz = xyz_of(reference, second);
  XYZ corrected = xyz_of(test, second);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(second_xyz[i] > 0))
      throw Error(ErrorCode::input, "metamerism", "a reflectance is black in the reference light");
    corrected[i] *= first_xyz[i] / second_xyz[i];
  }
  const Lab here = lab(xyz_of(test, first), test);
  const Lab there = lab(corrected, test);
  return {delta_e_76(lab(first_xyz, reference), lab(second_xyz, reference)), delta_e_76(here, there),
          delta_e_2000(here, there)};
}

}  // namespace abbe
