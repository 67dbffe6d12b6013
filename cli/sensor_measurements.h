#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/answer.h"
#include "io/inputs.h"
#include "sensor/film/crop.h"

namespace abbe::cli {

/// Options of `abbe transfer`.
struct TransferOptions {
  /// Raw files without light; consecutive files form pairs of equal exposure.
  std::vector<std::filesystem::path> dark;
  std::vector<std::filesystem::path> flat;  ///< Raw files in uniform light, also in pairs.
  std::filesystem::path plot{};             ///< SVG of the photon-transfer curves; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints gain, noise and dynamic range per channel from pairs of flat and dark frames. Returns 0. Throws as
/// `measure_transfer`, Error{usage} for a plot other than .svg, Error{output} if it cannot be written.
int transfer(const TransferOptions& options);

/// Options of `abbe mtf`.
struct MtfOptions {
  std::filesystem::path image;   ///< Film or linear picture with a slanted edge.
  std::optional<Crop> crop{};    ///< Pixels around the edge; the whole film without a crop.
  std::string channel{};         ///< Channel to evaluate; empty for G, Y or the first.
  std::filesystem::path plot{};  ///< SVG of the function; empty for none.
  std::size_t max_memory_bytes = default_memory_limit();
  bool json = false;
};
/// Prints the modulation transfer function of a slanted edge. Returns 0. Throws Error{usage} for an unknown
/// channel, for a crop outside the recorded pixels and for a plot other than .svg. Throws Error{input} for a
/// mosaic and as `slanted_edge`, Error{output} if the plot cannot be written.
int mtf(const MtfOptions& options);

/// Colour "#rrggbb" of a channel's line: its own for R, G and B, otherwise one of three by the index `i`.
[[nodiscard]] std::string line_color(const std::string& channel, std::size_t i);

/// Photon-transfer curves as SVG from an answer of `abbe transfer --json`: the measured variance over signal,
/// with the line of each channel's gain. Throws Json::exception for an answer without these lists.
[[nodiscard]] std::string transfer_plot(const Json& answer);

/// Modulation transfer function as SVG from an answer of `abbe mtf --json`. Throws Json::exception for
/// another answer.
[[nodiscard]] std::string mtf_plot(const Json& answer);

/// Function such as `transfer_plot` that draws an answer.
using AnswerPlot = std::string (*)(const Json&);

/// Reads an answer from a file, which is recorded in `inputs`. Throws Error{input} if the file cannot be read
/// or `plot` cannot draw it.
[[nodiscard]] Json read_answer(const std::filesystem::path& path, const AnswerPlot& plot, Inputs& inputs);

}  // namespace abbe::cli
