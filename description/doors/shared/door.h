#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
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
  spec::Scene scene{};
  std::vector<Note> notes{};
  std::size_t included = 0;          ///< Files that the other renderer's scene has included so far.
  std::string surface_integrator{};  ///< The other scene's integrator, where it leaves media out.

  /// Remembers that something was approximated or dropped; the same text is kept once, and counted.
  void note(const SourcePosition& where, const std::string& text);
  /// Reports what is wrong at `where`, and gives false.
  bool refuse(const SourcePosition& where, std::string what);
  /// Sets how many events a path of the scene's render may have; that fewer than one are one here is noted.
  void limit_depth(int events, const SourcePosition& where);
  /// Notes, where the other scene's integrator leaves media out, that this one at `where` is looked at here.
  void note_medium(const SourcePosition& where);
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

}  // namespace abbe::doors
