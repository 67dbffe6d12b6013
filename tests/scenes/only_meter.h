#pragma once

#include <string>
#include <vector>

#include "results/measure_meter.h"
#include "tests/scenes/scene_fixture.h"

namespace abbe::test {

/// A meter and its scene as it sees it.
struct OnlyMeter {
  Meter meter;
  Scene scene;
};

/// The only meter of a scene as written, with some settings replaced.
inline OnlyMeter only_meter(const std::string& scene, const std::vector<Override>& settings = {}) {
  const auto path =
      std::filesystem::temp_directory_path() / ("abbe_meter_" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << scene;
  Diagnostics diagnostics;
  const auto metered = load_meters(path, settings, diagnostics);
  std::filesystem::remove(path);
  if (!metered) throw Error(ErrorCode::internal, "meters", diagnostics.text());
  const Meter& meter = metered->meters.front();
  auto built = scene_of(*metered, meter, diagnostics);
  if (!built) throw Error(ErrorCode::internal, meter.name, diagnostics.text());
  return {meter, std::move(*built)};
}

/// What that meter reads.
inline MeterReading read(const std::string& scene, const std::vector<Override>& settings = {}) {
  const OnlyMeter only = only_meter(scene, settings);
  return read_meter(only.meter, render(only.scene, {}).film, only.scene.exposure_s);
}

}  // namespace abbe::test
