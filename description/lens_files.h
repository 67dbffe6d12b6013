#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "description/lens.h"
#include "io/diagnostics.h"
#include "io/inputs.h"
#include "lens/system.h"

namespace abbe {

/// Reads and builds a lens, which `name` gives as one of:
/// - the name of a prescription of `data/lens`;
/// - a prescription as `.json`;
/// - a sequential lens of Zemax as `.zmx`;
/// - a table of radius, thickness, index and diameter in pbrt's format as `.dat`.
/// File names are relative to the working directory. Errors are reported at their position in the file, and
/// an unknown name at `where`. Returns nothing if `diagnostics` then have an error, also an earlier one. A
/// lens without a title gets its file name. `inputs`, if given, records every file that is read.
/// `wavelengths_nm` are those of `description::build`. Throws Error{input} if the folder of the shipped
/// tables does not exist, and Error{resource} if the memory limit of `inputs` is exceeded.
[[nodiscard]] std::optional<lens::System> load_lens(const std::string& name, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr,
                                                    const SourcePosition& where = {},
                                                    const std::vector<double>& wavelengths_nm = {});

}  // namespace abbe

namespace abbe::description::lenses {

/// A line of a lens file, split into words. It has at least one word.
struct Line {
  struct Word {
    std::string text;
    std::size_t offset;  ///< Byte offset in `source->text`.
  };
  std::shared_ptr<const SourceText> source;
  std::vector<Word> words;
  bool indented;  ///< True if the line starts with a blank.

  /// The first word.
  [[nodiscard]] const std::string& keyword() const { return words.front().text; }
  /// Position of word number `word`, counted from 0; of the last word if the line has fewer words.
  [[nodiscard]] SourcePosition where(std::size_t word = 0) const;
  /// A word of the line, counted from 0 for the keyword. Nothing if the line has fewer words.
  [[nodiscard]] std::optional<std::string> text(std::size_t word) const;
  /// A word as a number, or as one in (0, 1e9]. Reports any other or a missing word, with ErrorCode::input,
  /// and returns nothing.
  [[nodiscard]] std::optional<double> number(std::size_t word, Diagnostics& diagnostics) const;
  [[nodiscard]] std::optional<double> positive(std::size_t word, Diagnostics& diagnostics) const;
  /// All words from number `first` on as numbers, up to the first that is not a number. Reports nothing.
  [[nodiscard]] std::vector<double> numbers(std::size_t first) const;
};

/// The lines of a text in order, without those that are empty or have only blanks.
[[nodiscard]] std::vector<Line> lines_of(const std::shared_ptr<const SourceText>& source);

}  // namespace abbe::description::lenses

namespace abbe::description {

/// Reads a sequential lens of Zemax (`.zmx`, in UTF-8, UTF-16 or Windows-1252). It reads:
/// - title, unit, aperture (ENPD, FNUM, FLOA) and wavelengths;
/// - fields along y: angles, object heights, paraxial image heights;
/// - of STANDARD and EVENASPH surfaces: curvature, thickness, glass, conic constant, coefficients, stop and
///   clear aperture.
/// Glasses are looked up in the catalogues that the file names, else in all catalogues, with a warning.
/// Coatings, vignetting factors and weights of wavelengths are ignored with a warning. Any other data that
/// would change the light paths is an error. Lengths of the result are in mm. Returns nothing if
/// `diagnostics` then have an error.
[[nodiscard]] std::optional<spec::Lens> read_zemax(const std::filesystem::path& file,
                                                   Diagnostics& diagnostics);

}  // namespace abbe::description
