#pragma once

#include <array>
#include <utility>

#include "sensor/response/mosaic.h"

namespace abbe::test {

/// The four phases of a Bayer pattern of the channels R, G and B (0, 1 and 2), with their usual names.
inline const std::array<std::pair<const char*, Mosaic>, 4> kBayerPhases{{{"RGGB", {2, 2, {0, 1, 1, 2}}},
                                                                         {"GRBG", {2, 2, {1, 0, 2, 1}}},
                                                                         {"GBRG", {2, 2, {1, 2, 0, 1}}},
                                                                         {"BGGR", {2, 2, {2, 1, 1, 0}}}}};

}  // namespace abbe::test
