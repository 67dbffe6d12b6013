#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include <pybind11/pybind11.h>

#include "description/scene.h"
#include "io/inputs.h"
#include "io/json.h"
#include "scene/scene.h"
#include "transport/plan/plan.h"

namespace abbe::python {

/// Where a scene is read from.
struct SceneSource {
  std::filesystem::path name;                   ///< The file, or "dict"; recorded in films.
  std::shared_ptr<const SourceText> text = {};  ///< Text of a dict.
  std::filesystem::path folder = {};            ///< Folder of the files that a dict names.
  std::vector<Override> overrides = {};         ///< Keywords over a file.
};
/// The source for a path, a dict or None. Keywords replace keys at the top level.
[[nodiscard]] SceneSource source_of(const pybind11::object& source, const pybind11::object& folder,
                                    const pybind11::dict& keywords);

/// A scene in Python: built, and as described. It does not change once its white is resolved, so that threads
/// may render it at once.
class SceneHandle {
 public:
  /// Arguments of the class in Python: a path, a dict or nothing, and keywords that replace keys at the top
  /// level.
  SceneHandle(const pybind11::object& source, const pybind11::object& folder, const pybind11::dict& keywords);

  /// `scene` lacks the data for pictures; callers hold the GIL. `with_white` returns the scene after a call
  /// has resolved the white and the integrator, on that many threads; callers need not hold the GIL.
  [[nodiscard]] const abbe::Scene& scene() const { return scene_; }
  [[nodiscard]] const abbe::Scene& with_white(int threads);
  /// Guiding data that pilots have trained by then.
  [[nodiscard]] const std::shared_ptr<const GuidingData>& guiding_data() const { return guiding_data_; }

  [[nodiscard]] const spec::Scene& scene_spec() const { return scene_spec_; }
  /// Name recorded in films and used in messages.
  [[nodiscard]] const std::filesystem::path& name() const { return name_; }
  /// Source from which the scene can be read again after a change of the current directory.
  [[nodiscard]] const SceneSource& source() const { return source_; }
  /// The files that were read, and the memory that the scene takes.
  [[nodiscard]] const Inputs& inputs() const { return inputs_; }

 private:
  std::filesystem::path name_;
  SceneSource source_;
  Inputs inputs_;
  spec::Scene scene_spec_;
  abbe::Scene scene_;
  std::mutex mutex_;
  bool has_white_ = false;
  std::shared_ptr<const GuidingData> guiding_data_;
};

/// Adds the class `Scene`, and `help`.
void add_scene(pybind11::module_& module);

}  // namespace abbe::python
