#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/camera.h"
#include "description/light.h"
#include "description/material.h"
#include "description/meter.h"
#include "description/render.h"
#include "description/sensor.h"
#include "description/shape.h"
#include "description/white.h"

namespace abbe::spec {

inline constexpr double kFormatVersion = 1;

enum class Unit { m, cm, mm, um, in };
[[nodiscard]] schema::Kind units();
/// The length of one [m].
[[nodiscard]] double metres(Unit unit);

/// What is written, and how.
struct Output {
  std::optional<std::string> image;
  std::optional<std::string> display;
  std::optional<double> exposure;
  std::optional<White> white;
};

/// All that a scene file says.
struct Scene {
  std::optional<std::string> schema;
  double version = kFormatVersion;
  Unit units = Unit::m;
  std::optional<Camera> camera;
  std::optional<Sensor> sensor;
  Meters meters;
  Materials materials;
  std::vector<schema::Named<Object>> objects;
  std::vector<Shape> shapes;
  std::vector<Light> lights;
  std::optional<Render> render;
  std::optional<Output> output;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Scene>);

}  // namespace abbe::spec

namespace abbe::description {

/// The scene, not yet recentred, as its camera sees it, or as one of its meters does. Everything wrong with
/// it is reported, of what is sound of it when some is not.
[[nodiscard]] abbe::Scene build(const spec::Scene& scene, LoadContext& context, const Meter* meter = nullptr);
/// The meters of the scene, likewise.
[[nodiscard]] std::vector<Meter> build_meters(const spec::Scene& scene, LoadContext& context);

}  // namespace abbe::description
