#pragma once

#include <optional>
#include <span>
#include <string>

#include "calibration/output/display.h"
#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Matrix from a sensor's film values to colours, as a calibration gives it.
struct CameraMatrix {
  std::string space;  ///< Name of the camera space.
  /// Its columns are in the order of the channels. Scaled so that a neutral's Y is the value of its second
  /// channel, as in `make_display`.
  Matrix3 to_xyz_d65;
};

/// Matrix of the camera space, in the view's configuration, that belongs to a film with these channels and
/// this white. A single space is taken for any white. Among several, it takes that of the light named
/// `white_name`, else of the illuminant whose chromaticity is nearest to `white`. Empty for a configuration
/// without camera spaces, for Abbe's own configuration, for a number of channels other than three, and for an
/// observer's X, Y, Z. Throws Error{usage} if no space can be chosen, and for a root polynomial. Throws
/// Error{input} for a configuration that OpenColorIO cannot read.
[[nodiscard]] std::optional<CameraMatrix> camera_matrix(const ViewOptions& view,
                                                        std::span<const std::string> channels,
                                                        const std::string& white_name,
                                                        std::optional<Chromaticity> white);

}  // namespace abbe
