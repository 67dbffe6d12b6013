#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include <tiffio.h>

#include "io/raw_picture.h"

namespace abbe::picture_module {

/// PhotometricInterpretation of demosaicked raw data [DNG, "LinearRaw"].
constexpr std::uint16_t kLinearRaw = 34892;

using Tiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;
using TiffOptions = std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)>;

/// Options that silence libtiff: its messages on stderr would duplicate the program's errors.
TiffOptions quiet_tiff();

/// Tags of the opcode lists 1, 2 and 3 of a raw picture [DNG, ch. 7].
constexpr std::array<std::uint32_t, 3> kOpcodeLists{51008, 51009, 51022};

/// Registers DNG tags that libtiff does not know and would warn about, once for the process. Call it before a
/// file is opened. Thread-safe.
void register_dng_tags();

}  // namespace abbe::picture_module
