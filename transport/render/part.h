#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "transport/render/render.h"

namespace abbe {

/// What a film is a film of, by name: version, scene, seed and all else its values are a function of, besides
/// the samples. `sensor_channels` lists the film's channels, separated by commas. Some tell no films apart:
/// `scene`, the name of the scene file, and how pictures show it: `to_xyz_d65`, fitted on the machine that
/// rendered, `white` and `white_xy`.
using FilmIdentity = std::map<std::string, std::string>;

/// Some samples of a render. Parts of one identity add up, in any order and grouping, to the film that one
/// render of all their samples gives, bit for bit.
struct RenderPart {
  FilmIdentity identity;
  RenderResult result;
};

/// Writes the exact sums, atomically. Throws Error{output}.
void write_part(const std::filesystem::path& path, const FilmIdentity& identity, const RenderResult& result);

/// Throws Error{input} for a file that is missing, torn, damaged, no part, or saved amid a pass.
[[nodiscard]] RenderPart read_part(const std::filesystem::path& path);
/// Reads a part for a render to go on with, as `read_part` does, but it may have been saved amid a pass.
[[nodiscard]] RenderPart read_checkpoint(const std::filesystem::path& path);

/// Throws Error{input} naming `path` and the first thing in which its film differs from the one wanted.
void require_same_film(const std::filesystem::path& path, const FilmIdentity& identity,
                       const FilmIdentity& wanted);

/// Adds the part read from `path`. Throws Error{input} when it is of another film or has samples that `sum`
/// has already.
void merge(RenderPart& sum, const RenderPart& part, const std::filesystem::path& path);

/// The film with its variance, and its identity, sample count and error as metadata.
[[nodiscard]] Image image_of(const RenderPart& part);

}  // namespace abbe
