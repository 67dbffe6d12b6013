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

/// Where a scene that Python says stands.
struct SceneSource {
  std::filesystem::path name;                   ///< What films call their scene after: the file, or "dict".
  std::shared_ptr<const SourceText> text = {};  ///< Of a dict.
  std::filesystem::path folder = {};            ///< Where the files that a dict names are looked for.
  std::vector<Override> overrides = {};         ///< Of a file.
};
/// That of a path, a dict or None, with keywords that replace keys at the top.
[[nodiscard]] SceneSource source_of(const pybind11::object& source, const pybind11::object& folder,
                                    const pybind11::dict& keywords);

/// A scene as Python holds it: built, and as it was described. It never changes once its white is settled, so
/// threads may render one scene at once.
class SceneHandle {
 public:
  /// What `pybind11` is asked for: a path, a dict or nothing, and keywords that replace keys at the top.
  SceneHandle(const pybind11::object& source, const pybind11::object& folder, const pybind11::dict& keywords);

  /// The scene without what pictures need, to be read under Python's lock; with it, once some call has
  /// settled white and integrator on that many threads, for callers without that lock.
  [[nodiscard]] const abbe::Scene& scene() const { return scene_; }
  [[nodiscard]] const abbe::Scene& with_white(int threads);
  /// What pilots have taught of it then.
  [[nodiscard]] const std::shared_ptr<const Guides>& guides() const { return guides_; }

  [[nodiscard]] const spec::Scene& said() const { return said_; }
  /// What films call their scene after, and messages its text.
  [[nodiscard]] const std::filesystem::path& name() const { return name_; }
  /// From where it can be read once more, whatever directory has become the current one.
  [[nodiscard]] const SceneSource& source() const { return source_; }
  /// What was read, with the memory it took.
  [[nodiscard]] const Inputs& inputs() const { return inputs_; }

 private:
  std::filesystem::path name_;
  SceneSource source_;
  Inputs inputs_;
  spec::Scene said_;
  abbe::Scene scene_;
  std::mutex mutex_;
  bool has_white_ = false;
  std::shared_ptr<const Guides> guides_;
};

/// Adds the class `Scene`, and `help`.
void add_scene(pybind11::module_& module);

}  // namespace abbe::python
