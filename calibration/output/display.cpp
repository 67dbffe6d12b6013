#include "calibration/output/display.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <OpenColorIO/OpenColorIO.h>
#include <fmt/format.h>

#include "calibration/chart/patches.h"
#include "calibration/output/color_spaces.h"
#include "calibration/output/ocio.h"
#include "io/error.h"

namespace abbe {
namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr const char* kChart = "colorchecker24_babelcolor_average";
constexpr double kPercentile = 0.99;
constexpr float kClipTolerance = 1e-5F;  // float rounding of a white at exactly 1 is no clipping

void require_displayable(std::size_t channels) {
  if (channels == 1 || channels == 3) return;
  throw Error(ErrorCode::usage, "display",
              fmt::format("a picture needs a sensor of one or three channels (got {})", channels));
}

std::vector<const ImageChannel*> planes(const Image& film, const std::vector<std::string>& names) {
  std::vector<const ImageChannel*> found;
  for (const std::string& name : names) {
    found.push_back(film.find(name));
    if (found.back() == nullptr || found.back()->values.size() != film.pixels())
      throw Error(ErrorCode::input, "film", "has no complete channel " + name);
  }
  return found;
}

// Clips one pixel; true if that changed it.
bool clip(float* rgb) {
  bool clipped = false;
  for (float* v = rgb; v != rgb + 3; ++v) {
    if (!(*v >= -kClipTolerance && *v <= 1 + kClipTolerance)) clipped = true;
    *v = std::isnan(*v) ? 0.0F : std::clamp(*v, 0.0F, 1.0F);
  }
  return clipped;
}

Image split_planes(const std::vector<float>& packed, const Image& film, bool grey) {
  Image image{film.width, film.height, {}, film.metadata};
  const std::vector<std::string> names =
      grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    ImageChannel channel{names[k], std::vector<float>(film.pixels())};
    for (std::size_t i = 0; i < film.pixels(); ++i) channel.values[i] = packed[3 * i + k];
    image.channels.push_back(std::move(channel));
  }
  return image;
}

// Adaptation of the light's white, as the standard observer sees it, to the display's; a lamp of spectral
// lines, to whose colour no eye adapts, is shown as it looks beside daylight.
Matrix3 adaptation(const Curve& illuminant) {
  XYZ white = tristimulus(illuminant, Curve(1.0), Observer::cie1931);
  for (double& v : white) v /= 100;
  return bradford(white, unit_xyz(kD65)).value_or(Matrix3());
}

DisplayTransform grey_display(const Channel& channel) {
  const XYZ white = unit_xyz(kD65);
  return {{channel.name}, Matrix3(white[0], 0, 0, white[1], 0, 0, white[2], 0, 0)};
}

bool is_observer(const std::vector<Channel>& channels) {
  return channels[0].name == "X" && channels[1].name == "Y" && channels[2].name == "Z";
}

}  // namespace

struct DisplayTransform::Processor {
  OCIO::ConstCPUProcessorRcPtr cpu;
};

DisplayTransform::DisplayTransform(std::vector<std::string> channels, const Matrix3& to_xyz_d65,
                                   std::optional<MatrixFit> fit)
    : channels_(std::move(channels)), to_xyz_d65_(to_xyz_d65), fit_(std::move(fit)) {
  require_displayable(channels_.size());
  try {
    std::istringstream text(ocio_config_text({"film", {}, to_xyz_d65}));
    const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromStream(text);
    // Lossless, because the fast powers and logarithms of other settings have errors (for negative values on
    // some processors gross ones) that nobody bounds.
    processor_ = std::make_shared<const Processor>(
        Processor{config->getProcessor(kCameraSpace, kDisplay, kView, OCIO::TRANSFORM_DIR_FORWARD)
                      ->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS)});
  } catch (const OCIO::Exception& e) {
    throw Error(ErrorCode::internal, "OpenColorIO", e.what());
  }
}

DisplayPicture DisplayTransform::operator()(const Image& film, std::optional<double> scale) const {
  const std::vector<const ImageChannel*> film_planes = planes(film, channels_);
  DisplayPicture picture;
  picture.scale = scale ? *scale : automatic_scale(film);
  if (film.pixels() == 0) return picture;
  std::vector<float> packed(3 * film.pixels(), 0.0F);
  for (std::size_t k = 0; k < film_planes.size(); ++k)
    for (std::size_t i = 0; i < film.pixels(); ++i)
      packed[3 * i + k] = static_cast<float>(film_planes[k]->values[i] * picture.scale);
  OCIO::PackedImageDesc pixels(packed.data(), film.width, film.height, 3);
  try {
    processor_->cpu->apply(pixels);
  } catch (const OCIO::Exception& e) {
    throw Error(ErrorCode::internal, "OpenColorIO", e.what());
  }
  std::size_t clipped = 0;
  for (std::size_t i = 0; i < film.pixels(); ++i) clipped += clip(&packed[3 * i]) ? 1U : 0U;
  picture.clipped_share = static_cast<double>(clipped) / static_cast<double>(film.pixels());
  picture.image = split_planes(packed, film, channels_.size() == 1);
  return picture;
}

double DisplayTransform::automatic_scale(const Image& film) const {
  const std::vector<const ImageChannel*> film_planes = planes(film, channels_);
  std::vector<double> luminance(film.pixels(), 0.0);
  for (std::size_t k = 0; k < film_planes.size(); ++k)
    for (std::size_t i = 0; i < luminance.size(); ++i)
      luminance[i] += to_xyz_d65_[1][static_cast<int>(k)] * film_planes[k]->values[i];
  std::erase_if(luminance, [](double y) { return !std::isfinite(y); });
  if (luminance.empty()) return 1;
  const auto rank = static_cast<std::ptrdiff_t>(kPercentile * static_cast<double>(luminance.size() - 1));
  std::nth_element(luminance.begin(), luminance.begin() + rank, luminance.end());
  double bright = luminance[static_cast<std::size_t>(rank)];
  if (!(bright > 0)) bright = *std::max_element(luminance.begin(), luminance.end());
  return bright > 0 ? 1 / bright : 1;
}

DisplayTransform make_display(const std::vector<Channel>& channels, const Curve& illuminant) {
  require_displayable(channels.size());
  if (channels.size() == 1) return grey_display(channels.front());
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  if (is_observer(channels)) return {std::move(names), adaptation(illuminant)};
  Diagnostics diagnostics;
  const std::optional<Chart> chart = load_chart(kChart, {}, diagnostics);
  if (!chart) throw Error(diagnostics.code(), kChart, diagnostics.text());
  const std::vector<double> white = diffuser_values(channels, illuminant);
  MatrixFit fit = fit_matrix(integrate(*chart, channels, illuminant));
  const Matrix3 balance = diagonal({white[1] / white[0], 1, white[1] / white[2]});
  const Matrix3 to_xyz_d65 = adaptation(illuminant) * fit.raw_to_xyz * balance;
  return {std::move(names), to_xyz_d65, std::move(fit)};
}

}  // namespace abbe
