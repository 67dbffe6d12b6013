#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "transport/render/render.h"
#include "transport/render/sampled_areas.h"

namespace abbe {

/// The key under which a film's identity has the samples of the whole render, as `--spp` or its scene state
/// them; absent where time or error decide.
inline constexpr const char* kStatedSamplesKey = "samples_stated";
/// The keys of the machine code and the processor that a film's bits depend on. Images do not tell them, so
/// that what different machines see alike is the same file.
inline constexpr const char* kBuildKey = "build";
inline constexpr const char* kInstructionSetKey = "instruction_set";

/// What a film is a film of, by name: version, scene, seed and all else its values are a function of, besides
/// the samples. `sensor_channels` lists the film's channels, separated by commas. Some tell no films apart:
/// `scene`, the name of the scene file, `kStatedSamplesKey`, and how pictures show it: `to_xyz_d65`, fitted
/// on the machine that rendered, or `no_picture`, `white`, `white_xy` and `white_asked`.
using FilmIdentity = std::map<std::string, std::string>;

/// Some samples of some pixels of a render. Parts of one identity but for their crops add up, in any order
/// and grouping, to the film that one render of all their samples gives, bit for bit.
struct RenderPart {
  FilmIdentity identity;
  RenderResult result;      ///< Of which `samples` are those of every area; none where they differ.
  SampledAreas areas = {};  ///< Empty where all pixels of the film hold the samples of the result.
};

/// What the file of a part tells before its sums.
struct PartHeader {
  FilmIdentity identity;
  FilmShape shape;
  SampledAreas areas;
};

/// What the file of a part would tell before its sums.
[[nodiscard]] PartHeader header_of(const RenderPart& part);

/// Writes the exact sums, atomically. Throws Error{output}.
void write_part(const std::filesystem::path& path, const FilmIdentity& identity, const RenderResult& result,
                const SampledAreas& areas = {});

/// Throws Error{input} for a file that is missing, torn, damaged, no part, or without a sample of any pixel
/// yet. Of one saved amid a pass without photons the pixels whose tiles were done have its samples too; where
/// no pass was done before, its film is that of these pixels. With photons, the film is that before the pass.
[[nodiscard]] RenderPart read_part(const std::filesystem::path& path);
/// Reads a part for a render to go on with, as `read_part` does, with what there is of a pass that was not
/// finished.
[[nodiscard]] RenderPart read_checkpoint(const std::filesystem::path& path);
/// Reads no sums, so that damage to them is not found; throws as `read_part` does otherwise.
[[nodiscard]] PartHeader read_part_header(const std::filesystem::path& path);

/// What of an identity tells its film from others.
[[nodiscard]] FilmIdentity told_apart_by(FilmIdentity identity);

/// Throws Error{input} naming `path` and the first thing in which its film differs from the one wanted.
void require_same_film(const std::filesystem::path& path, const FilmIdentity& identity,
                       const FilmIdentity& wanted);

/// Adds what a part tells to what others tell: the crop of the sum is the smallest around theirs. Throws
/// Error{input} naming `path` when it is of another film or has samples that pixels of `sum` have already.
void merge(PartHeader& sum, const PartHeader& part, const std::filesystem::path& path);

/// Memory that the sums of what the header tells take, with those of its features.
[[nodiscard]] std::size_t bytes_of_sums(const PartHeader& header);

/// Nothing yet of what the header tells, for parts to be added to.
[[nodiscard]] RenderPart empty_part(const PartHeader& header);
/// Adds the part read from `path`, whose crop lies within the film of `sum`. Throws as for headers, and for
/// pixels beyond it.
void merge(RenderPart& sum, const RenderPart& part, const std::filesystem::path& path);

/// What pixels of the film, or of a crop of it, lack of the samples that the renders of these parts stated;
/// of the samples that others have where none were stated.
[[nodiscard]] SampledAreas missing_samples(const PartHeader& sum, const std::optional<Crop>& crop = {});

/// Which samples of which pixels of a film, for messages; `of_all` stands for all pixels.
[[nodiscard]] std::string in_words(const SampledAreas& areas, const FilmShape& shape,
                                   std::string_view of_all = "");

/// The film with its variance, and its identity, sample count and error as metadata; without the latter two
/// where pixels have different samples, but for an error that is infinite since those of some tell no
/// variance. There, and where some have none, it tells by `kAreasKey` which have which, and no count.
[[nodiscard]] Image image_of(const RenderPart& part);
/// The layers of its film, each as `image_of` has the film; none where it is not told apart.
struct LayerImage {
  std::string name;
  Image image;
};
[[nodiscard]] std::vector<LayerImage> layer_images(const RenderPart& part);
/// Adds the channels of its features, if it has some, to an image of it.
void add_features(Image& image, const RenderPart& part);

}  // namespace abbe
