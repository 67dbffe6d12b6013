#pragma once

#include <optional>
#include <string_view>

#include <ImathVec.h>

#include "description/kinds.h"
#include "description/load_context.h"
#include "io/object_reader.h"
#include "spectral/curve.h"

namespace abbe::description {

using spec::kCoordinate;
using spec::kExposure;
using spec::kLength;
using spec::kMaxLength;
using spec::kPower;
using spec::kValue;
using spec::kWavelength;

}  // namespace abbe::description
