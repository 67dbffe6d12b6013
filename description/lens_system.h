#pragma once

#include <optional>
#include <string>
#include <variant>

#include "description/iris.h"
#include "description/lens.h"
#include "description/load_context.h"
#include "description/sensor.h"
#include "io/schema/fields.h"
#include "scene/camera/lens_system.h"
#include "scene/camera/model.h"

namespace abbe::spec {

enum class InfinityKeyword { infinity };
/// Distance from the lens to the plane in focus, in scene units and above 0; or infinity. That of a
/// lens system is measured from its first surface.
using FocusDistance = std::variant<double, InfinityKeyword>;
// Key tables and forms by which scene files are read, written and documented.
[[nodiscard]] schema::ValueType value_type(schema::Tag<FocusDistance>);

/// A lens: its name in `data/lens`, the name of a .json, .zmx or .dat file, or the contents of such a .json.
using Prescription = std::variant<std::string, Lens>;
[[nodiscard]] schema::ValueType value_type(schema::Tag<Prescription>);

/// Film position for a focus distance: the paraxial focus, or the smallest axial spot over all wavelengths of
/// the prescription.
enum class FilmPlane { paraxial, best };
/// A real lens in a scene, given by its prescription.
struct LensSystem {
  schema::Located<Prescription> prescription;
  /// If absent, the film stays at the image plane that the prescription gives.
  std::optional<FocusDistance> focus_distance;
  /// Film position for `focus_distance`, without which it has no effect; `best` if absent.
  std::optional<schema::Located<FilmPlane>> focus;
  /// Focal length over the diameter of the axial beam, to which the stop is closed. If absent, the stop is
  /// that of the prescription.
  std::optional<schema::Located<double>> f_number;
  Iris iris;
  bool ghosts = false;  ///< True to render ghosts: light that two surfaces of the lens reflect.
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<LensSystem>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the lens with the pose `frame` in front of the film of `sensor`. The channels of `sensor` must have
/// been built. Reports errors to `context.diagnostics` and returns nothing after one:
/// - an error of the prescription, reported at its position in the prescription;
/// - a lens that cannot focus at the requested distance or open to the requested f-number;
/// - a spectral sensor: a real lens images different wavelengths to different pixels;
/// - a film that the lens does not illuminate.
/// Warns of settings without effect and of indices without data where the sensor responds. Throws
/// Error{resource} if the memory limit is exceeded while a file is read.
[[nodiscard]] std::optional<LensSystem> build(const spec::LensSystem& lens, const CameraFrame& frame,
                                              const Sensor& sensor, LoadContext& context);

}  // namespace abbe::description
