#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "transport/render/part.h"

namespace abbe {

// The functions below treat all films of a part alike: its main film and, if its identity records them, the
// films of its layers and its features. Identities must have the attribute `sensor_channels`.

/// Memory [bytes] of the sums of all films; empty if the identity records unknown features.
[[nodiscard]] std::optional<std::size_t> bytes_of_films(const FilmIdentity& identity, const FilmShape& shape);
/// Films of this shape whose sums are zero. `bytes_of_films` must not be empty for the arguments.
[[nodiscard]] RenderResult empty_films(const FilmIdentity& identity, const FilmShape& shape);
/// Films whose sums are `bytes`, in the order of `sums_of`; empty if the size does not match.
[[nodiscard]] std::optional<RenderResult> films_from_bytes(const FilmIdentity& identity,
                                                           const FilmShape& shape, std::string_view bytes);
/// Bytes of the sums of all films, one view per film. The views refer to `films`.
[[nodiscard]] std::vector<std::string_view> sums_of(const RenderResult& films);
/// Restricts the films to the pixels of `shape`, which may differ from theirs in nothing but the crop.
void crop_films(const FilmShape& shape, RenderResult& films);
/// Adds the sums of `films` to those of `sum`. Both must have the same films, and equal shapes except for the
/// crop; that of `sum` must enclose the other.
void add_films(RenderResult& sum, const RenderResult& films);
/// Copies, of each film, the replicates to which the samples of a range contribute.
[[nodiscard]] std::vector<Film> copy_replicates(const RenderResult& films, const SampleRange& samples);
/// Reads such copies from `bytes`, one film after another; empty if the size does not match.
[[nodiscard]] std::optional<std::vector<Film>> read_replicates(const RenderResult& films,
                                                               const SampleRange& samples,
                                                               std::string_view bytes);
/// Replaces the replicates of the samples of a range by copies that `copy_replicates` or `read_replicates`
/// returned for the same range. This undoes all later contributions to them.
void restore_replicates(RenderResult& films, const std::vector<Film>& saved, const SampleRange& samples);
/// Sets the samples of all pixels in the films that estimate variances: the main film and the layers.
void set_samples(RenderResult& films, const SampleRanges& samples);

/// Names of the planes of the main film.
[[nodiscard]] std::vector<std::string> film_planes(const FilmIdentity& identity);

/// Relative error of the mean over the whole film, for the planes that measure intensity (see the overload in
/// sensor/film). Infinite if the samples of some pixels lie in fewer than two replicates, which gives no
/// variance. Empty if pixels have different samples otherwise.
[[nodiscard]] std::optional<double> frame_mean_error(const RenderPart& part);

/// Number of samples that carry half of the variance of the mean over the whole film, if these are too few to
/// estimate its error; empty otherwise. Empty also if `frame_mean_error` is infinite or empty.
[[nodiscard]] std::optional<std::uint64_t> few_samples(const RenderPart& part);

/// Image of one film of a part, with `names` for its planes and the part's identity as attributes. Each pixel
/// is normalised by its own samples. If some pixels have none, or other samples than others, `kAreasKey`
/// lists those of each area.
[[nodiscard]] Image developed(const Film& film, std::span<const std::string> names, const RenderPart& part);

}  // namespace abbe
