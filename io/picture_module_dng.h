#pragma once

#include <tiffio.h>

#include <array>
#include <cstdint>
#include <memory>

namespace abbe::picture_module {

/// The photometric interpretation of planes that are no mosaic [DNG, "LinearRaw"].
constexpr std::uint16_t kLinearRaw = 34892;

using Tiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;
using TiffOptions = std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)>;

/// The program says itself what a file lacks: libtiff's own lines would stand beside it on stderr.
TiffOptions quiet_tiff();

/// The opcode lists of a raw picture [DNG, ch. 7].
constexpr std::array<std::uint32_t, 3> kOpcodeLists{51008, 51009, 51022};

/// Lets libtiff know the tags of a DNG that it does not know by itself, and would warn of.
void teach_dng_tags();

}  // namespace abbe::picture_module
