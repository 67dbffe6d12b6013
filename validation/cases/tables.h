#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/error.h"
#include "materials/index/library.h"
#include "sensor/response/channel.h"
#include "spectral/chart.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe {

/// Value that a loader of shipped data returned. Throws Error{input} with the loader's diagnostics if there
/// is none.
template <typename T>
[[nodiscard]] T shipped(std::optional<T> value, const Diagnostics& diagnostics) {
  if (!value) throw Error(ErrorCode::input, "", diagnostics.text());
  return *std::move(value);
}

/// Observer of a field of view in degrees: "2" or "10".
[[nodiscard]] inline Observer observer(const std::string& degrees) {
  return degrees == "2" ? Observer::cie1931 : Observer::cie1964;
}

/// Shipped data by name. Each function throws Error{input} if the name is unknown.
[[nodiscard]] inline RefractiveIndex shipped_index(const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_index(name, {}, diagnostics), diagnostics).index;
}
[[nodiscard]] inline Curve shipped_illuminant(const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_illuminant(name, {}, diagnostics), diagnostics).curve;
}
[[nodiscard]] inline Curve shipped_curve(const std::string& folder, const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_curve(folder, name, {}, diagnostics), diagnostics).curve;
}
[[nodiscard]] inline std::vector<Channel> shipped_camera(const std::string& name) {
  Diagnostics diagnostics;
  return shipped(load_camera(name, {}, diagnostics), diagnostics);
}

}  // namespace abbe
