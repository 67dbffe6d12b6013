#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/render.h"
#include "description/load.h"
#include "develop/film_sensor.h"
#include "develop/relight.h"
#include "io/image.h"
#include "preview/page_server.h"
#include "transport/render/render.h"
#include "transport/render/sampled_areas.h"

namespace abbe::cli {

/// Values of options, from their text. All throw Error{usage} naming the option, what it got and what is
/// allowed.

/// One or more numbers separated by commas, each in [low, high].
[[nodiscard]] std::vector<double> parse_numbers(const std::string& option, const std::string& text,
                                                double low, double high);
/// A whole number in [low, high], which a double holds exactly.
[[nodiscard]] std::int64_t parse_integer(const std::string& option, const std::string& text, std::int64_t low,
                                         std::int64_t high);
/// The number of `text` among `names`.
[[nodiscard]] std::size_t parse_choice(const std::string& option, const std::string& text,
                                       const std::vector<std::string>& names);
/// Three numbers separated by commas, of single precision as those of scenes are.
[[nodiscard]] std::array<double, 3> parse_triple(const std::string& option, const std::string& text);
/// A time above 0: "60s", "2m", "1h" or a number of seconds [s].
[[nodiscard]] double parse_seconds(const std::string& option, const std::string& text);
/// An amount of memory above 0: "4G", "500M", "64k" (powers of 1000) or a number of bytes [bytes].
[[nodiscard]] std::size_t parse_bytes(const std::string& option, const std::string& text);
/// A share in (0, 1): "0.5%" or "0.005".
[[nodiscard]] double parse_share(const std::string& option, const std::string& text);
/// "name=factor", 0 or more, or a factor for each plane separated by commas.
[[nodiscard]] LightFactor parse_light_factor(const std::string& option, const std::string& text);
/// "bias", "dark", or "flat" perhaps with a share of saturation, as "flat:0.5".
[[nodiscard]] CalibrationFrame parse_calibration_frame(const std::string& option, const std::string& text);
/// "x0,y0,x1,y1" in pixels, x0 < x1 and y0 < y1.
[[nodiscard]] Crop parse_crop(const std::string& option, const std::string& text);
/// The pixels of a film to look at: those asked for by `--crop`, which it must have, or the rectangle it has.
[[nodiscard]] Crop asked_pixels(const Image& film, const std::optional<Crop>& asked);
/// "lights", perhaps with names as "lights:key,fill", or "bounces", perhaps up to a number as "bounces:4".
[[nodiscard]] LayerChoice parse_layer_choice(const std::string& option, const std::string& text);
/// Names of features, separated by commas.
[[nodiscard]] std::vector<Feature> parse_feature_list(const std::string& option, const std::string& text);
/// "a:b", whole numbers with a < b.
[[nodiscard]] SampleRange parse_sample_range(const std::string& option, const std::string& text);
/// "port" or "address:port", an address of IPv6 in brackets; without one this machine alone.
[[nodiscard]] ServerAddress parse_server_address(const std::string& option, const std::string& text);
/// "port" or "host:port" of a program that listens, the port above 0 and an address of IPv6 in brackets;
/// without a host on this machine.
[[nodiscard]] ServerAddress parse_viewer_address(const std::string& option, const std::string& text);
/// "/pointer=value".
[[nodiscard]] Override parse_override(const std::string& option, const std::string& text);

}  // namespace abbe::cli
