#pragma once

#include <filesystem>
#include <string>

#include "cli/answer.h"
#include "io/inputs.h"

namespace abbe::cli {

/// Colour of a channel's line in SVG syntax: its own colour for R, G and B, otherwise one by index.
[[nodiscard]] std::string line_color(const std::string& channel, std::size_t i);

/// Photon-transfer curves as SVG from an answer of `abbe transfer --json`: the measured variance over signal,
/// with the line of each channel's gain.
[[nodiscard]] std::string transfer_plot(const Json& answer);

/// Modulation transfer function as SVG from an answer of `abbe mtf --json`.
[[nodiscard]] std::string mtf_plot(const Json& answer);

using AnswerPlot = std::string (*)(const Json&);

/// Reads an answer from a file. Throws Error{input} if `plot` cannot draw it.
[[nodiscard]] Json read_answer(const std::filesystem::path& path, const AnswerPlot& plot, Inputs& inputs);

}  // namespace abbe::cli
