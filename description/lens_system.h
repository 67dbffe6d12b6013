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

enum class Far { infinity };
/// Of what lies in the plane in focus, or of nothing nearer than infinity.
using FocusDistance = std::variant<double, Far>;
[[nodiscard]] schema::Kind kind(schema::Tag<FocusDistance>);

/// A lens by its name or file, or what such a file says.
using Prescription = std::variant<std::string, Lens>;
[[nodiscard]] schema::Kind kind(schema::Tag<Prescription>);

enum class FilmPlane { paraxial, best };
/// A lens of a prescription.
struct LensSystem {
  schema::Located<Prescription> prescription;
  std::optional<FocusDistance>
      focus_distance;  ///< The image stays where the prescription has it when absent.
  std::optional<schema::Located<FilmPlane>> focus;  ///< `best` when absent.
  std::optional<schema::Located<double>> f_number;
  Iris iris;
  bool ghosts = false;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<LensSystem>);

}  // namespace abbe::spec

namespace abbe::description {

/// The lens in front of the sensor's film. Reports what its prescription says that is wrong, where it stands,
/// a lens that cannot be in focus there or cannot be opened so far, and a film that it does not light;
/// nothing then.
[[nodiscard]] std::optional<LensSystem> build(const spec::LensSystem& lens, const CameraFrame& frame,
                                              const Sensor& sensor, LoadContext& context);

}  // namespace abbe::description
