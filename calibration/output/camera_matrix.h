#pragma once

#include <optional>
#include <span>
#include <string>

#include "calibration/output/display.h"
#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// The colours that a calibration gives to a sensor's film values.
struct CameraMatrix {
  std::string space;   ///< Name of the camera space.
  Matrix3 to_xyz_d65;  ///< In units of the second channel's value of a neutral, as `make_display` has it.
};

/// The matrix of the camera space in the view's configuration that belongs to a film with these channels and
/// this white: of several spaces that of the light of this name, else of the illuminant with the nearest
/// chromaticity. Nothing for a configuration without camera spaces, for a number of channels other than three
/// and for an observer's X, Y, Z. Throws Error{usage} where no space can be chosen, and for a root
/// polynomial.
[[nodiscard]] std::optional<CameraMatrix> camera_matrix(const ViewOptions& view,
                                                        std::span<const std::string> channels,
                                                        const std::string& white_name,
                                                        std::optional<Chromaticity> white);

}  // namespace abbe
