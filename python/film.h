#pragma once

#include <optional>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "develop/film_sensor.h"
#include "io/image.h"
#include "io/spectral_exr.h"
#include "transport/render/part.h"

namespace abbe::python {

/// A film in Python: the image that its file contains and, if it was rendered, merged or read from a part,
/// the exact sums. All functions except the constructors require the GIL.
class FilmHandle {
 public:
  explicit FilmHandle(RenderPart part);
  explicit FilmHandle(Image image);

  /// Content of the film's file, computed once from the exact sums.
  [[nodiscard]] const Image& image() const;
  /// Exact sums; nothing for a film read from an image.
  [[nodiscard]] const std::optional<RenderPart>& part() const { return part_; }
  /// Attributes of the film's file.
  [[nodiscard]] const std::map<std::string, std::string>& metadata() const { return image().metadata; }

  /// Names of the channels in the order of the sensor, or of the bands by ascending wavelength.
  [[nodiscard]] std::vector<std::string> channels() const;
  /// Read-only float32 array of rows, columns and `channels`, made once. None for an image without channels.
  [[nodiscard]] pybind11::object array() const;
  /// Variances of the pixel means in the same layout and the squared unit; None if they are unknown.
  [[nodiscard]] pybind11::object variance() const;

 private:
  std::optional<RenderPart> part_;
  mutable std::optional<Image> image_;
  mutable pybind11::object array_;
  mutable pybind11::object variance_;
};

/// Read-only float32 array of rows from the top, columns and the planes called `names`; None if the image
/// lacks one of them or `names` is empty. Requires the GIL.
[[nodiscard]] pybind11::object planes_of(const Image& image, const std::vector<std::string>& names);

/// The picture of a sensor's planes `calibrated` (`DevelopedFilm`) on the sRGB display of `abbe render`, as
/// an array: channels R, G and B, or one of grey, as code values in [0, 1]. Throws Error{usage} if no display
/// can show it.
[[nodiscard]] pybind11::object picture_array(const FilmSensor& sensor, const Image& calibrated);

/// The picture as bytes of a PNG for Jupyter; None if no display can show it.
[[nodiscard]] pybind11::object png_of(const FilmSensor& sensor, const Image& calibrated);

}  // namespace abbe::python
