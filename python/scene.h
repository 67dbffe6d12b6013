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

/// The file or dict that a scene is read from.
struct SceneSource {
  /// The file, or "dict"; recorded in films.
  std::filesystem::path name;
  std::shared_ptr<const SourceText> text = {};  ///< JSON of a dict and its keywords; nullptr for a file.
  std::filesystem::path folder = {};            ///< Folder of the files that a dict names.
  std::vector<Override> overrides = {};         ///< Keywords that replace keys of a file.
};
/// The source for `source`: a path, a dict, or None for the empty dict. `keywords` replace keys at the top
/// level of the scene. `folder` is the folder of files that a dict names; None is the current one. Throws
/// Error{usage} for a folder with a path, InvalidInput for values that JSON cannot represent
/// (`to_json`), and TypeError for other objects. Requires the GIL.
[[nodiscard]] SceneSource source_of(const pybind11::object& source, const pybind11::object& folder,
                                    const pybind11::dict& keywords);

/// A scene in Python: built, and as described. It does not change once `with_white` has resolved its white
/// and integrator, so that threads may render it at once.
class SceneHandle {
 public:
  /// Loads the scene of `source_of`, whose arguments these are, and issues warnings. Throws as `source_of`,
  /// `load_scene` and `accepted`. Requires the GIL, which it releases while it loads.
  SceneHandle(const pybind11::object& source, const pybind11::object& folder, const pybind11::dict& keywords);

  /// The scene, perhaps before `with_white` has resolved it. Requires the GIL.
  [[nodiscard]] const abbe::Scene& scene() const { return scene_; }
  /// The scene with its white and its integrator. The first call resolves them by pilot rays on `threads`
  /// threads, or one per processor for 0; other threads wait meanwhile. Throws as `resolve_white`.
  /// The caller must have released the GIL by `GilReleased`: the function waits for other threads, and
  /// acquires the GIL itself to change the scene.
  [[nodiscard]] const abbe::Scene& with_white(int threads);
  /// Guiding data that the pilots of `with_white` trained; nullptr if there are none.
  [[nodiscard]] const std::shared_ptr<const GuidingData>& guiding_data() const { return guiding_data_; }

  /// The scene as described, with defaults; later resolutions do not change it.
  [[nodiscard]] const spec::Scene& scene_spec() const { return scene_spec_; }
  /// Name in films and messages: the path as the user gave it, or "dict".
  [[nodiscard]] const std::filesystem::path& name() const { return name_; }
  /// Source with an absolute path or folder, from which the scene can be read again.
  [[nodiscard]] const SceneSource& source() const { return source_; }
  /// The files that were read, and the memory that is reserved for the scene.
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

}  // namespace abbe::python
