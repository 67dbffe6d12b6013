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

/// The films of a part: its own, and those beside it of its layers and its features, as its identity tells.

/// Memory that their sums take; nothing for an identity that tells of none.
[[nodiscard]] std::optional<std::size_t> bytes_of_films(const FilmIdentity& identity, const FilmShape& shape);
/// Films of that shape, without light.
[[nodiscard]] RenderResult dark_films(const FilmIdentity& identity, const FilmShape& shape);
/// Those that have these bytes, as `sums_of` has them; nothing if there are more or fewer.
[[nodiscard]] std::optional<RenderResult> films_of(const FilmIdentity& identity, const FilmShape& shape,
                                                   std::string_view bytes);
/// Their sums, one film after another.
[[nodiscard]] std::vector<std::string_view> sums_of(const RenderResult& films);
/// Leaves what the pixels of a shape have that differs in its crop at most.
void crop_films(const FilmShape& shape, RenderResult& films);
/// Adds to films all that others have.
void add_films(RenderResult& sum, const RenderResult& films);
/// A copy of what samples of this range add to: of each film the replicates they belong to. The films that
/// have these bytes, one after another; nothing if there are more or fewer. And they put back, as if the
/// samples had never been.
[[nodiscard]] std::vector<Film> copy_of_replicates(const RenderResult& films, const SampleRange& samples);
[[nodiscard]] std::optional<std::vector<Film>> read_replicates(const RenderResult& films,
                                                               const SampleRange& samples,
                                                               std::string_view bytes);
void put_back(RenderResult& films, const std::vector<Film>& kept, const SampleRange& samples);
/// Sets the samples of all pixels that have variances.
void set_samples(RenderResult& films, const SampleRanges& samples);

/// The names of the film's own planes.
[[nodiscard]] std::vector<std::string> film_planes(const FilmIdentity& identity);

/// Relative error of the mean over the whole film, as `frame_mean_error` of its planes that count light has
/// it. Infinite where the samples of some pixels are in fewer than two replicates, so that nothing is known
/// of their variance; nothing where pixels have different samples else.
[[nodiscard]] std::optional<double> frame_mean_error(const RenderPart& part);

/// The samples that carry half of the variance of that mean, where these are too few to know its error.
[[nodiscard]] std::optional<std::uint64_t> few_samples(const RenderPart& part);

/// A film of the part's, each pixel by the samples it has, and the part's identity; where some have
/// none, or other samples than others, by `kAreasKey` which have which.
[[nodiscard]] Image developed(const Film& film, std::span<const std::string> names, const RenderPart& part);

}  // namespace abbe
