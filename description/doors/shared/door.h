#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "description/scene.h"
#include "io/diagnostics.h"
#include "io/inputs.h"

// What the readers of other renderers' scenes share.
namespace abbe::doors {

/// Something that another renderer's scene says and the converted one says otherwise, or not at all.
struct Note {
  SourcePosition where;  ///< Of the first such thing.
  std::string text;
  std::size_t count = 1;  ///< Of such things.
};

/// What a reader of another renderer's scene fills.
struct Door {
  Diagnostics& diagnostics;
  Inputs* inputs;                ///< Of the command, if it keeps account of them.
  std::filesystem::path folder;  ///< Of the scene to be written, whose files are named as from there.
  std::string file;              ///< Of the other renderer's scene, by which too much memory is reported.
  spec::Scene scene{};
  std::vector<Note> notes{};
  std::size_t included = 0;          ///< Files that the other renderer's scene has included so far.
  std::string surface_integrator{};  ///< The other scene's integrator, where it leaves media out.
  std::size_t values = 0;            ///< JSON values that the scene to be written has at most.
  std::size_t text_bytes = 0;        ///< Length of the names and other texts in it.

  /// Remembers that something was approximated or dropped; the same text is kept once, and counted.
  void note(const SourcePosition& where, const std::string& text);
  /// Reports what is wrong at `where`, and gives false.
  bool refuse(const SourcePosition& where, std::string what);
  /// Sets how many events a path of the scene's render may have; that fewer than one are one here is noted.
  void limit_depth(int events, const SourcePosition& where);
  /// Notes, where the other scene's integrator leaves media out, that this one at `where` is looked at here.
  void note_medium(const SourcePosition& where);
  /// Counts memory that is about to be taken. Throws Error{resource} when it is too much.
  void take_memory(std::size_t bytes) const;
  /// The text of a file, whose memory is counted before it is read. Reports a file that is no text.
  [[nodiscard]] std::shared_ptr<const SourceText> read(const std::filesystem::path& file) const;
  /// Counts the memory of JSON values and texts that the scene to be written is about to have.
  void add_values(std::size_t count, std::size_t bytes_of_texts = 0);
  /// Memory that writing the scene takes [bytes]: its JSON tree and the text.
  [[nodiscard]] std::size_t bytes_to_write() const;
  /// The name by which the scene to be written finds a file: as from its folder, but for what is named from
  /// the root and lies elsewhere.
  [[nodiscard]] std::string name_of(const std::filesystem::path& file) const;
  /// Counts a file that is read. False, after an error at `where`, if there is no such regular file.
  bool take_file(const std::filesystem::path& file, const SourcePosition& where);
  /// Counts a file that the scene includes at `where`. False, after an error, if these are too many: a few
  /// small files that include one another twice each would go on for ever.
  bool take_included(const SourcePosition& where);
  /// The name itself, or, where materials have it already, the name with a number.
  [[nodiscard]] std::string free_material_name(const std::string& name) const;
  /// Adds a material under a name that is still free, and gives that name.
  std::string add_material(const std::string& name, spec::Material material);
};

/// JSON values of a shape, an instance, a light or a material at most, its vertices and spectra left out.
inline constexpr std::size_t kValuesOfOne = 40;

/// Memory counted for a value that owns it; a copy of the value counts as much again.
class OwnedMemory {
 public:
  OwnedMemory() = default;
  OwnedMemory(const Door& account, std::size_t bytes) : account_(&account) { grow_by(bytes); }
  OwnedMemory(const OwnedMemory& other) : account_(other.account_) { grow_by(other.bytes_); }
  OwnedMemory(OwnedMemory&& other) noexcept
      : account_(other.account_), bytes_(std::exchange(other.bytes_, 0)) {}
  OwnedMemory& operator=(OwnedMemory other) noexcept {
    std::swap(account_, other.account_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~OwnedMemory() {
    if (bytes_ > 0 && account_->inputs != nullptr) account_->inputs->give_back_memory(bytes_);
  }
  /// Counts more. Throws as `Door::take_memory` does.
  void grow_by(std::size_t bytes) {
    if (bytes > 0) account_->take_memory(bytes);
    bytes_ += bytes;
  }

 private:
  const Door* account_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace abbe::doors
