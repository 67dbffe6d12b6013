#pragma once

#include <filesystem>
#include <optional>

#include "develop/develop.h"
#include "io/inputs.h"

namespace abbe {

/// Reads a film as it was rendered, or one that was developed into parts before. Throws Error{input} for a
/// file that is none, for values that are no numbers and for negative variances; Error{resource} beyond the
/// memory that `inputs` has left.
[[nodiscard]] Image read_film(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Writes an .exr of parts: the exposure and its variance, with a read-out the electrons and the codes, and
/// where a display can show them the `planes` of `display_planes` as linear Rec.709, `scale` being what they
/// are multiplied by (chosen from the image when absent). Throws Error{output}.
void write_parts(const std::filesystem::path& path, const DevelopedFilm& developed, const Image& planes,
                 const FilmSensor& sensor, std::optional<double> scale);

/// Writes a picture of the `planes` of `display_planes` for displays. Throws what `require_display` does, and
/// Error{output}.
void write_display(const std::filesystem::path& path, const Image& planes, const FilmSensor& sensor);

/// Writes the codes, a plane each, as a 16-bit picture. Throws Error{output}.
void write_raw(const std::filesystem::path& path, const DevelopedFilm& developed);

}  // namespace abbe
