#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "transport/render/render.h"
#include "transport/render/sample_ranges.h"

namespace abbe {

/// Attribute with the samples per pixel of the whole render, as `--spp` or the scene states them. Absent if a
/// time or error limit ends the render.
inline constexpr const char* kStatedSamplesKey = "samples_stated";
/// Attributes with the build and the instruction set of the processor, on which a film's bits depend. Images
/// omit them, so that equal pictures of different machines are equal files.
inline constexpr const char* kBuildKey = "build";
inline constexpr const char* kInstructionSetKey = "instruction_set";

/// Attributes that identify a film, by name: version, scene, seed and all else that determines its values,
/// except the samples. `sensor_channels` lists the film's channels, separated by commas. The following
/// attributes do not distinguish films:
/// - `scene`, the name of the scene file, and `kStatedSamplesKey`;
/// - `to_xyz_d65`, which is fitted on the machine that renders, or `no_picture`;
/// - `white`, `white_xy`, `white_asked` and `lights_xy`, which only affect pictures;
/// - `shapes`, the names of the shapes.
using FilmIdentity = std::map<std::string, std::string>;

/// Some samples of some pixels of a render. Parts whose identities differ in nothing but their crops can be
/// merged in any order and grouping. The result equals, bit for bit, the film of one render of all samples.
struct RenderPart {
  FilmIdentity identity;
  RenderResult result;      ///< Its `samples` are those of every area; empty if areas differ.
  SampledAreas areas = {};  ///< Empty if all pixels of the film have the samples of `result`.
};

/// Header of a part file, which precedes the sums.
struct PartHeader {
  FilmIdentity identity;
  FilmShape shape;     ///< Shape of the main film, with its crop.
  SampledAreas areas;  ///< Samples that its pixels hold.
};

/// Header that the file of this part would have.
[[nodiscard]] PartHeader header_of(const RenderPart& part);

/// Writes a part with its exact sums, atomically. If `areas` is empty, all pixels have the samples of
/// `result`. An unfinished pass of `result` is stored. Throws Error{output} if the file cannot be written.
void write_part(const std::filesystem::path& path, const FilmIdentity& identity, const RenderResult& result,
                const SampledAreas& areas = {});

/// Reads a part as a film of whole samples, without an unfinished pass. A checkpoint may have been saved
/// during a pass:
/// - Without photons, pixels whose tiles were finished include the samples of that pass. If no pass was
///   finished before, the film is cropped to these pixels.
/// - With photons, the film is the one before the pass.
///
/// Throws Error{input} for a file that is missing, truncated, damaged or not a part. Throws it also for a
/// checkpoint without a sample of any pixel.
[[nodiscard]] RenderPart read_part(const std::filesystem::path& path);
/// Reads a part that a render can resume, with the state of a pass that was not finished. Throws Error{input}
/// for a file that is missing, truncated, damaged or not a part.
[[nodiscard]] RenderPart read_checkpoint(const std::filesystem::path& path);
/// Reads the header that `read_part` would give. It does not read the sums, so it does not detect damage to
/// them. Otherwise it throws as `read_part`.
[[nodiscard]] PartHeader read_part_header(const std::filesystem::path& path);

/// Identity without the attributes that do not distinguish films.
[[nodiscard]] FilmIdentity distinguishing_keys(FilmIdentity identity);

/// Throws Error{input} if a distinguishing attribute of `identity` differs from that of `wanted`. The error
/// names `path`, the file of `identity`, and the first such attribute.
void require_same_film(const std::filesystem::path& path, const FilmIdentity& identity,
                       const FilmIdentity& wanted);

/// Adds the samples of `part` to those of `sum`, whose crop becomes the smallest around both. The larger
/// number of stated samples remains. Throws Error{input} naming `path`, the file of `part`, for a part of
/// another film or shape, and for samples that pixels of `sum` have already. `sum` is then unchanged.
void merge(PartHeader& sum, const PartHeader& part, const std::filesystem::path& path);

/// Memory [bytes] of the sums that a header describes, with those of layers and features; 0 if its features
/// are unknown.
[[nodiscard]] std::size_t bytes_of_sums(const PartHeader& header);

/// Part with the films that a header describes and without samples, to which parts can be added.
[[nodiscard]] RenderPart empty_part(const PartHeader& header);
/// Adds the part read from `path`, with its counts of work but not its times. Throws as the overload for
/// headers, and Error{input} if the part's crop exceeds the film of `sum`. `sum` is then unchanged.
void merge(RenderPart& sum, const RenderPart& part, const std::filesystem::path& path);

/// Samples that pixels of the film, or of `crop`, still lack. The target is the number of samples that the
/// parts state. If they state none, it is all samples that any pixel has. Empty if nothing is missing.
[[nodiscard]] SampledAreas missing_samples(const PartHeader& sum, const std::optional<Crop>& crop = {});

/// Text for messages: the samples of each area, such as "samples 0:16 of pixels 0,0,8,8". `whole_film` is
/// appended to an area that covers the film of the shape `shape`, in place of its pixels.
[[nodiscard]] std::string describe_samples(const SampledAreas& areas, const FilmShape& shape,
                                           std::string_view whole_film = "");

/// Image of the film values and variances, with identity, sample count and relative error as attributes.
/// - If pixels have different samples, or some have none, `kAreasKey` lists the samples of each area, and the
///   sample count is omitted.
/// - If pixels have different samples, the error is omitted too. It remains if it is infinite, because the
///   samples of some pixels give no variance.
[[nodiscard]] Image image_of(const RenderPart& part);
/// One layer of a film as an image, in the form of `image_of`.
struct LayerImage {
  std::string name;  ///< Name of the layer, as in `Layers::names`.
  Image image;
};
/// The layers of a part; empty if its film is not split into layers.
[[nodiscard]] std::vector<LayerImage> layer_images(const RenderPart& part);
/// Adds the feature channels of a part, if it has any, to its image.
void add_features(Image& image, const RenderPart& part);

}  // namespace abbe
