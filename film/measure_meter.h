#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "description/load.h"
#include "film/meter_reading.h"
#include "io/inputs.h"
#include "transport/render/render.h"

namespace abbe {

/// A meter and what it read, by which integrator and random numbers.
struct MeterMeasurement {
  Meter meter;
  Integrator integrator;
  std::uint64_t seed;
  MeterReading reading;
  RenderStats stats;
};

/// What measuring leaves to its caller.
struct MeterCaller {
  /// Renders in the caller's way: progress, interruption.
  std::function<RenderResult(const Scene& scene, const RenderOptions& how)> render;
  /// Tells a sentence on what a reading lacks.
  std::function<void(const std::string& warning)> warn;
  /// What its user calls the error to stop at.
  const char* error_name;
  bool strict = false;  ///< What makes figures wrong from the start is an error, not a warning.
};

/// The meters of these names in the scene's order, all of them for none. Throws Error{usage} at `asked_by`
/// for a name that no meter has.
[[nodiscard]] std::vector<const Meter*> chosen_meters(const MeteredScene& scene,
                                                      const std::vector<std::string>& names,
                                                      const std::string& asked_by);

/// Renders the scene as the meter sees it, which `scene_of` built, and reads the meter. A target error is
/// that of the meter's three figures. Memory is counted in `inputs` meanwhile. Throws Error{resource} for too
/// large a film, and Error{scene} where the caller is strict and light is missing. What lies on what is the
/// same for all meters of a scene, so that the caller tells it, by `hidden_sheet` and `hidden_lamp`.
[[nodiscard]] MeterMeasurement measure_meter(Scene scene, const Meter& meter, RenderOptions how,
                                             const MeterCaller& caller, Inputs& inputs);

}  // namespace abbe
