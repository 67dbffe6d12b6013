#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/camera.h"
#include "description/light.h"
#include "description/material.h"
#include "description/probe.h"
#include "description/render.h"
#include "description/sensor.h"
#include "description/shape.h"
#include "description/white.h"

// The structs of namespace `spec` hold the values of a scene file as the user wrote them, in the units of the
// file. The functions `build` of namespace `description` convert them to the structs of a scene, in SI units.
// The functions `fields` and `kind` give the key tables by which these structs are read, written and
// documented.
namespace abbe::spec {

/// Version of the scene format: the only allowed value of the key "abbe".
inline constexpr double kFormatVersion = 1;

/// Unit of length of a scene file; `um` is the micrometre, `in` the inch of 25.4 mm.
enum class Unit { m, cm, mm, um, in };
/// The form in which scene files write a unit of length.
[[nodiscard]] schema::ValueType units();
/// Length of a unit in metres.
[[nodiscard]] double metres(Unit unit);

/// Files that a render writes, relative to the working directory. A file whose name is absent is not written.
struct Output {
  std::optional<std::string> image;    ///< The film as an EXR file.
  std::optional<std::string> display;  ///< The picture as a PNG, JPEG or TIFF file.
  std::optional<double> exposure;      ///< Film value shown as diffuse white, above 0; automatic if absent.
  /// Reference white of the picture; the light that exposes the film most if absent.
  std::optional<White> white;
};

/// The contents of a scene file.
struct Scene {
  std::optional<std::string> schema;  ///< Location of the JSON Schema, for editors; not used.
  double version = kFormatVersion;
  Unit units = Unit::m;
  std::optional<Camera> camera;  ///< May be absent in a scene with meters.
  std::optional<Sensor> sensor;  ///< Required with a camera.
  Meters meters;
  Materials materials;
  std::vector<schema::Named<Object>> objects;
  std::vector<Shape> shapes;
  std::vector<Light> lights;
  std::optional<Render> render;
  std::optional<Output> output;
  SourcePosition where;
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Scene>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the scene for its camera, or for `meter` if given, and sets members of the context. The scene is
/// recentred but not yet committed; see `abbe::Scene::commit`. Reports every error to `context.diagnostics`;
/// after one the scene is incomplete. Throws Error{resource} if the memory limit is exceeded, and
/// Error{input} for an unreadable environment image.
[[nodiscard]] abbe::Scene build(const spec::Scene& scene, LoadContext& context, const Meter* meter = nullptr);
/// Builds the meters of the scene in the order of the file, with lengths in metres, and sets
/// `context.unit_m`. Reports every error to `context.diagnostics`; leaves out a meter whose surface has an
/// error.
[[nodiscard]] std::vector<Meter> build_meters(const spec::Scene& scene, LoadContext& context);

}  // namespace abbe::description
