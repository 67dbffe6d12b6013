#pragma once

#include <optional>
#include <string>
#include <variant>

#include "description/iris.h"
#include "description/lens.h"
#include "description/load_context.h"
#include "description/sensor.h"
#include "io/schema/fields.h"
#include "scene/camera/frame.h"
#include "scene/camera/lens_system.h"

namespace abbe::spec {

enum class InfinityKeyword { infinity };
/// Distance from the first surface to the plane in focus, in scene units, or infinity.
using FocusDistance = std::variant<double, InfinityKeyword>;
[[nodiscard]] schema::ValueType value_type(schema::Tag<FocusDistance>);

/// A lens: its name, a file, or the contents of such a file.
using Prescription = std::variant<std::string, Lens>;
[[nodiscard]] schema::ValueType value_type(schema::Tag<Prescription>);

enum class FilmPlane { paraxial, best };
/// A real lens in a scene, given by its prescription.
struct LensSystem {
  schema::Located<Prescription> prescription;
  std::optional<FocusDistance>
      focus_distance;  ///< If absent, the film stays at the image of the prescription.
  std::optional<schema::Located<FilmPlane>> focus;  ///< `best` if absent.
  std::optional<schema::Located<double>> f_number;
  Iris iris;
  bool ghosts = false;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<LensSystem>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the lens in front of the sensor's film. Returns nothing after an error:
/// - an error of the prescription, reported at its position in the prescription;
/// - a lens that cannot focus at the requested distance or open to the requested f-number;
/// - a film that the lens does not illuminate.
[[nodiscard]] std::optional<LensSystem> build(const spec::LensSystem& lens, const CameraFrame& frame,
                                              const Sensor& sensor, LoadContext& context);

}  // namespace abbe::description
