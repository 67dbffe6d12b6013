#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "description/scene.h"
#include "io/diagnostics.h"
#include "io/inputs.h"

// Common state and functions of the importers. "Reports" means an error in `diagnostics`; "notes" means an
// entry in `notes`, which becomes a warning. Functions throw Error{resource} if the memory limit of `inputs`
// is exceeded; without `inputs` there is no limit.
namespace abbe::importers {

/// A property of the source scene that is approximated or dropped.
struct Note {
  SourcePosition where;  ///< Position of the first occurrence.
  std::string text;
  std::size_t count = 1;  ///< Number of occurrences.
};

/// State of an import: the scene to be written and its notes. One instance per import and thread.
struct SceneImporter {
  Diagnostics& diagnostics;
  Inputs* inputs;                ///< Account of the command's files and memory, or nullptr.
  std::filesystem::path folder;  ///< Folder of the scene to be written; its file names are relative to it.
  std::string file;              ///< Name of the source scene, for errors about memory.
  spec::Scene scene{};
  std::vector<Note> notes{};
  std::size_t included = 0;          ///< Number of files included so far.
  std::string surface_integrator{};  ///< Name of the source scene's integrator if it ignores media.
  std::size_t values = 0;      ///< Upper bound for the number of JSON values in the scene to be written.
  std::size_t text_bytes = 0;  ///< Size of names and other texts in it [bytes].

  /// Notes an approximated or dropped property. Equal texts are stored once and counted.
  void note(const SourcePosition& where, const std::string& text);
  /// Reports an error at `where`; `refuse` returns false, `fail` nothing.
  bool refuse(const SourcePosition& where, std::string what);
  std::nullopt_t fail(const SourcePosition& where, std::string what, ErrorCode code = ErrorCode::scene);
  /// True if `name` is one of `names`. Otherwise reports it at `where` with the nearest one; `what` is the
  /// noun for them.
  bool is_known(std::string_view what, const std::string& name, const std::vector<std::string>& names,
                const SourcePosition& where);
  /// Sets the maximum number of scattering events of a path. A value below 1 becomes 1, which is noted.
  /// `scene.render` must be set.
  void limit_depth(int depth, const SourcePosition& where);
  /// Notes a medium at `where` if the source scene's integrator ignores media: Abbe does not.
  void note_medium(const SourcePosition& where);
  /// Reserves memory in `inputs` until the command ends. Throws Error{resource} if it exceeds the limit.
  void reserve_memory(std::size_t bytes) const;
  /// Reads a UTF-8 text file and adds it to `inputs`. Reports an unreadable file and returns nullptr.
  [[nodiscard]] std::shared_ptr<const SourceText> read(const std::filesystem::path& file) const;
  /// Reserves memory for `count` JSON values and `bytes_of_texts` bytes of texts of the scene to be written.
  void reserve_values(std::size_t count, std::size_t bytes_of_texts = 0);
  /// Memory for writing the scene [bytes]: its JSON tree and its text.
  [[nodiscard]] std::size_t bytes_to_write() const;
  /// File name relative to the folder of the scene to be written. An absolute name is kept if the file is
  /// outside that folder.
  [[nodiscard]] std::string name_of(const std::filesystem::path& file) const;
  /// Adds an input file to the account. False, after an error at `where`, if it is not a regular file.
  bool check_file(const std::filesystem::path& file, const SourcePosition& where);
  /// Counts a file that is included at `where`. False, after an error with ErrorCode::resource, from the
  /// 10001st file on: small files that include each other twice would never end.
  bool count_include(const SourcePosition& where);
  /// Adds a material and returns its name: `name`, or "`name` 2", "`name` 3" and so on if that is taken.
  std::string add_material(const std::string& name, spec::Material material);
};

/// Upper bound for the JSON values of a shape, instance, light or material without vertices and spectra.
inline constexpr std::size_t kValuesPerItem = 40;

/// Reserved memory of a value that owns it, released by the destructor. A copy reserves as much again and may
/// throw Error{resource}; a moved-from object holds nothing. The importer must outlive it.
class OwnedReservation {
 public:
  OwnedReservation() = default;
  OwnedReservation(const SceneImporter& account, std::size_t bytes) : account_(&account) { grow_by(bytes); }
  OwnedReservation(const OwnedReservation& other) : account_(other.account_) { grow_by(other.bytes_); }
  OwnedReservation(OwnedReservation&& other) noexcept
      : account_(other.account_), bytes_(std::exchange(other.bytes_, 0)) {}
  OwnedReservation& operator=(OwnedReservation other) noexcept {
    std::swap(account_, other.account_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~OwnedReservation() {
    if (bytes_ > 0 && account_->inputs != nullptr) account_->inputs->release_memory(bytes_);
  }
  /// Reserves more. Throws Error{resource} like `SceneImporter::reserve_memory`. A default-constructed object
  /// has no importer and must not grow.
  void grow_by(std::size_t bytes) {
    if (bytes > 0) account_->reserve_memory(bytes);
    bytes_ += bytes;
  }

 private:
  const SceneImporter* account_ = nullptr;
  std::size_t bytes_ = 0;
};

/// Falloff of a spot's intensity from 1 at an inner angle to 0 at an outer angle from its axis. At the angle
/// a between them, let t = (cos a - cos outer)/(cos inner - cos outer). The intensity is
/// - smooth_cosine: 3t^2 - 2t^3;
/// - squared_cosine: t^2;
/// - linear_angle: (outer - a)/(outer - inner).
enum class Falloff { smooth_cosine, squared_cosine, linear_angle };

/// Half angle [degrees] of a cone with a hard edge and the same flux as a spot of the same axial intensity.
/// The spot has full intensity up to `inner_deg` and none from `outer_deg` on. The replacement is noted at
/// `where`. Returns `outer_deg`, without a note, if `inner_deg` is not smaller.
[[nodiscard]] double hard_cone(double inner_deg, double outer_deg, Falloff falloff,
                               const SourcePosition& where, SceneImporter& importer);

// Readers of scene files, one per format. Each fills `importer.scene`, and returns false if the diagnostics
// have an error.

/// Reads the default or first scene of a glTF 2.0 or GLB file, in metres: one shape per material, one camera,
/// and the lights of KHR_lights_punctual. Adds a camera that sees all meshes along -z if there is none.
bool read_gltf_scene(const std::filesystem::path& file, SceneImporter& importer);
/// Reads a scene file of Mitsuba 3; its unit of length counts as a metre.
bool read_mitsuba(const std::filesystem::path& file, SceneImporter& importer);
/// Reads a scene file of pbrt-v4; its unit of length counts as a metre. Stops at errors after which the
/// syntax is ambiguous.
bool read_pbrt(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers
