#pragma once

#include <filesystem>

#include "develop/develop.h"
#include "io/inputs.h"

namespace abbe {

/// Throws Error{input} naming `path`, channel and pixel for a value that is no number, and for a negative
/// variance. Variances may be infinite: they are the squares of errors whose values may be as large as single
/// precision holds.
void require_finite(const Image& film, const std::filesystem::path& path);

/// Reads a film as it was rendered, or one that was developed into parts before. Throws Error{input} for a
/// file that is none, for values that are no numbers and for negative variances; Error{resource} beyond the
/// memory that `inputs` has left.
[[nodiscard]] Image read_film(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Writes an .exr of parts: the exposure and its variance, and with a read-out the electrons and the codes.
/// If a display can show them, a part has the `planes` of `display_planes` as linear Rec.709, in which 1 is
/// `shown_as_white`. Throws Error{output}.
void write_parts(const std::filesystem::path& path, const DevelopedFilm& developed, const Image& planes,
                 const FilmSensor& sensor);

/// Writes a picture of the `planes` of `display_planes` for displays. Throws what `require_display` does, and
/// Error{output}.
void write_display(const std::filesystem::path& path, const Image& planes, const FilmSensor& sensor);

/// Throws Error{usage} for the name of a file that no film is developed into: `.exr` for parts, and of raw
/// files `.tif`, `.tiff`, `.png`, `.dng`, `.fits` and `.fit`.
void require_developed_extension(const std::filesystem::path& path);

/// Whether a file of such a name holds codes.
[[nodiscard]] bool is_raw_file(const std::filesystem::path& path);

/// Writes the codes, a plane each, as a file of the kind that the extension names: 16-bit picture, DNG or
/// FITS. Throws Error{output}.
void write_raw(const std::filesystem::path& path, const DevelopedFilm& developed, const FilmSensor& sensor);

}  // namespace abbe
