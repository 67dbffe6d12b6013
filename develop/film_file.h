#pragma once

#include <filesystem>

#include "develop/develop.h"
#include "io/inputs.h"

namespace abbe {

/// Throws Error{input}, which names `path`, channel and pixel, for a value that is not finite and for a
/// negative variance. Variances may be infinite: the square of an error may exceed single precision.
void require_finite(const Image& film, const std::filesystem::path& path);

/// Reads an .exr film as rendered, or the exposure and variance of one developed into parts. A single-part
/// EXR need not be a film. Throws as `read_exr_parts` and `require_finite`, and Error{input} for several
/// parts without the name "exposure". `inputs` limits the memory; nullptr is no limit.
[[nodiscard]] Image read_film(const std::filesystem::path& path, Inputs* inputs = nullptr);

/// Writes an .exr with the exposure and its variance as parts; with a readout also electrons and codes. If
/// the sensor has a display transform, another part holds `planes` (of `display_planes`) as linear Rec.709,
/// with `display_white` at 1. Throws Error{output} if the file cannot be written.
void write_parts(const std::filesystem::path& path, const DevelopedFilm& developed, const Image& planes,
                 const FilmSensor& sensor);

/// Writes `planes` (of `display_planes`) as an 8-bit picture for displays, in which `display_white` is white.
/// Throws Error{usage} as `require_display`, and Error{output}.
void write_display(const std::filesystem::path& path, const Image& planes, const FilmSensor& sensor);

/// Throws Error{usage} unless films can be developed into files of this extension. It is `.exr` for parts, or
/// for raw files `.tif`, `.tiff`, `.png`, `.dng`, `.fits` or `.fit`.
void require_developed_extension(const std::filesystem::path& path);

/// True if a developed file with this extension holds codes: every extension but `.exr`.
[[nodiscard]] bool is_raw_file(const std::filesystem::path& path);

/// Writes the codes of all planes of the sensor, which must have a readout, in the format of the extension:
/// 16-bit picture, DNG or FITS. Throws Error{output}.
void write_raw(const std::filesystem::path& path, const DevelopedFilm& developed, const FilmSensor& sensor);

}  // namespace abbe
