#pragma once

#include <filesystem>
#include <string>

#include "cli/answer.h"
#include "io/inputs.h"

namespace abbe::cli {

/// Colour "#rrggbb" of a channel's line: its own for R, G and B, otherwise one of three by the index `i`.
[[nodiscard]] std::string line_color(const std::string& channel, std::size_t i);

/// Photon-transfer curves as SVG from an answer of `abbe transfer --json`: the measured variance over signal,
/// with the line of each channel's gain. Throws Json::exception for an answer without these lists.
[[nodiscard]] std::string transfer_plot(const Json& answer);

/// Modulation transfer function as SVG from an answer of `abbe mtf --json`. Throws Json::exception for
/// another answer.
[[nodiscard]] std::string mtf_plot(const Json& answer);

/// Reads an answer from a file, which is recorded in `inputs`. Throws Error{input} if the file cannot be read
/// or `plot`, such as `transfer_plot`, cannot draw it.
[[nodiscard]] Json read_answer(const std::filesystem::path& path, std::string (*plot)(const Json&),
                               Inputs& inputs);

}  // namespace abbe::cli
