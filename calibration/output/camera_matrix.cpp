#include "calibration/output/camera_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "calibration/output/ocio.h"
#include "io/error.h"
#include "io/image.h"
#include "spectral/library.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr const char* kOption = "--ocio";

std::string light_of(const OcioCameraSpace& space) {
  return space.name.substr(std::string_view(kCameraPrefix).size());
}

// Distance of chromaticities; infinite for a light that is not an illuminant of the data directory.
double distance(const OcioCameraSpace& space, const Chromaticity& white) {
  Diagnostics unknown;
  const auto light = load_illuminant(light_of(space), {}, unknown);
  if (!light) return std::numeric_limits<double>::infinity();
  const Chromaticity xy = chromaticity(light->curve);
  return std::hypot(xy[0] - white[0], xy[1] - white[1]);
}

// Space of the film's white: by name, else by the nearest chromaticity.
const OcioCameraSpace& choose(const std::vector<OcioCameraSpace>& spaces, const std::string& white_name,
                              const std::optional<Chromaticity>& white) {
  if (spaces.size() == 1) return spaces.front();
  std::vector<std::string> names;
  const OcioCameraSpace* nearest = nullptr;
  double min_distance = std::numeric_limits<double>::infinity();
  for (const OcioCameraSpace& space : spaces) {
    if (light_of(space) == white_name) return space;
    names.push_back(space.name);
    const double candidate = white ? distance(space, *white) : min_distance;
    if (candidate < min_distance) nearest = &space;
    min_distance = std::min(candidate, min_distance);
  }
  if (nearest == nullptr)
    throw Error(
        ErrorCode::usage, kOption,
        fmt::format("has several camera spaces, none of which is for the film's white (got {}, allowed "
                    "a white among {})",
                    white_name.empty() ? "none" : white_name, fmt::join(names, ", ")));
  return *nearest;
}

// The columns of R, G and B in the order of the channels.
Matrix3 in_order_of(std::span<const std::string> channels, const Matrix3& rgb) {
  const auto order = rgb_order(channels);
  Matrix3 ordered = rgb;
  for (std::size_t k = 0; order && k < 3; ++k)
    for (int i = 0; i < 3; ++i) ordered[i][static_cast<int>((*order)[k])] = rgb[i][static_cast<int>(k)];
  return ordered;
}

}  // namespace

std::optional<CameraMatrix> camera_matrix(const ViewOptions& view, std::span<const std::string> channels,
                                          const std::string& white_name, std::optional<Chromaticity> white) {
  const bool is_observer = std::ranges::equal(channels, std::array<std::string, 3>{"X", "Y", "Z"});
  if (view.config.empty() || channels.size() != 3 || is_observer) return std::nullopt;
  const std::vector<OcioCameraSpace> spaces = camera_spaces(view.config);
  if (spaces.empty()) return std::nullopt;
  const OcioCameraSpace& space = choose(spaces, white_name, white);
  if (!space.to_xyz_d65 || !is_invertible(*space.to_xyz_d65))
    throw Error(ErrorCode::usage, kOption,
                fmt::format("\"{}\" is not a matrix, which films need (allowed: a configuration of calibrate "
                            "--correction matrix)",
                            space.name));
  const Matrix3 matrix = in_order_of(channels, *space.to_xyz_d65);
  const std::array<double, 3> neutral = multiply(matrix.inverse(true), unit_xyz(kD65));
  return CameraMatrix{space.name, matrix * neutral[1]};
}

}  // namespace abbe
