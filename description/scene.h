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

// The structs of namespace `spec` hold the values of a scene file as the user wrote them, in the units of the
// file. The functions `build` of namespace `description` convert them to the structs of a scene, in SI units.
// The functions `fields` and `kind` give the key tables by which these structs are read, written and
// documented.
namespace abbe::spec {

inline constexpr double kFormatVersion = 1;

enum class Unit { m, cm, mm, um, in };
/// The kind of a unit of length.
[[nodiscard]] schema::ValueType units();
/// Length of a unit in metres.
[[nodiscard]] double metres(Unit unit);

/// Files that a render writes.
struct Output {
  std::optional<std::string> image;
  std::optional<std::string> display;
  std::optional<double> exposure;
  std::optional<White> white;
};

/// The contents of a scene file.
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

/// Builds the scene for its camera, or for `meter` if given. Reports every error. After an error the parts
/// without errors are still checked, and the scene is incomplete.
[[nodiscard]] abbe::Scene build(const spec::Scene& scene, LoadContext& context, const Meter* meter = nullptr);
/// Builds the meters of the scene. Reports every error.
[[nodiscard]] std::vector<Meter> build_meters(const spec::Scene& scene, LoadContext& context);

}  // namespace abbe::description
